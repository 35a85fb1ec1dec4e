"""The white noise of every channel in every manoeuvre, beside the data sheet."""

from collections.abc import Iterator, Mapping, Sequence
from statistics import median

from matplotlib.axes import Axes

from inertial.tables import AXES, CHANNEL_PARTS, CHANNELS
from inertial.text.messages import _
from inertial.text.numbers import aligned, common_decimals, shortened, significant, with_sigma
from inertial.text.units import RANDOM_WALK
from stages.report import drawing, outline
from stages.report.sections.noise import DATA_SHEET, of_data_sheets
from stages.report.tables import Record, Tables
from stages.report.words import term

NAME = {"gyro": _("Angle random walk"), "accel": _("Velocity random walk")}
SENSOR = {"gyro": _("gyroscope"), "accel": _("accelerometer")}
MOST_ROWS = 48
MARK = "▲"
MIN_RATIO, MIN_SIGMAS = 1.25, 4.0  # beyond the median at rest, from which a level is marked
MOST_NAMES = 30
MOST_LEVEL_NAMES = 6  # that have room beside each other
Place = tuple[str, str]  # manoeuvre and phase
Sheet = Mapping[str, float | None]  # what the data sheet states of each channel


def parts(tables: Tables) -> Iterator[outline.Part]:
    """A figure of all manoeuvres, a table by channel and one by manoeuvre."""
    rows, sensors = tables.rows("noise"), tables.rows("sensors")
    sheet = {f"{row['sensor']}_{row['axis']}": row["white_noise"] for row in sensors}
    if rows:
        yield _figure(rows, sheet)
    yield _summary(rows, sheet, of_data_sheets(sensors))
    if rows:
        yield from (_by_manoeuvre(rows, sensor) for sensor in NAME)


SECTION = outline.Section(
    "noise-by-manoeuvre",
    _("White noise by manoeuvre"),
    _("The white noise of each channel, estimated from the data of each manoeuvre alone."),
    _(
        "A channel that is noisier in one attitude than in another responds to vibration of table "
        "or building; {mark} marks what is above the median of its channel at rest by more than "
        "4 σ and by a quarter. An axis that turns also reads how unevenly the table turns, a "
        "ripple or a step of its angle, which counts as noise here. The white noise of the data "
        "sheet is shown for comparison only and is used nowhere.",
        mark=MARK,
    ),
    ("noise", "sensors"),
    parts,
)


def _places(rows: Sequence[Record]) -> list[Place]:
    return list(dict.fromkeys((row["manoeuvre"], row["phase"]) for row in rows))


def _figure(rows: Sequence[Record], sheet: Sheet) -> outline.Figure:
    places = {place: number for number, place in enumerate(_places(rows))}
    with drawing.style():
        figure, axes = drawing.panels(
            2, 1, 1.45, drawing.Margins(left=0.46, right=0.95, bottom=1.05)
        )
        for (panel,), sensor in zip(axes, NAME, strict=True):
            _panel(panel, sensor, rows, places, sheet)
        handles = dict(zip(*reversed(axes[0][0].get_legend_handles_labels()), strict=True))
        shown = [name for name in (*AXES, DATA_SHEET) if name in handles]
        axes[0][0].legend(
            [handles[name] for name in shown], shown, loc="upper left", bbox_to_anchor=(1.0, 1.0)
        )
        named = list(places.items())[:: max(1, -(-len(places) // MOST_NAMES))]
        many = len(places) > MOST_LEVEL_NAMES
        axes[1][0].set_xticks(
            [number for _unused, number in named],
            [_named(place, 24) for place, _unused in named],
            rotation=60 if many else 0,
            ha="right" if many else "center",
            rotation_mode="anchor",
        )
        drawn = drawing.svg(figure, "noise")
    return outline.Figure(
        _("White noise by manoeuvre, with its σ; dashed: the data sheet."),
        drawn,
        _("White noise of the six channels by manoeuvre; gyroscope above, accelerometer below."),
    )


def _panel(
    panel: Axes, sensor: str, rows: Sequence[Record], places: Mapping[Place, int], sheet: Sheet
) -> None:
    unit = RANDOM_WALK[sensor]
    for offset, axis in zip((-0.2, 0.0, 0.2), AXES, strict=True):
        own = [row for row in rows if row["channel"] == f"{sensor}_{axis}"]
        panel.errorbar(
            [places[row["manoeuvre"], row["phase"]] + offset for row in own],
            [row["white_noise"] / unit.size for row in own],
            [row["sigma"] / unit.size for row in own],
            fmt=drawing.AXIS_MARK[axis],
            color=drawing.AXIS_COLOUR[axis],
            markersize=3.5,
            elinewidth=0.8,
            label=axis,
        )
    stated = {value for axis in AXES if (value := sheet.get(f"{sensor}_{axis}")) is not None}
    for value in sorted(stated):
        at = value / unit.size
        panel.axhline(at, color=drawing.INK, linewidth=0.8, dashes=(5, 3), label=DATA_SHEET)
    panel.set_yscale("log")
    drawing.plain_numbers(panel.yaxis)
    panel.set_title(f"{NAME[sensor]}, {unit.name}", pad=3)


def _named(place: Place, most: int) -> str:
    manoeuvre, phase = place
    return shortened(manoeuvre if phase == "rest" else f"{manoeuvre}, {term(phase)}", most)


def _summary(rows: Sequence[Record], sheet: Sheet, note: str) -> outline.Table:
    lines = {
        channel: _line(channel, own, sheet)
        for channel in CHANNELS
        if (own := [row for row in rows if row["channel"] == channel])
    }
    cells = zip(*map(aligned, zip(*lines.values(), strict=True)), strict=True)
    return outline.Table(
        _("White noise by channel, over all manoeuvres."),
        (
            outline.Column(_("Channel")),
            *outline.columns(
                "number",
                _("Median"),
                _("Lowest"),
                _("Highest"),
                _("Data sheet"),
                _("Median ÷ data sheet"),
            ),
            outline.Column(_("Unit"), "unit"),
        ),
        [
            outline.table_row(_channel(channel), *own)
            for channel, own in zip(lines, cells, strict=True)
        ],
        _("None: no manoeuvre is long enough to estimate the noise."),
        note,
    )


def _line(channel: str, own: Sequence[Record], sheet: Sheet) -> tuple[str, ...]:
    unit = RANDOM_WALK[CHANNEL_PARTS[channel][0]]
    values = [row["white_noise"] / unit.size for row in own]
    stated = unit.of(sheet.get(channel))
    return (
        *(significant(each, 3) for each in (median(values), min(values), max(values), stated)),
        significant(median(values) / stated if stated else None, 2),
        unit.name,
    )


def _channel(channel: str) -> str:
    sensor, axis = CHANNEL_PARTS[channel]
    return _("{sensor} {axis}", sensor=SENSOR[sensor], axis=axis)


def is_high(row: Record, at_rest: float | None) -> bool:
    """Whether a level is above that of its channel at rest by more than it scatters."""
    value, sigma = row["white_noise"], row["sigma"]
    if value is None or sigma is None or at_rest is None:
        return False
    return bool(value > MIN_RATIO * at_rest and value - at_rest > MIN_SIGMAS * sigma)


def _by_manoeuvre(rows: Sequence[Record], sensor: str) -> outline.Table:
    unit = RANDOM_WALK[sensor]
    by_place = {(row["manoeuvre"], row["phase"], row["channel"]): row for row in rows}
    places = _places(rows)
    own = [row for row in rows if CHANNEL_PARTS[row["channel"]][0] == sensor]
    decimals = common_decimals(row["sigma"] / unit.size for row in own)
    gap = {"white_noise": None, "sigma": None}
    at_rest = {
        axis: median(levels)
        for axis in AXES
        if (
            levels := [
                row["white_noise"]
                for row in own
                if row["channel"] == f"{sensor}_{axis}" and row["phase"] != "steady"
            ]
        )
    }

    def cells(place: Place) -> Iterator[str]:
        for axis in AXES:
            row = by_place.get((*place, f"{sensor}_{axis}"), gap)
            value, sigma = with_sigma(unit.of(row["white_noise"]), unit.of(row["sigma"]), decimals)
            yield f"{MARK} {value}" if is_high(row, at_rest.get(axis)) else value
            yield sigma

    return outline.Table(
        _("{name} by manoeuvre, {name_2}.", name=NAME[sensor], name_2=unit.name),
        (
            outline.Column(_("Manoeuvre"), "name"),
            *(each for axis in AXES for each in outline.value_and_sigma(axis)),
        ),
        [outline.table_row(_named(place, 40), *cells(place)) for place in places[:MOST_ROWS]],
        note=outline.more(len(places) - MOST_ROWS, _(" in the noise table of the campaign")),
    )

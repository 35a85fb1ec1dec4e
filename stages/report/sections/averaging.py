"""Parameters against averaging time: as more of each rest is used, and epoch by epoch."""

from collections.abc import Iterator, Mapping, Sequence
from math import hypot, sqrt

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from inertial.campaign.records import grouped
from inertial.sensors import unit_of
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant, whole
from inertial.text.parameters import PARTS, SENSOR_OF, STAGES, sign_of
from inertial.text.units import RANDOM_WALK, Unit, quantity
from stages.report import drawing, outline
from stages.report.results import Estimate, by_kind, kind_of
from stages.report.tables import Record, Tables, arrays
from stages.report.words import SENSOR_OF_STAGE, plain, sensor_of_stage

MOST_PANELS = 24
MOST_EPOCH_PANELS = 12
Group = tuple[str, str, str]  # sensor, mount, method
KINDS = {"bias": _("bias"), "scale": _("scale"), "cross": _("cross-axis terms")}
SHOWN_SIGMAS = 4  # of a single epoch
MIN_FALL = 1.002  # of a σ from the shortest to the longest time, with less it depends on others


def parts(tables: Tables) -> Iterator[outline.Part]:
    """One figure per sensor and method, one panel per parameter; the time for a wanted sigma."""
    names = [f"{stage}_{name}" for stage in SENSOR_OF_STAGE for name in ("averaging", "wanted")]
    if not any(tables.rows(name) for name in names):
        yield outline.Paragraph(
            _("None: the parameters were not followed over the averaging time.")
        )
        return
    for stage, name in SENSOR_OF_STAGE.items():
        yield outline.Heading(name)
        groups = _curves(tables.rows(f"{stage}_averaging"))
        for number, (group, curves) in enumerate(groups.items(), 1):
            units = {name: quantity(name, unit_of(SENSOR_OF[stage], name)).shown for name in curves}
            yield _figure(group, f"averaging-{stage}-{number}", curves, units)
        if not groups:
            yield outline.Paragraph(
                _("None: the parameters were not followed over the averaging time.")
            )
    yield _wanted([row for stage in SENSOR_OF for row in tables.rows(f"{stage}_wanted")])


SECTION = outline.Section(
    "averaging",
    _("Parameters against averaging time"),
    _(
        "Each parameter as estimated from the first seconds of each static position "
        "only, relative to its final value; the joint fit is that without effects."
    ),
    _(
        "The band is value ± σ. Where it narrows about zero, longer static positions would still "
        "help; where the line leaves the band and stays outside, something drifts."
    ),
    tuple(f"{stage}_{table}" for stage in SENSOR_OF for table in ("averaging", "wanted")),
    parts,
)


def _curves(rows: Sequence[Record]) -> dict[Group, dict[str, list[Record]]]:
    """The rows by group and by parameter, the biases first."""
    return {
        group: grouped(
            by_kind(row | {"parameter": row["quantity"]} for row in own),
            lambda row: str(row["quantity"]),
        )
        for group, own in grouped(rows, _group).items()
    }


def _group(row: Record) -> Group:
    return row["sensor"], row["mount"], row["method"]


def _estimate(group: Group) -> Estimate:
    sensor, mount, method = group
    return Estimate(STAGES[sensor], method, mount)


def _figure(
    group: Group, key: str, curves: Mapping[str, Sequence[Record]], units: Mapping[str, Unit]
) -> outline.Figure:
    def panel_of(panel: Axes, name: str) -> None:
        rows = sorted(curves[name], key=lambda row: float(row["seconds"]))
        seconds, value, sigma = arrays(rows, "seconds", "value", "sigma")
        away, sigma = (value - value[-1]) / units[name].size, sigma / units[name].size
        panel.axhline(0, color=drawing.INK, linewidth=0.6)
        drawing.around(panel, seconds, away, sigma, _colour(name), 0.22)
        panel.plot(seconds, away, color=_colour(name), marker="o", markersize=1.8)
        panel.set_xscale("log")
        drawing.plain_numbers(panel.xaxis)
        panel.set_title(f"{sign_of(name)}, {units[name].name}", pad=3)
        drawing.ticks(panel, 4)

    title = _estimate(group).name
    drawn = [name for name, rows in curves.items() if _shortens(rows)] or list(curves)
    shown = drawn[:MOST_PANELS]
    rest = outline.more(len(drawn) - len(shown), _(" in the averaging table"))
    if len(drawn) < len(curves):
        rest = _("Parameters whose σ does not depend on it are not drawn. {rest}", rest=rest)
    return outline.Figure(
        _(
            "{title}: value ± σ against averaging time, relative to the final value. {rest}",
            title=title,
            rest=rest,
        ).rstrip(),
        drawing.grid(shown, panel_of, 0.95, _("Time per static position, s"), key),
        _(
            "{counted} of {title}, each within its band of sigma.",
            counted=counted(len(shown), "curve"),
            title=title,
        ),
    )


def _shortens(rows: Sequence[Record]) -> bool:
    """Whether the σ of a parameter falls as static positions last longer."""
    by_time = sorted(rows, key=lambda row: float(row["seconds"]))
    first, last = by_time[0]["sigma"], by_time[-1]["sigma"]
    return first is None or last is None or bool(first > MIN_FALL * last)


def _colour(parameter: str) -> str:
    axis = PARTS[parameter].sensor_axis if parameter in PARTS else ""
    return drawing.AXIS_COLOUR.get(axis, drawing.INK)


def _wanted(rows: Sequence[Record]) -> outline.Table:
    """How long each static position must last for a bias of a required sigma."""
    return outline.Table(
        _(
            "Duration of each static position for a required σ of the bias, if it were computed by "
            "the closed formulas (not the result of this report, whose σ is in “Parameters”)."
        ),
        (
            outline.Column(_("Bias")),
            outline.Column(_("white noise N"), "number"),
            outline.Column(_("unit"), "unit"),
            *outline.columns("number", "σ", _("duration"), group=_("Recorded")),
            outline.Column(_("floor"), "number"),
            outline.Column("σ", "number", _("Required")),
            outline.Column(_("unit"), "unit", _("Required")),
            outline.Column(_("duration"), "number", _("Required")),
        ),
        [_wanted_row(row) for row in rows],
        _("None: no closed formula gives a bias here."),
        _(
            "σ² = N²/T + floor², with the white noise N of the bias and positions of duration T. "
            "The floor is what averaging does not reduce: tilts of the positions, gravity, an "
            "unknown azimuth, and the scatter between manoeuvres."
        ),
    )


def _wanted_row(row: Record) -> outline.Row:
    unit = quantity(row["quantity"], unit_of(row["sensor"], row["quantity"])).shown
    walk = RANDOM_WALK[row["sensor"]]
    sigma, floor, wanted = (
        significant(unit.of(row[which]), 2) for which in ("sigma", "floor", "wanted")
    )
    seconds = row["wanted_seconds"]
    return outline.table_row(
        f"{plain(row['quantity'])}, {_estimate(_group(row)).name}",
        *(significant(walk.of(row["random_walk"]), 2), walk.name),
        *(sigma, f"{significant(row['seconds'], 3)} s"),
        *(floor, wanted, unit.name),
        _("not by this formula") if seconds is None else f"{significant(seconds, 2)} s",
    )


# ---- epoch by epoch, for the section of studies


def epoch_parts(tables: Tables) -> Iterator[outline.Part]:
    """A figure of the values per sensor, one of their scatter, and the variances as a table."""
    groups = _curves(tables.rows("epochs"))
    for number, (group, curves) in enumerate(groups.items(), 1):
        yield _epochs(group, f"epochs-{number}", curves)
    if spreads := tables.rows("spreads"):
        levels = tables.rows("levels")
        yield _scatter(spreads)
        seconds = [row["seconds"] for row in spreads]
        extremes = dict.fromkeys((min(seconds), max(seconds)))
        yield outline.Paragraph(
            " ".join(_scatter_at(spreads, length, levels) for length in extremes)
        )
        yield _spreads(spreads)


def _epochs(group: Group, key: str, curves: Mapping[str, Sequence[Record]]) -> outline.Figure:
    def panel_of(panel: Axes, name: str) -> None:
        rows = curves[name]
        unit = quantity(name, rows[0]["unit"]).shown
        seconds, *each = arrays(rows, "seconds", "single", "running_mean", "running_mean_sigma")
        single, running, sigma = (values / unit.size for values in each)
        final, colour = rows[-1]["running_mean"] / unit.size, _colour(name)
        panel.plot(seconds, single - final, color=drawing.QUIET, linewidth=0.35, alpha=0.6)
        away = running - final
        drawing.around(panel, seconds, away, sigma, colour, 0.25)
        panel.plot(seconds, away, color=colour, linewidth=0.9)
        height = SHOWN_SIGMAS * rows[0]["single_sigma"] / unit.size
        if height > 0:
            panel.set_ylim(-height, height)
        panel.set_xlim(0, float(seconds[-1]))
        panel.set_title(f"{sign_of(name)}, {unit.name}", pad=3)
        drawing.ticks(panel, 4)

    shown = list(curves)[:MOST_EPOCH_PANELS]
    first = next(iter(curves.values()))[0]["seconds"]
    return outline.Figure(
        _(
            "{sensor}: by single epochs of {first} s (grey) and by running means (colour, "
            "with ± σ of white noise), relative to the final value. The panels show ± 4 σ "
            "of a single epoch.",
            sensor=_estimate(group).sensor,
            first=significant(first, 3),
        ),
        drawing.grid(shown, panel_of, 0.78, _("Time per static position, s"), key),
        _(
            "{counted} against the time per static position.",
            counted=counted(len(shown), "parameter"),
        ),
    )


def _ratio(row: Record) -> float:
    """Standard deviation by single epochs over that of white noise."""
    white = row["white_variance"]
    return sqrt(row["single_variance"] / white) if white > 0 else float("nan")


def _scatter(rows: Sequence[Record]) -> outline.Figure:
    panels_of = grouped(rows, lambda row: (STAGES[row["sensor"]], kind_of(row["quantity"])))
    places = sorted(panels_of, key=lambda place: (place[0], list(KINDS).index(place[1])))
    with drawing.style():
        figure, [axes] = drawing.panels(
            1, len(places), 1.25, drawing.Margins(left=0.45, across=0.34, top=0.36)
        )
        for panel, (stage, kind) in zip(axes, places, strict=True):
            _scatter_panel(panel, panels_of[stage, kind])
            panel.set_title(f"{sensor_of_stage(stage)}\n{KINDS[kind]}", pad=3)
            panel.set_xlabel(_("Epoch, s"))
        axes[0].legend(
            handles=[Line2D([], [], color=drawing.AXIS_COLOUR[axis], label=axis) for axis in AXES],
            loc="lower left",
            ncols=len(AXES),
            columnspacing=1.0,
            handlelength=1.0,
        )
        axes[0].set_ylabel(_("σ / σ of white noise"))
        drawn = drawing.svg(figure, "spreads")
    return outline.Figure(
        _(
            "Standard deviation of the values by single epochs over what white noise gives, "
            "against the length of an epoch; band: ± 2 σ of chance alone. A rise with the length "
            "is drift; a fall to 1 is an oscillation that averages out."
        ),
        drawn,
        _("Scatter of single epochs in units of that of white noise."),
    )


def _scatter_panel(panel: Axes, rows: Sequence[Record]) -> None:
    lengths = sorted({row["seconds"]: row["epochs"] for row in rows}.items())
    seconds, epochs = (np.array(each) for each in zip(*lengths, strict=True))
    chance = 1 / np.sqrt(2.0 * np.maximum(epochs - 1, 1))
    drawing.around(panel, seconds, np.ones(len(chance)), 2 * chance, drawing.QUIET, 0.18)
    panel.axhline(1, color=drawing.INK, linewidth=0.6)
    for mount, name in dict.fromkeys((row["mount"], row["quantity"]) for row in rows):
        own = [row for row in rows if (row["mount"], row["quantity"]) == (mount, name)]
        x, y = zip(*sorted((row["seconds"], _ratio(row)) for row in own), strict=True)
        panel.plot(x, y, color=_colour(name), marker="o", markersize=1.8, linewidth=0.8)
    panel.set_xscale("log")
    drawing.plain_numbers(panel.xaxis)
    panel.set_xticks([t for t in (0.01, 0.1, 1.0, 10.0, 100.0) if seconds[0] <= t <= seconds[-1]])
    panel.set_ylim(0, max(2.0, 1.1 * max(map(_ratio, rows))))


def _level_sigma(levels: Sequence[Record], sensor: str) -> float:
    """How well the white noise of a sensor is known, relative; of the least sure channel."""
    own = [row for row in levels if row["channel"].startswith(sensor) and row["white_noise"]]
    known = [row["sigma"] / row["white_noise"] for row in own if row["sigma"] is not None]
    return max(known, default=0.0)


def _scatter_at(rows: Sequence[Record], seconds: float, levels: Sequence[Record]) -> str:
    """How far the scatter is off that of white noise, at epochs of one length."""
    own = [row for row in rows if row["seconds"] == seconds]
    ratios = sorted((_ratio(row), row["quantity"], STAGES[row["sensor"]]) for row in own)
    epochs = own[0]["epochs"]
    (smallest, *_unused), (largest, name, stage) = ratios[0], ratios[-1]
    chance = hypot(1 / sqrt(2 * max(epochs - 1, 1)), _level_sigma(levels, SENSOR_OF[stage]))
    return _(
        "Epochs of {seconds} s ({epochs} of them) scatter {smallest} to {largest} times "
        "as much as white noise, most the {name} of the {stage}; chance and the uncertainty of the "
        "level of the white noise give 1 ± {chance}.",
        seconds=significant(seconds, 3),
        epochs=whole(epochs),
        smallest=fixed(smallest, 2),
        largest=fixed(largest, 2),
        name=plain(name),
        stage=sensor_of_stage(stage).lower(),
        chance=fixed(chance, 3 if chance < 0.01 else 2),
    )


def _spreads(rows: Sequence[Record]) -> outline.Table:
    shortest = {}
    for row in sorted(rows, key=lambda row: -float(row["seconds"])):
        shortest[_group(row), row["quantity"]] = row
    named = by_kind(row | {"parameter": row["quantity"]} for row in shortest.values())
    epoch = significant(min(row["seconds"] for row in rows), 3)
    return outline.Table(
        _("Scatter of the values epoch by epoch, epochs of one sample ({epoch} s).", epoch=epoch),
        (
            *outline.columns("name", _("Parameter"), _("Sensor")),
            outline.Column(_("unit"), "unit", _("Standard deviation")),
            *outline.columns(
                "number",
                _("single epochs"),
                _("white noise"),
                _("running means"),
                group=_("Standard deviation"),
            ),
        ),
        [_spread(row) for row in named],
        note=_(
            "The scatter of the running means is their variation on the way, not the uncertainty "
            "of the last one: its σ is that of white noise over the whole position."
        ),
    )


def _spread(row: Record) -> outline.Row:
    unit = quantity(row["quantity"], row["unit"]).shown
    single, running, white = (row[f"{of}_variance"] for of in ("single", "running", "white"))
    return outline.table_row(
        plain(row["quantity"]),
        SENSOR_OF_STAGE[STAGES[row["sensor"]]],
        unit.name,
        *(significant(sqrt(each) / unit.size, 3) for each in (single, white, running)),
    )

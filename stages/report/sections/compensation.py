"""The corrected readings: before and after, and against what is known."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from numpy.typing import NDArray

from inertial.sensors import SENSORS, SINGULAR
from inertial.tables import AXES, CHANNELS
from inertial.text import numbers, units
from inertial.text.messages import _
from inertial.text.typography import capital
from stages.report import drawing, outline
from stages.report.drawing import Array
from stages.report.tables import Record, Tables, once
from stages.report.words import phases_in_words

MAX_SIGMAS = 3.0  # from which a check is marked
MOST_ROWS = 60


@dataclass(frozen=True)
class Checked:
    """A quantity that is checked: its name, the unit of its value, how a difference is written."""

    name: str
    value: units.Unit
    difference: units.Quantity
    in_full: bool = True


FORCE, RATE, ANGLE = (units.quantity("", unit) for unit in ("m/s²", "rad/s", "rad"))
CHECKED = {
    "gravity": Checked(_("Gravity in every position"), units.METRES, FORCE),
    # It is |f| but for the tilt; in full it would say the same again.
    "force_up": Checked(_("Specific force along up"), units.METRES, FORCE, in_full=False),
    "rate_up": Checked(_("Earth's rate along up"), units.DEGREES_PER_HOUR, RATE),
    "angle": Checked(_("Angle of every whole turn"), units.DEGREES, ANGLE),
}


def parts(tables: Tables) -> Iterator[outline.Part]:
    """The checks in sum, and a manoeuvre before and after, a rotation where there is one."""
    for row in tables.rows("compensation_findings"):
        yield outline.Paragraph(numbers.shortened(row["sentence"], 900), "fair")
    yield _summary(_by_quantity(tables))
    for row in tables.rows("checks"):
        if row["quantity"] not in CHECKED:
            yield outline.Paragraph(numbers.shortened(row["sentence"], 900), "fair")
    figures = _figures(tables)
    yield from figures[-1:]
    if not figures:
        yield outline.Paragraph(_("No compensated log could be drawn."))


def check_parts(tables: Tables) -> Iterator[outline.Part]:
    """Every check of a quantity, a table each, and the other manoeuvre before and after."""
    yield from _figures(tables)[:-1]
    for checked, own in _by_quantity(tables).items():
        if checked.in_full:
            yield _table(checked, own)


def _by_quantity(tables: Tables) -> dict[Checked, list[Record]]:
    rows = tables.rows("checks")
    return {
        checked: own
        for quantity, checked in CHECKED.items()
        if (own := [row for row in rows if row["quantity"] == quantity])
    }


SECTION = outline.Section(
    "compensation",
    _("Compensation"),
    _(
        "The readings corrected with the final result, its effects included, and whether "
        "they then agree with what is known: gravity in every position, the earth's rate, the "
        "angle of every turn."
    ),
    _(
        "In the tables before and after are differences from the known value; the figures show the "
        "readings before (grey) and after (in colour), and beside them the correction, before less "
        "after. In σ is the remaining difference over its own σ; beyond 3 the result does not "
        "describe all errors, and the causes in section 2 may say why."
    ),
    (
        *("checks", "traces", "compensated_traces", "compensation_findings"),
        *("segments", "manoeuvres"),
    ),
    parts,
)
CHECKS = outline.Section(
    "checks",
    _("Checks of the compensated readings"),
    _("The known value and the readings' difference from it, manoeuvre by manoeuvre."),
    "",
    ("checks", "traces", "compensated_traces", "segments", "manoeuvres"),
    check_parts,
)


def _summary(by_quantity: Mapping[Checked, Sequence[Record]]) -> outline.Table:
    return outline.Table(
        _("Root mean square of the difference from the known value, before and after."),
        (
            outline.Column(_("Quantity")),
            outline.Column(_("Checks"), "number"),
            *outline.columns("number", _("before"), _("after"), group=_("rms")),
            outline.Column(_("unit"), "unit", _("rms")),
            *outline.columns("number", _("Largest, in σ"), _("Beyond 3 σ")),
        ),
        [_summed(checked, own) for checked, own in by_quantity.items()],
        _("None: no compensated reading could be checked."),
    )


def _summed(checked: Checked, rows: Sequence[Record]) -> outline.Row:
    unit = checked.difference.shown
    sigmas = [abs(row["in_sigmas_after"]) for row in rows if row["in_sigmas_after"] is not None]
    beyond = sum(size > MAX_SIGMAS for size in sigmas)
    return outline.table_row(
        checked.name,
        numbers.whole(len(rows)),
        *(numbers.significant(unit.of(_rms(rows, which)), 3) for which in ("before", "after")),
        unit.name,
        numbers.fixed(max(sigmas, default=None), 1),
        numbers.whole(beyond),
        tone="fair" if beyond else "",
    )


def _rms(rows: Sequence[Record], which: str) -> float | None:
    off = [size for row in rows if (size := _difference(row, which)) is not None]
    return sqrt(sum(size**2 for size in off) / len(off)) if off else None


def _difference(row: Record, which: str) -> float | None:
    if row[which] is None or row["expected"] is None:
        return None
    return float(row[which] - row["expected"])


def _table(checked: Checked, rows: Sequence[Record]) -> outline.Table:
    shown, left_out = list(rows), len(rows) - MOST_ROWS
    if left_out > 0:
        shown.sort(key=lambda row: -abs(row["in_sigmas_after"] or 0.0))
        shown = shown[:MOST_ROWS]
    unit = checked.difference.shown
    sigmas = [unit.of(row["after_sigma"]) for row in shown]
    decimals = numbers.common_decimals(sigmas)
    cells = [
        (
            numbers.fixed(checked.value.of(row["expected"]), 5),
            numbers.with_sigma(unit.of(_difference(row, "before")), sigma, decimals)[0],
            *numbers.with_sigma(unit.of(_difference(row, "after")), sigma, decimals),
            numbers.fixed(row["in_sigmas_after"], 1),
        )
        for row, sigma in zip(shown, sigmas, strict=True)
    ]
    lines = zip(*map(numbers.aligned, zip(*cells, strict=True)), strict=True)
    group = _("Difference, {name}", name=unit.name)
    return outline.Table(
        f"{checked.name}: {numbers.counted(len(rows), 'check')}.",
        (
            outline.Column(_("Manoeuvre")),
            outline.Column(_("Known, {name}", name=checked.value.name), "number"),
            *outline.columns("number", _("before"), _("after"), group=group),
            outline.Column("± σ", "sigma", group),
            outline.Column(_("in σ"), "number"),
        ),
        [
            outline.table_row(
                phases_in_words(numbers.shortened(row["manoeuvre"] or "", 60)),
                *line,
                anchor=row["id"],
                tone="fair" if abs(row["in_sigmas_after"] or 0.0) > MAX_SIGMAS else "",
            )
            for row, line in zip(shown, lines, strict=True)
        ],
        note=outline.more(left_out, _(", closer to the known value")),
    )


# ---- one manoeuvre before and after

POINTS = 130  # per curve
RESTS = (_("{axis} up"), _("{axis} down"))  # what is shown of an axis
TURNS = (_("turn forward about {axis}"), _("turn backward about {axis}"))
MIN_COSINE = 0.99  # from which a direction is an axis
BEFORE = "#a9b3be"
MAX_STEPS = 3.0  # usual steps from one stretch to the next from which a curve breaks off
MIN_SPAN = {"gyro": 2.0, "accel": 0.5}  # °/h, mm/s²: what is finer is noise of the extremes
FINE = {"gyro": units.DEGREES_PER_HOUR, "accel": units.MILLIMETRES}


@dataclass(frozen=True)
class Curves:
    """One channel: its extremes before and after, and the correction; NaN at a break."""

    least: Array
    most: Array
    least_after: Array
    most_after: Array
    correction: Array


@dataclass(frozen=True)
class Compensated:
    """One manoeuvre before and after, with the edges of the traces."""

    x: Array
    timed: bool
    curves: Mapping[str, Curves]  # by channel
    phases: Sequence[Record]
    turning: bool


@once
def _figures(tables: Tables) -> list[outline.Figure]:
    """A rest with an axis up or down, and a turn about the same, where an axis has both."""
    return list(_drawn(tables))


def _drawn(tables: Tables) -> Iterator[outline.Figure]:
    number = 0
    for view, plan in _chosen(tables).items():
        compensated = curves_of(tables, plan)
        if compensated is None:
            continue
        number += 1
        name = numbers.shortened(plan["manoeuvre"], 80)
        about = "" if compensated.turning else _("; both relative to the median after")
        yield outline.Figure(
            _(
                "{name}, {view}: before (grey) and after (colour) compensation, and the "
                "correction{about}.",
                name=name,
                view=view,
                about=about,
            ),
            _draw(compensated, f"compensated-{number}"),
            _(
                "Six channels of {name} before and after compensation, and the correction.",
                name=name,
            ),
        )


def _chosen(tables: Tables) -> dict[str, Record]:
    """The manoeuvres that are shown, by the words for them."""
    there = {row["manoeuvre"] for row in tables.rows("segments")}
    best: dict[str, Record] = {}
    for axis in reversed(AXES):
        views: dict[str, Record] = {}
        for plan in tables.rows("manoeuvres"):
            if plan["manoeuvre"] in there and (view := _view(plan, axis)):
                views.setdefault(view, plan)
        shown = [[view for view in some if view in views][:1] for some in (RESTS, TURNS)]
        if sum(map(len, shown)) > len(best):
            best = {view.format(axis=axis): views[view] for own in shown for view in own}
    return best


def _view(plan: Record, axis: str) -> str:
    """What a manoeuvre shows of an axis, of RESTS and TURNS; or nothing."""
    up, about = plan[f"up_{axis}"], plan[f"about_{axis}"]
    if plan["do"] == "turn" and about is not None and abs(about) > MIN_COSINE:
        forward = (plan["angle"] or plan["rate"] or 0.0) * about > 0
        return TURNS[0] if forward else TURNS[1]
    if plan["do"] == "rest" and up is not None and abs(up) > MIN_COSINE:
        return RESTS[0] if up > 0 else RESTS[1]
    return ""


def curves_of(tables: Tables, plan: Record) -> Compensated | None:
    """The six channels of a manoeuvre before and after; None where no trace shows it."""
    own = [row for row in tables.rows("segments") if row["manoeuvre"] == plan["manoeuvre"]]
    first = min(row["from_record"] for row in own)
    last = max(row["to_record"] for row in own)
    before = tables.frame("traces").query(
        "log == @log and to_record > @first and from_record < @last",
        local_dict={"log": own[0]["log"], "first": first, "last": last},
    )
    if plan["do"] == "rest":  # one that goes on into the next manoeuvre has its extremes too
        before = before.query("from_record >= @first and to_record <= @last")
    both = before.merge(
        tables.frame("compensated_traces"),
        on=["log", "from_record", "to_record"],
        suffixes=("", "_after"),
    )
    if both.empty:
        return None
    timed = not both["from_s"].isna().any()
    start, end = ("from_s", "to_s") if timed else ("from_record", "to_record")
    count = len(both)
    edges = np.unique(np.arange(min(POINTS, count)) * count // min(POINTS, count))
    x = _mean((_of(both, start) + _of(both, end)) / 2, edges)
    breaks = _breaks(x)
    curves = {}
    for channel in CHANNELS:
        least, most = _of(both, f"least_{channel}"), _of(both, f"most_{channel}")
        least_after, most_after = (
            _of(both, f"{which}_{channel}_after") for which in ("least", "most")
        )
        bands = (
            np.fmin.reduceat(least, edges),
            np.fmax.reduceat(most, edges),
            np.fmin.reduceat(least_after, edges),
            np.fmax.reduceat(most_after, edges),
            _mean((least + most - least_after - most_after) / 2, edges),
        )
        curves[channel] = Curves(*(np.insert(each, breaks, np.nan) for each in bands))
    phases = [row | {"start": row[start], "end": row[end]} for row in own if row[start] is not None]
    x = np.insert(x, breaks, x[breaks])
    return Compensated(x, timed, curves, phases, turning=plan["do"] == "turn")


def _mean(values: Array, edges: NDArray[np.int64]) -> Array:
    """Means over the stretches that begin at `edges`."""
    count = np.diff(np.append(edges, len(values)))
    return np.asarray(np.add.reduceat(values, edges) / count)


def _breaks(x: Array) -> NDArray[np.int64]:
    """Where something is missing between one stretch and the next."""
    steps = np.diff(x)
    if not len(steps):
        return np.empty(0, dtype=np.int64)
    return np.flatnonzero(steps > MAX_STEPS * np.median(steps)) + 1


def _of(frame: pd.DataFrame, column: str) -> Array:
    return frame[column].to_numpy(dtype=np.float64)


def _draw(compensated: Compensated, key: str) -> str:
    with drawing.style():
        figure, axes = drawing.panels(3, 4, 0.52, drawing.Margins(across=0.44, down=0.2))
        for place, sensor in enumerate(SENSORS):
            both, corrections = ([line[2 * place + side] for line in axes] for side in (0, 1))
            fine = FINE[sensor]
            unit = units.DEGREES_PER_SECOND if sensor == "gyro" and compensated.turning else fine
            for axis, panel, beside in zip(AXES, both, corrections, strict=True):
                _draw_both(panel, compensated, sensor, axis, unit)
                _draw_correction(beside, compensated, sensor, axis, fine)
            both[0].set_title(f"{capital(SINGULAR[sensor])}, {unit.name}", loc="left", pad=2)
            corrections[0].set_title(_("correction, {name}", name=fine.name), loc="left", pad=2)
        for panel in axes[-1]:
            panel.set_xlabel(_("Time, s") if compensated.timed else _("Record"))
        if len(compensated.x) > 1:
            axes[0][0].set_xlim(float(compensated.x[0]), float(compensated.x[-1]))
        return drawing.svg(figure, key)


def _draw_both(
    panel: Axes, compensated: Compensated, sensor: str, axis: str, unit: units.Unit
) -> None:
    _background(panel, compensated, axis)
    curves = compensated.curves[f"{sensor}_{axis}"]
    middles = (curves.least_after + curves.most_after) / 2
    middle = 0.0
    if (not compensated.turning or sensor == "accel") and np.isfinite(middles).any():
        middle = float(np.nanmedian(middles))
    for low, high, colour in (
        (curves.least, curves.most, BEFORE),
        (curves.least_after, curves.most_after, drawing.AXIS_COLOUR[axis]),
    ):
        drawing.band(
            panel, compensated.x, (low - middle) / unit.size, (high - middle) / unit.size, colour
        )


def _draw_correction(
    panel: Axes, compensated: Compensated, sensor: str, axis: str, unit: units.Unit
) -> None:
    _background(panel, compensated, axis)
    correction = compensated.curves[f"{sensor}_{axis}"].correction / unit.size
    if not np.isfinite(correction).any():
        drawing.write_inside(panel, _("not compensated"))
        return
    panel.plot(compensated.x, correction, color=drawing.AXIS_COLOUR[axis], linewidth=0.8)
    low, high = float(np.nanmin(correction)), float(np.nanmax(correction))
    room = max(0.05 * (high - low), (MIN_SPAN[sensor] - (high - low)) / 2)
    panel.set_ylim(low - room, high + room)


def _background(panel: Axes, compensated: Compensated, axis: str) -> None:
    drawing.shade(panel, compensated.phases)
    drawing.name_axis(panel, axis)
    drawing.ticks(panel, 3, 3)
    panel.ticklabel_format(axis="both", useOffset=False)

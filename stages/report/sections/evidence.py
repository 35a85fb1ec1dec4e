"""What stands beside a finding of the recording: pictures, the two sides of a gap, two numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant, whole
from inertial.text.units import DEGREES, DEGREES_PER_SECOND, METRES
from stages.report.drawing import (
    INK,
    MISSING,
    QUIET,
    RULE,
    Margins,
    hatch_missing,
    side_by_side,
    style,
    svg,
)
from stages.report.outline import Column, Figure, Table, table_row
from stages.report.sections import finding_figures
from stages.report.sections.finding_figures import CloseUp, Span, close_ups, gaps_in
from stages.report.sections.raw_data import Log, logs
from stages.report.tables import Record, Tables

MOST_PICTURES = 25
OF_GAPS = frozenset({"gap", "incomplete_turn"})
OF_RATE = frozenset({"wrong_rate", "wrong_direction"})
# As many decimals as show a count of a good instrument.
SENSORS = (("gyro", _("Gyro"), DEGREES_PER_SECOND, 4), ("accel", _("Accelerometer"), METRES, 5))
Samples = tuple[str | int, ...]  # log, first and last record, channels


def evidence(tables: Tables, rows: Sequence[Record]) -> dict[str, list[Figure | Table]]:
    """What shows each finding, the worst first until there are enough pictures."""
    by_name = {log.name: log for log in logs(tables)}
    shown: dict[str, list[Figure | Table]] = {}
    drawn = 0
    seen: set[Samples] = set()
    for number, row in enumerate(rows, 1):
        shown[row["id"]] = []
        if drawn < MOST_PICTURES:
            shown[row["id"]] += _shown(tables, row, f"finding-{number}", by_name, seen)
            if compared := _compared(tables, row):
                shown[row["id"]].append(_comparison(compared, f"finding-{number}-expected"))
            drawn += sum(isinstance(part, Figure) for part in shown[row["id"]])
    return shown


def _shown(
    tables: Tables, row: Record, key: str, by_name: Mapping[str, Log], seen: set[Samples]
) -> Iterator[Figure | Table]:
    """The picture of a finding, unless a worse one has shown the same samples: it leads there."""
    if row["stage"] == "criticism":
        return  # its own section shows it
    close_up = close_ups(tables).get(row["id"])
    log = by_name.get(close_up.log if close_up else row["log"])
    if log is None:
        return
    gaps, masks = tables.frame("gaps"), tables.frame("masks")
    span = _span(row, log, close_up, gaps_in(close_up, gaps) if close_up else [])
    place = finding_figures.Place(row, log, span, close_up, gaps, masks)
    if close_up is not None:
        samples = (log.name, *close_up.record[[0, -1]].tolist(), *place.channels)
        if samples in seen:
            return
        seen.add(samples)
    if figure := finding_figures.figure(place, key):
        yield figure
    if row["cause"] in OF_GAPS and close_up is not None:
        yield from _two_records(close_up, gaps_in(close_up, gaps))


def _span(row: Record, log: Log, close_up: CloseUp | None, gaps: Sequence[int]) -> Span | None:
    """Where a finding is in its log: by its samples, where all of them are shown; else its time.

    A finding may stand for many: its time is then from the first to the last, its samples are
    those of the worst. `gaps`: of the close-up, the places of the records that follow one.
    """
    timed = log.timed and row["from_s"] is not None and row["log"] == log.name
    if close_up is not None and len(close_up.record):
        inside = np.flatnonzero(close_up.concerned)
        if not len(inside) and gaps:
            worst = close_up.longest_gap(gaps)
            inside = np.array([worst - 1, worst])
        ends_within = len(inside) > 0 and inside[-1] < len(close_up.record) - 1
        along = close_up.time if log.timed else close_up.record
        if ends_within:
            return float(along[inside].min()), float(along[inside].max())
        if not timed:
            return float(along.min()), float(along.max())
    if not timed:
        return None
    return row["from_s"], row["from_s"] if row["to_s"] is None else row["to_s"]


def _two_records(close_up: CloseUp, gaps: Sequence[int]) -> Iterator[Table]:
    """Line, time and six readings on both sides of the longest gap that is close up."""
    if not gaps:
        return
    after = close_up.longest_gap(gaps)
    places = [after - 1, after]
    columns = [Column(""), Column(_("Line"), "number"), Column(_("Time, s"), "number")]
    cells = [[_("before"), _("after")]]
    cells.append([whole(int(close_up.line[place])) for place in places])
    cells.append([fixed(float(close_up.time[place]), 3) for place in places])
    for sensor, name, unit, decimals in SENSORS:
        for axis in AXES:
            values = close_up.values[f"{sensor}_{axis}"][places] / unit.size
            if np.isfinite(values).any():
                columns.append(Column(axis, "number", f"{name}, {unit.name}"))
                cells.append([fixed(float(value), decimals) for value in values])
    rows = [table_row(*texts) for texts in zip(*cells, strict=True)]
    yield Table(_("The record before the gap and the record after it."), columns, rows)


# ---- two numbers: measured or stated, and expected

BAR = 0.62  # of the distance between bars
SIDES = (-0.5, 1.5)  # of the panel, in which the bars are at 0 and 1
LOWEST, HIGHEST = 0.25 - BAR / 4, 0.25 + BAR / 4  # of the lower bar, in shares of the panel
MIN_DIFFERENCE = 0.2  # relative, from which bars from 0 are distinct; dots on their own scale below
SIGMA = "σ"
NOISE_ALONE = 1.0  # what residuals are, in their sigma, where nothing is wrong


@dataclass(frozen=True)
class Compared:
    """Two numbers in one unit; `missing`: by what the second is short of the first, if stated."""

    quantity: str
    unit: str
    expected: float
    value: float
    missing: float = 0.0
    origin: str = _("measured")  # of the value

    @property
    def near(self) -> bool:
        """Whether bars from 0 would look alike."""
        limit = MIN_DIFFERENCE * abs(self.expected)
        return abs(self.value - self.expected) < limit and not self.missing

    def written(self, value: float) -> str:
        """A number with its unit."""
        digits = 7 if self.near else 2 if self.unit == SIGMA else 4
        return f"{significant(value, digits)} {self.unit}".replace(" °", "°")


def _compared(tables: Tables, row: Record) -> Compared | None:
    """The two numbers that a finding is about; none where it is not about such."""
    cause, size = row["cause"], row["size"]
    plan, done = (_of_manoeuvre(tables, table, row) for table in ("manoeuvres", "performed"))
    if cause in ("incomplete_turn", "wrong_angle") and plan.get("angle") and done.get("angle"):
        short = (done.get("missing_angle") or 0.0) / DEGREES.size
        planned, measured = plan["angle"] / DEGREES.size, done["angle"] / DEGREES.size
        return Compared(_("angle"), "°", planned, measured, short)
    if cause in OF_RATE and plan.get("rate") and done.get("rate"):
        rates = (plan["rate"], done["rate"])
        return Compared(_("rate"), "°/s", *(rate / DEGREES_PER_SECOND.size for rate in rates))
    return None if size is None else _by_size(tables, row, size)


def _by_size(tables: Tables, entry: Record, size: float) -> Compared | None:
    """Those of a finding whose size says how far it is off."""
    campaign = tables.row("campaign")
    rate = campaign["rate"]
    known = {row["quantity"]: row["value"] for row in tables.rows("known")}
    gravity = known.get("gravity")
    if entry["cause"] == "unexplained":
        return Compared(_("residuals"), SIGMA, NOISE_ALONE, size)
    if entry["cause"] == "rate_off" and rate:
        return Compared(_("samples per second"), "Hz", rate, rate * size)
    if entry["cause"] == "wrong_scale_factor" and entry["sensor"] == "accel" and gravity:
        return Compared(_("specific force at rest"), "m/s²", gravity, gravity * size)
    if entry["cause"] == "gravity_error" and gravity:
        normal = gravity if _gravity_set_right(tables) else gravity - size
        return Compared(_("gravity"), "m/s²", normal, normal + size, origin=_("stated"))
    return None


def _gravity_set_right(tables: Tables) -> bool:
    """Whether normal gravity is used in place of the stated one."""
    states = {row["state"] for row in tables.rows("plan_repairs") if row["repair"] == "gravity"}
    return not states.isdisjoint(("applied", "confirmed"))


def _of_manoeuvre(tables: Tables, table: str, row: Record) -> Mapping[str, Any]:
    rows = (each for each in tables.rows(table) if each["manoeuvre"] == row["manoeuvre"])
    return next(rows, {})


def _comparison(shown: Compared, key: str) -> Figure:
    """Two bars, one below the other; or two dots, where bars would look alike."""
    expected, value = shown.written(shown.expected), shown.written(shown.value)
    caption = _(
        "{capitalize}: {value} {origin}, {expected} expected.",
        capitalize=shown.quantity.capitalize(),
        value=value,
        origin=shown.origin,
        expected=expected,
    )
    if shown.missing:
        caption += _(" Hatched: {missing} not recorded.", missing=shown.written(shown.missing))
    with style():
        drawn, (panel,) = side_by_side((1.0,), 0.36, Margins(left=0.75, right=1.2, top=0.06))
        if shown.near:
            _dots(panel, shown)
        else:
            _bars(panel, shown)
        panel.set_yticks([1, 0], [_("expected"), shown.origin])
        panel.set_ylim(*SIDES)
        for side, text in ((1, expected), (0, value)):
            panel.annotate(
                text,
                (1.0, side),
                xycoords=("axes fraction", "data"),
                xytext=(4, 0),
                textcoords="offset points",
                va="center",
            )
        panel.set_xlabel(f"{shown.quantity}, {shown.unit}")
        panel.grid(visible=False, axis="y")
        return Figure(caption, svg(drawn, key), caption)


def _bars(panel: Axes, shown: Compared) -> None:
    panel.barh([1, 0], [shown.expected, shown.value], BAR, color=[RULE, QUIET])
    if shown.missing:
        hatch_missing(panel, shown.value, shown.value + shown.missing, ymin=LOWEST, ymax=HIGHEST)
    panel.axvline(0, color=INK, linewidth=0.6)
    ends = (shown.expected, shown.value, shown.value + shown.missing, 0.0)
    panel.set_xlim(min(ends), max(ends))
    if shown.expected < 0:
        panel.invert_xaxis()  # what was expected runs to the right


def _dots(panel: Axes, shown: Compared) -> None:
    for side, value, colour in ((1, shown.expected, QUIET), (0, shown.value, MISSING)):
        panel.axvline(value, color=colour, linewidth=0.5, dashes=(3, 3))
        panel.plot([value], [side], "o", color=colour, markersize=5)
    panel.margins(x=0.3)
    panel.ticklabel_format(axis="x", useOffset=False, style="plain")

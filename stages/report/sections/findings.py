"""What shows each cause: pictures, and the findings that are behind it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from inertial.campaign.competition import circumstances
from inertial.sensors import SINGULAR
from inertial.tables import AXES
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import fixed, probability, shortened, significant, whole
from inertial.text.typography import capital
from inertial.text.units import DEGREES, DEGREES_PER_SECOND, METRES
from stages.report.declared import DECLARED
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
from stages.report.outline import (
    Column,
    Figure,
    Heading,
    Paragraph,
    Part,
    Section,
    Table,
    columns,
    more,
    table_row,
)
from stages.report.sections import finding_figures
from stages.report.sections.finding_figures import CloseUp, Span, close_ups, gaps_in
from stages.report.sections.raw_data import Log, logs
from stages.report.tables import Record, Tables, once
from stages.report.words import size_in_words

FINDINGS = (
    "quality_findings",
    "segment_findings",
    "noise_findings",
    "accelerometer_findings",
    "gyroscope_findings",
    "criticism_findings",
)
FINDING_TABLES = (
    *FINDINGS,
    "causes",
    "cause_members",
    "consequences",
    "verdict",
)
MODEL = "criticism"  # the stage whose findings are about the model, not about the recording
MOST_ROWS = 30  # findings of a cause that are listed
MOST_SHOWN = 4  # findings of a cause that have a picture
MOST_NAMES = 3  # members of a class in a title
MAX_HARMLESS_MOVE, MAX_MOVE = 0.5, 1.0  # sigma of a parameter
# Cures, that which asks most of the reader first.
CURES = ("repaired", "left_out", "modelled", "curve", "interpolated", "masked", "none")


@once
def causes(tables: Tables) -> list[Record]:
    """The causes: what spoils a result first, then by their cures, and what is harmless last."""
    return sorted(
        tables.rows("causes"),
        key=lambda row: (
            not spoils(tables, row),
            harmless(row),
            CURES.index(row["cure"]),
            -(row["moves"] or 0.0),
            row["id"],
        ),
    )


def spoils(tables: Tables, row: Record) -> bool:
    """Whether a cause that is not removed makes a result not usable."""
    if row["cure"] != "none":
        return False
    if row["moves"] is not None:
        return bool(row["moves"] > MAX_MOVE)
    lost = {each["sensor"] for each in tables.rows("verdict") if each["verdict"] == "not_usable"}
    return bool(lost) and row["sensor"] in (*lost, None)


def harmless(row: Record) -> bool:
    """Whether a cause needs no cure, for it moves no parameter of the result."""
    moves = row["moves"]
    return row["cure"] == "none" and moves is not None and bool(moves < MAX_HARMLESS_MOVE)


@once
def findings_by_id(tables: Tables) -> dict[str, Record]:
    """All findings by their identifiers, each with its stage."""
    return {
        row["id"]: row | {"stage": DECLARED.reads[name].stage}
        for name in FINDINGS
        for row in tables.rows(name)
    }


def findings_of(tables: Tables, cause: Record) -> list[Record]:
    """The findings that a cause explains, its own first, then the worst."""
    every = findings_by_id(tables)
    own = [row["finding"] for row in tables.rows("consequences") if row["cause"] == cause["id"]]
    rows = [every[finding] for finding in own if finding in every]
    return sorted(
        rows, key=lambda row: (row["cause"] != cause["cause"], -row["severity"], -row["count"])
    )


def in_recording(tables: Tables, cause: Record) -> bool:
    """Whether a finding of the recording shows a cause, so that it stands in this section."""
    return any(row["stage"] != MODEL for row in findings_of(tables, cause))


@once
def cause_of_finding(tables: Tables) -> dict[str, Record]:
    """By the identifier of a finding the cause that explains it."""
    by_id = {row["id"]: row for row in tables.rows("causes")}
    return {row["finding"]: by_id[row["cause"]] for row in tables.rows("consequences")}


def title_of(tables: Tables, row: Record) -> str:
    """What it is, its class, and where; equal ones in several places have no place."""
    own = [in_words(one["member"]) for one in members(tables, row)]
    names = [*dict.fromkeys(own)] or [in_words(row["cause"])]
    if len(names) > MOST_NAMES:
        names = [*names[: MOST_NAMES - 1], _("{count} others", count=len(names) - MOST_NAMES + 1)]
    name, where = listed(names, "or"), concerned(row)
    if row["sensor"] and SINGULAR[row["sensor"]] in name:
        where = _("{axis} axis", axis=row["axis"]) if row["axis"] else ""
    place = (row["manoeuvre"] or row["log"]) if row["count"] == 1 else None
    return _joined(capital(name), place, where)


def concerned(row: Record) -> str:
    """The sensor and the axis that a row is about."""
    sensor = SINGULAR.get(row["sensor"] or "", "")
    return f"{row['axis']} {sensor}" if row["axis"] and sensor else sensor


def _joined(*texts: str | None) -> str:
    return " · ".join(shortened(text, 120) for text in texts if text)


def members(tables: Tables, row: Record) -> list[Record]:
    """The members of its class, the most probable first; none where it is no class."""
    if row["verdict"] != "one_of_class":
        return []
    own = [each for each in tables.rows("cause_members") if each["cause"] == row["id"]]
    return sorted(own, key=lambda each: int(each["rank"]))


# ---- The section.


def parts(tables: Tables) -> Iterator[Part]:
    """For each cause what shows it, and the findings behind it."""
    rows = causes(tables)
    own = {row["id"]: findings_of(tables, row) for row in rows if in_recording(tables, row)}
    if not own:
        yield Paragraph(_("No fault was detected in the recording and its segments."), "good")
    for row in circumstances(tables.rows("segment_findings")):
        yield Paragraph(f"{row['sentence']} {row['consequence']} {row['action']}")
    shown = evidence(tables, [each for found in own.values() for each in found[:MOST_SHOWN]])
    for row in (row for row in rows if row["id"] in own):
        yield Heading(title_of(tables, row), f"evidence/{row['id']}")
        for finding in own[row["id"]][:MOST_SHOWN]:
            if finding["stage"] != MODEL:  # whose own section shows it
                yield from shown[finding["id"]]
        yield _table(own[row["id"]])


def _table(findings: list[Record]) -> Table:
    return Table(
        _("The findings behind it."),
        columns("text", _("Finding"), _("Where"))
        + columns("number", _("Time"), _("Size"), _("Times"), "p")
        + columns("identifier", _("Identifier")),
        [
            table_row(
                capital(in_words(row["cause"])),
                _joined(row["manoeuvre"] or row["log"], concerned(row)),
                _time(row) or "—",
                size_in_words(row) or "—",
                whole(row["count"]),
                "—" if row["p_value"] is None else probability(row["p_value"]),
                row["id"],
            )
            for row in findings[:MOST_ROWS]
        ],
        note=more(len(findings) - MOST_ROWS, _(" in the tables of findings")),
    )


SECTION = Section(
    "findings",
    _("What shows each cause"),
    _("The pictures and the findings behind each cause of section 2."),
    _(
        "Left, the whole log, where a wedge marks the place; right, the samples there. p is the "
        "probability of such a size if nothing is wrong; what concerns the model alone stands "
        "in “What shows each effect”."
    ),
    (
        *FINDING_TABLES,
        *("campaign", "known", "manoeuvres", "performed", "clocks", "segments", "traces"),
        *("plan_repairs", "gaps", "masks", "quality_close_ups", "segment_close_ups"),
    ),
    parts,
)


def _time(row: Record) -> str | None:
    start, end = row["from_s"], row["to_s"]
    if start is None:
        return None
    if end is None or end == start:
        return f"{fixed(start, 2)} s"
    return f"{fixed(start, 2)} … {fixed(end, 2)} s"


# ---- What stands beside a finding of the recording: pictures, the two sides of a gap, two numbers.

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
            shown[row["id"]] += _shown_beside(tables, row, f"finding-{number}", by_name, seen)
            if compared := _compared(tables, row):
                shown[row["id"]].append(_comparison(compared, f"finding-{number}-expected"))
            drawn += sum(isinstance(part, Figure) for part in shown[row["id"]])
    return shown


def _shown_beside(
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

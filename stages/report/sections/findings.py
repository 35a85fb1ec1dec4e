"""What is wrong with the recording or the model, worst first, and which findings are related."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import combinations

from inertial.text.cause_names import how_grave, in_words, tally
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, probability, shortened, significant, whole
from stages.report.declared import DECLARED
from stages.report.linked import CAUSE_TABLES, effect_causes
from stages.report.outline import (
    Column,
    Figure,
    Finding,
    Link,
    Paragraph,
    Part,
    Section,
    Table,
    Tone,
    table_row,
)
from stages.report.sections.evidence import evidence
from stages.report.tables import Record, Tables, once
from stages.report.words import capital

FINDING_TABLES = (
    "quality_findings",
    "segment_findings",
    "accelerometer_findings",
    "criticism_findings",
    "compensation_findings",
)
MOST_IN_FULL = 40
MOST_RELATED = 4  # others that a finding refers to
DRIFT = "temperature_drift"  # as the quality of the logs calls what goes with the temperature
POSITION = "table_position_error"  # what an effect of the accelerometers may have been taken for
MODEL = "criticism"  # the stage whose findings are about the model, not about the recording
WITH_TEMPERATURE = {
    f"{sensor}_{what}_temperature" for sensor in ("accel", "gyro") for what in ("bias", "scale")
}
NAMED = ("found", "one_of_class")
LINES = {"oscillation", "table_ripple", "table_eccentricity"}  # periodic in turns, all of them
Span = tuple[float, float]


@once
def ranked(tables: Tables) -> list[Record]:
    """All findings, worst first: by severity, then the least likely by chance, then by count."""
    return sorted(
        (
            row | {"stage": DECLARED.reads[name].stage}
            for name in FINDING_TABLES
            for row in _rows(tables, name)
        ),
        key=lambda row: (
            -row["severity"],
            1.0 if row["p_value"] is None else row["p_value"],
            -row["count"],
            row["id"],
        ),
    )


def _rows(tables: Tables, name: str) -> list[Record]:
    return effect_causes(tables) if name == "criticism_findings" else tables.rows(name)


@once
def model_findings(tables: Tables) -> list[Record]:
    """Those about the model, worst first."""
    return [row for row in ranked(tables) if row["stage"] == MODEL]


@once
def related_findings(tables: Tables) -> dict[str, list[Record]]:
    """Of those shown in full, by identifier, the others that concern the same fault."""
    return related(ranked(tables)[:MOST_IN_FULL], tables.rows("segments"))


def related(rows: Sequence[Record], segments: Sequence[Record]) -> dict[str, list[Record]]:
    """For each finding, by its identifier, those of other stages that concern the same fault.

    They have the same cause in the same sensor, or may be the same effect; or the first lies, for
    at least half of its time, in the stretch of the same log that the second is about, or in its
    manoeuvre.
    """
    spans = {row["id"]: _span(row, segments) for row in rows}
    others_of: dict[str, list[Record]] = {}
    for entry, other in combinations(rows, 2):
        same_log = entry["log"] is not None and entry["log"] == other["log"]
        same_place = same_log and _lies_in(spans[entry["id"]], spans[other["id"]], entry, other)
        same_cause = _same_sensor(entry, other) and not _causes(entry).isdisjoint(_causes(other))
        if entry["stage"] != other["stage"] and (same_cause or same_place):
            others_of.setdefault(entry["id"], []).append(other)
            others_of.setdefault(other["id"], []).append(entry)
    return {identifier: others[:MOST_RELATED] for identifier, others in others_of.items()}


def _same_sensor(row: Record, other: Record) -> bool:
    """A thermometer may drift for both sensors."""
    either = (row["sensor"], other["sensor"])
    return either[0] == either[1] or (None in either and DRIFT in (row["cause"], other["cause"]))


def _causes(row: Record) -> set[str]:
    """What a finding is about: its cause, those that it may be, and what both look like."""
    causes = {row["cause"], *(row.get("members") or ())}
    if causes & WITH_TEMPERATURE or row.get("predictor") == "temperature":
        causes.add(DRIFT)
    if row["sensor"] == "accel" and (row.get("verdict") or "") in NAMED:
        causes.add(POSITION)
    return causes | (LINES if causes & LINES else set())


def _span(row: Record, segments: Sequence[Record]) -> Span | None:
    if row["from_s"] is not None:
        return row["from_s"], row["from_s"] if row["to_s"] is None else row["to_s"]
    own = [
        part
        for part in segments
        if (part["manoeuvre"], part["log"]) == (row["manoeuvre"], row["log"])
        and None not in (part["from_s"], part["to_s"])
    ]
    if not own:
        return None
    return min(part["from_s"] for part in own), max(part["to_s"] for part in own)


def _lies_in(a: Span | None, b: Span | None, row: Record, other: Record) -> bool:
    """Whether the one without a manoeuvre lies in the one with it; either way if both are alike."""
    if a is None or b is None:
        return False
    ways = [(a, b)] if other["manoeuvre"] else []
    ways += [(b, a)] if row["manoeuvre"] else []
    return any(_within(inner, outer) for inner, outer in ways or [(a, b), (b, a)])


def _within(inner: Span, outer: Span) -> bool:
    shared = min(inner[1], outer[1]) - max(inner[0], outer[0])
    return shared >= 0 and shared >= (inner[1] - inner[0]) / 2


# ---- the section

COUNTED = frozenset({"samples", "records", "readings", "days"})  # units of sizes that are counts
TONE: dict[int, Tone] = {3: "poor", 2: "fair"}
SENSOR = {"accel": "accelerometer", "gyro": "gyroscope"}


def parts(tables: Tables) -> Iterator[Part]:
    """Each finding with its sentence, what shows it, its consequence and the action."""
    rows = ranked(tables)
    if not rows:
        yield Paragraph(
            _("None: neither in the recording, nor in its segments, nor in the model."), "good"
        )
        return
    severities = [row["severity"] for row in rows]
    yield Paragraph(tally(severities), TONE.get(severities[0], ""))
    shown = evidence(tables, rows[:MOST_IN_FULL])
    for row in rows[:MOST_IN_FULL]:
        yield _finding(tables, row, shown[row["id"]])
    if others := Counter(row["cause"] for row in rows[MOST_IN_FULL:]):
        yield Table(
            "Further findings by cause; in full in the findings tables of the campaign.",
            (Column("Cause"), Column("Findings", "number")),
            [table_row(in_words(cause), whole(count)) for cause, count in others.most_common()],
        )


SECTION = Section(
    "findings",
    "Findings",
    _(
        "Faults of the recording and misfits of the model, each with its consequence "
        "for the result and with the action that was taken or is recommended."
    ),
    _(
        "Worst first: findings that spoil a result, then those that weaken one, then "
        "those that are good to know. p is the probability of such a size if nothing is "
        "wrong. Left, the whole log, where a wedge marks the place; right, the samples "
        "there."
    ),
    (
        *FINDING_TABLES,
        *CAUSE_TABLES[1:],
        *("campaign", "known", "manoeuvres", "performed", "clocks", "segments", "traces"),
        *("gaps", "masks", "quality_close_ups", "segment_close_ups"),
    ),
    parts,
)


def title_of(row: Record) -> str:
    """What a finding is and where."""
    where = row["manoeuvre"] or row["log"]
    if not where and row["stage"] == MODEL:
        where = _("residuals of the model")
    sensor = SENSOR.get(row["sensor"] or "", row["sensor"])
    concerned = f"{row['axis']} {sensor}" if row["axis"] and sensor else ""
    places = [shortened(text, 60) for text in (where, concerned) if text]
    return " · ".join([capital(in_words(row["cause"])), *places])


def _links(tables: Tables, row: Record) -> Iterator[Link]:
    """To the findings that concern the same fault, those of the model in their own section."""
    if row["stage"] == MODEL:
        yield Link(
            _("Unmodelled effects: {cause}", cause=in_words(row["cause"])), f"effect/{row['id']}"
        )
    for other in related_findings(tables).get(row["id"], ()):
        yield Link(title_of(other), f"finding/{other['id']}")


def _finding(tables: Tables, row: Record, shown: list[Figure | Table]) -> Finding:
    facts = {
        "sensor": SENSOR.get(row["sensor"] or "", row["sensor"]) if not row["axis"] else None,
        "log": row["log"] if row["manoeuvre"] else None,
        "time": _time(row),
        "size": _size(row),
        "times": whole(row["count"]) if row["count"] > 1 else None,
        "p": None if row["p_value"] is None else probability(row["p_value"]),
        "identifier": row["id"],
    }
    return Finding(
        anchor=f"finding/{row['id']}",
        title=title_of(row),
        grade=how_grave(row["severity"]),
        sentence=shortened(row["sentence"], 600),
        answers=(
            ("Consequence", shortened(row["consequence"], 600)),
            ("Action", shortened(row["action"], 400)),
        ),
        facts=tuple((name, shortened(str(text), 120)) for name, text in facts.items() if text),
        parts=shown,
        links=tuple(_links(tables, row)),
        tone=TONE.get(row["severity"], ""),
    )


def _time(row: Record) -> str | None:
    start, end = row["from_s"], row["to_s"]
    if start is None:
        return None
    if end is None or end == start:
        return f"{fixed(start, 2)} s"
    return f"{fixed(start, 2)} … {fixed(end, 2)} s"


def _size(row: Record) -> str | None:
    if row["size"] is None:
        return None
    if row["unit"] in COUNTED:
        return counted(round(row["size"]), row["unit"].removesuffix("s"))
    size = f"{significant(row['size'])} {row['unit'] or ''}".strip().replace(" °", "°")
    return size.removesuffix(" 1")

"""What is wrong with the recording or the model, worst first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

import pandas as pd

from inertial.text import numbers
from inertial.text.cause_names import how_grave, in_words, tally
from stages.reporting.evidence import CRITICISM, Evidence
from stages.reporting.outline import (
    Column,
    Finding,
    Link,
    Paragraph,
    Part,
    Row,
    Section,
    Table,
    Tone,
)
from stages.reporting.related import related
from stages.reporting.rows import Record, records

COUNTED = frozenset(
    {"samples", "records", "readings", "days"}
)  # units of a size that is a number of them
MOST_IN_FULL = 40
TONE: dict[int, Tone] = {3: "poor", 2: "fair"}
SENSOR = {"accel": "accelerometer", "gyro": "gyroscope"}


def ranked(findings: Iterable[pd.DataFrame]) -> list[Record]:
    """All findings, worst first: by severity, then the least likely by chance, then by count."""
    rows = [row for frame in findings for row in records(frame)]
    return sorted(
        rows,
        key=lambda row: (
            -row["severity"],
            1.0 if row["p_value"] is None else row["p_value"],
            -row["count"],
            row["id"],
        ),
    )


def section(
    rows: Sequence[Record],
    evidence: Mapping[str, Evidence],
    segments: pd.DataFrame,
) -> Section:
    """Each finding with its sentence, what shows it, its consequence and the action."""
    full = rows[:MOST_IN_FULL]
    others = related(full, records(segments))
    nothing = Evidence()
    parts: list[Part] = []
    if rows:
        worst = rows[0]["severity"]
        parts.append(Paragraph(tally([row["severity"] for row in rows]), TONE.get(worst, "")))
    else:
        parts.append(
            Paragraph(
                "None: neither the recording, nor its segments, nor the model gave cause.", "good"
            )
        )
    parts += [_finding(row, evidence.get(row["id"], nothing), links(row, others)) for row in full]
    if len(rows) > MOST_IN_FULL:
        rest = Counter(row["cause"] for row in rows[MOST_IN_FULL:])
        parts.append(
            Table(
                "The others, by cause; in full in the findings tables of the campaign.",
                (Column("Cause"), Column("Findings", "number")),
                tuple(
                    Row((in_words(cause), numbers.whole(count)))
                    for cause, count in rest.most_common()
                ),
            )
        )
    return Section(
        "findings",
        "Findings",
        "What was found wrong with the recording or the model, with what it does to the result "
        "and what was or should be done.",
        "Worst first: above, what spoils a result; then what weakens one; then what is good to "
        "know. p is the chance of such a size if nothing is wrong. Left, the whole log: a wedge "
        "marks the place; right, the samples there.",
        parts,
    )


def of_model(rows: Sequence[Record], segments: pd.DataFrame) -> dict[str, list[Link]]:
    """For each finding about the model the places that speak of the same thing; not its own."""
    others = related(rows[:MOST_IN_FULL], records(segments))
    return {
        row["id"]: [
            Link(f"Findings: {_title(other)}", f"finding/{other['id']}")
            for other in others.get(row["id"], ())
        ]
        for row in rows
        if row["id"].startswith(CRITICISM)
    }


def links(row: Record, others: Mapping[str, Sequence[Record]]) -> Iterator[Link]:
    """To the findings that speak of the same thing, those of the model in their own section."""
    if row["id"].startswith(CRITICISM):
        yield Link(f"What the model lacks: {in_words(row['cause'])}", f"lacks/{row['id']}")
    for other in others.get(row["id"], ()):
        yield Link(_title(other), f"finding/{other['id']}")


def _title(row: Record) -> str:
    """What it is and where."""
    cause = in_words(row["cause"])
    where = row["manoeuvre"] or row["log"]
    if not where and row["id"].startswith(CRITICISM):
        where = "residuals of the model"
    sensor = SENSOR.get(row["sensor"] or "", row["sensor"])
    concerned = f"{row['axis']} {sensor}" if row["axis"] and sensor else ""
    places = [numbers.shortened(text, 60) for text in (where, concerned) if text]
    return " · ".join([cause[:1].upper() + cause[1:], *places])


def _finding(row: Record, evidence: Evidence, links: Iterable[Link]) -> Finding:
    span = None
    if row["from_s"] is not None:
        span = numbers.fixed(row["from_s"], 2)
        if row["to_s"] is not None and row["to_s"] != row["from_s"]:
            span += f" … {numbers.fixed(row['to_s'], 2)}"
        span += " s"
    size = None
    if row["size"] is not None:
        size = f"{numbers.significant(row['size'])} {row['unit'] or ''}".strip().replace(" °", "°")
        size = size.removesuffix(" 1")
        if row["unit"] in COUNTED:
            size = numbers.counted(round(row["size"]), row["unit"].removesuffix("s"))
    facts = {
        "sensor": SENSOR.get(row["sensor"] or "", row["sensor"]) if not row["axis"] else None,
        "log": row["log"] if row["manoeuvre"] else None,
        "time": span,
        "size": size,
        "times": numbers.whole(row["count"]) if row["count"] > 1 else None,
        "p": None if row["p_value"] is None else numbers.probability(row["p_value"]),
        "identifier": row["id"],
    }
    return Finding(
        anchor=f"finding/{row['id']}",
        title=_title(row),
        grade=how_grave(row["severity"]),
        sentence=numbers.shortened(row["sentence"], 600),
        consequence=numbers.shortened(row["consequence"], 600),
        action=numbers.shortened(row["action"], 400),
        parts=evidence.parts,
        facts=tuple(
            (name, numbers.shortened(str(value), 120)) for name, value in facts.items() if value
        ),
        links=tuple(links),
        tone=TONE.get(row["severity"], ""),
    )

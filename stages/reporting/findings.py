"""What is wrong with the recording or the model, worst first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

import pandas as pd

from stages.reporting import numbers
from stages.reporting.outline import Column, Finding, Paragraph, Part, Row, Section, Table, Tone
from stages.reporting.rows import Record, records

MOST_IN_FULL = 40
TONE: dict[int, Tone] = {3: "poor", 2: "fair"}


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


def section(rows: Sequence[Record]) -> Section:
    """Each finding with its sentence, its consequence and the action."""
    parts: list[Part] = [_finding(row) for row in rows[:MOST_IN_FULL]]
    if not rows:
        parts.append(
            Paragraph(
                "None: neither the recording, nor its segments, nor the model gave cause.", "good"
            )
        )
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
        "know. p is the chance of such a size if nothing is wrong.",
        parts,
    )


def in_words(cause: str) -> str:
    """The name of a cause or an effect as it is read."""
    words = cause.replace("_", " ").replace("g sensitivity", "g-sensitivity")
    if words.startswith("accel "):
        words = words.replace("accel", "accelerometer", 1)
    return numbers.shortened(words, 60)


def _finding(row: Record) -> Finding:
    sensor = {"accel": "accelerometer", "gyro": "gyroscope"}.get(row["sensor"] or "", row["sensor"])
    span = None
    if row["from_s"] is not None:
        span = numbers.fixed(row["from_s"], 2)
        if row["to_s"] is not None and row["to_s"] != row["from_s"]:
            span += f" … {numbers.fixed(row['to_s'], 2)}"
        span += " s"
    size = None
    if row["size"] is not None:
        size = f"{numbers.significant(row['size'])} {row['unit'] or ''}".strip()
        size = size.removesuffix(" 1")
    facts = {
        "sensor": " ".join(filter(None, (sensor, row["axis"]))),
        "manoeuvre": row["manoeuvre"],
        "log": row["log"],
        "time": span,
        "size": size,
        "times": numbers.whole(row["count"]) if row["count"] > 1 else None,
        "p": None if row["p_value"] is None else numbers.probability(row["p_value"]),
        "identifier": row["id"],
    }
    return Finding(
        anchor=f"finding/{row['id']}",
        sentence=numbers.shortened(row["sentence"], 600),
        consequence=numbers.shortened(row["consequence"], 400),
        action=numbers.shortened(row["action"], 400),
        facts=tuple(
            (name, numbers.shortened(str(value), 120)) for name, value in facts.items() if value
        ),
        tone=TONE.get(row["severity"], ""),
    )

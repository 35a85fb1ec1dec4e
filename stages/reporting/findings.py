"""Section 3: what is wrong with the recording or the model, worst first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

import pandas as pd

from stages.reporting import numbers
from stages.reporting.outline import Column, Finding, Paragraph, Part, Row, Section, Table
from stages.reporting.parameters import Estimate
from stages.reporting.rows import Record, records

MOST_IN_FULL = 40
SPOILING = ("wrong_unit",)  # findings that make every result wrong


def ranked(
    findings: Iterable[pd.DataFrame],
    performed: pd.DataFrame,
    segments: pd.DataFrame,
    found: Sequence[Estimate],
) -> list[Record]:
    """All findings, worst first, each with its `rank`.

    First a wrong unit and those that cost a manoeuvre (0: a fit left it out; 1: it
    is not complete), then the rest (2); within, the least likely by chance first,
    then the most frequent. A finding that names no manoeuvre concerns those that
    are recorded at its place.
    """
    left_out = " ".join(estimate.fit["left_out"] or "" for estimate in found if estimate.fit)
    incomplete = {
        row["manoeuvre"] for row in records(performed) if not (row["found"] and row["complete"])
    }

    spans = records(segments)

    def rank(row: Record) -> int:
        concerned = {row["manoeuvre"]} if row["manoeuvre"] else _recorded_at(row, spans)
        if row["cause"] in SPOILING or any(names(left_out, each) for each in concerned):
            return 0
        return 1 if concerned & incomplete else 2

    rows = [row | {"rank": rank(row)} for frame in findings for row in records(frame)]
    return sorted(
        rows,
        key=lambda row: (
            row["rank"],
            1.0 if row["p_value"] is None else row["p_value"],
            -row["count"],
            row["id"],
        ),
    )


def _recorded_at(finding: Record, spans: Sequence[Record]) -> set[str]:
    """The manoeuvres whose segments a finding of a log touches; all of the log without times."""

    def touches(span: Record) -> bool:
        if span["log"] != finding["log"]:
            return False
        times = (finding["from_s"], finding["to_s"], span["from_s"], span["to_s"])
        if any(time is None for time in times):
            return True
        return bool(span["from_s"] <= finding["to_s"] and span["to_s"] >= finding["from_s"])

    return {span["manoeuvre"] for span in spans if touches(span)}


def names(text: str, manoeuvre: str) -> bool:
    """Whether `text` names this manoeuvre, and not only one whose name begins alike."""
    padded = f" {text} "
    start = padded.find(manoeuvre)
    while start >= 0:
        before, after = padded[start - 1], padded[start + len(manoeuvre)]
        if not (before.isalnum() or before in "-_" or after.isalnum() or after in "-_"):
            return True
        start = padded.find(manoeuvre, start + 1)
    return False


def section(rows: Sequence[Record]) -> Section:
    """Each finding with its sentence, its consequence and the action."""
    parts: list[Part] = [_finding(row) for row in rows[:MOST_IN_FULL]]
    if not rows:
        parts.append(Paragraph("None: neither the recording nor its segments gave cause.", "good"))
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
        "What was found wrong with the recording, with what it does to the result and what was or "
        "should be done.",
        "Worst first: above, what cost a manoeuvre; then what weakens one; then what is good to "
        "know. p is the chance of such a size if nothing is wrong.",
        parts,
    )


def in_words(cause: str) -> str:
    """The name of a cause as it is read."""
    return numbers.shortened(cause.replace("_", " "), 60)


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
        tone="poor" if row["rank"] == 0 else "fair" if row["rank"] == 1 else "",
    )

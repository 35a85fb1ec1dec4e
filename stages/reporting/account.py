"""The account of every byte of the logs, and the lines that were refused."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import pandas as pd

from inertial.text import numbers
from stages.reporting.outline import Column, Heading, Paragraph, Part, Row, Section, Table
from stages.reporting.rows import Record, records

KINDS = ("decoded", "other message", "header", "blank", "not selected", "refused")
MOST_LINES = 20
MOST_REASONS = 20


def section(accounts: pd.DataFrame, refused: pd.DataFrame, inputs: pd.DataFrame) -> Section:
    """Lines by kind per log, bytes against the size of the file, and the refused lines."""
    rows = records(accounts)
    size = {row["file"]: row["size"] for row in records(inputs)}
    lines = records(refused)
    logs = tuple(_log(log, rows, size) for log in dict.fromkeys(row["log"] for row in rows))
    parts: list[Part] = [
        Table(
            "Lines of each log by what became of them.",
            (
                Column("Log"),
                *(Column(kind.capitalize(), "number") for kind in KINDS),
                Column("Bytes", "number"),
                Column("Size of the file", "number"),
                Column("", "mark"),
            ),
            logs,
            empty="None: no log was read.",
        )
    ]
    if others := [row for row in rows if row["kind"] == "other message"]:
        parts.append(_others(others))
    parts.append(Heading("Refused lines"))
    if lines:
        parts += _refused(lines)
    else:
        parts.append(Paragraph("Refused lines: none.", "good"))
    return Section(
        "account",
        "The account of every byte",
        "What became of every line of the logs: nothing is dropped unseen.",
        "✓ the bytes of all kinds add up to the size of the file.",
        parts,
    )


def _log(log: str, rows: list[Record], size: dict[str, int]) -> Row:
    own = [row for row in rows if row["log"] == log]
    lines: Counter[str] = Counter()
    for row in own:
        lines[row["kind"]] += row["lines"]
    accounted = sum(row["bytes"] for row in own)
    expected = size.get(log, size.get(log.rpartition(":")[0]))
    balanced = accounted == expected
    difference = "" if expected is None else f" {numbers.whole(accounted - expected)}"
    return Row(
        (
            numbers.shortened(log, 60),
            *(numbers.whole(lines[kind]) if lines[kind] else "" for kind in KINDS),
            numbers.whole(accounted),
            numbers.whole(expected),
            "✓" if balanced else f"✗ does not add up{difference}",
        ),
        tone="" if balanced else "poor",
    )


def _others(rows: list[Record]) -> Table:
    by_name: dict[str, list[int]] = {}
    for row in rows:
        name = by_name.setdefault(row["name"] or "without a name", [0, 0])
        name[0] += row["lines"]
        name[1] += row["bytes"]
    return Table(
        "Messages that the calibration does not use, all logs together.",
        (Column("Message"), Column("Lines", "number"), Column("Bytes", "number")),
        tuple(
            Row((numbers.shortened(name, 60), numbers.whole(lines), numbers.whole(size)))
            for name, (lines, size) in sorted(by_name.items())[:MOST_LINES]
        ),
    )


def _refused(lines: list[Record]) -> Iterator[Table]:
    reasons = Counter((row["log"], row["reason"]) for row in lines)
    yield Table(
        f"{numbers.counted(len(lines), 'refused line')}, by log and reason.",
        (Column("Log"), Column("Reason"), Column("Lines", "number")),
        tuple(
            Row((numbers.shortened(log, 60), numbers.shortened(reason, 300), numbers.whole(count)))
            for (log, reason), count in reasons.most_common(MOST_REASONS)
        ),
        note=_more(len(reasons) - MOST_REASONS),
    )
    yield Table(
        "The first of them, as they begin.",
        (Column("Log"), Column("Line", "number"), Column("Byte", "number"), Column("Text", "code")),
        tuple(
            Row(
                (
                    numbers.shortened(row["log"], 60),
                    numbers.whole(row["line"]),
                    numbers.whole(row["offset"]),
                    numbers.shortened(row["text"], 110) or "(empty)",
                )
            )
            for row in lines[:MOST_LINES]
        ),
        note=_more(len(lines) - MOST_LINES),
    )


def _more(count: int) -> str:
    return f"{numbers.whole(count)} more in the table of refused lines." if count > 0 else ""

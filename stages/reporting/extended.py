"""Which result of a sensor counts, the joint or the extended one, and what that is worth."""

from collections.abc import Iterator, Sequence

import pandas as pd

from stages.notation import numbers, units
from stages.reporting.outline import Column, Heading, Paragraph, Part, Row, Table, Tone
from stages.reporting.rows import Record, records

MOST_ROWS = 20
ATTITUDE, VELOCITY = "Attitude, mrad", "Velocity, m/s"
MILLI = units.Unit("mrad", 1e-3)
DEGREES = units.Unit("°/s", units.DEGREE)


def parts(decision: pd.DataFrame, worth: pd.DataFrame) -> Iterator[Part]:
    """The decision of every sensor that shows an effect, and the errors of a user."""
    asked = [row for row in records(decision) if row["effects"]]
    if asked:
        yield Heading("Which result counts")
    for row in asked:
        tone: Tone = "good" if row["result"] == "extended" else "fair"
        yield Paragraph(numbers.shortened(said(row), 900), tone)
    if rows := records(worth):
        yield Heading("What it is worth to a user")
        yield _worth(rows)


def said(row: Record) -> str:
    """The decision in words, with its mount where there are several."""
    return f"Mount {row['mount']}: {row['sentence']}" if row["mount"] else str(row["sentence"])


def _worth(rows: Sequence[Record]) -> Table:
    rows = sorted(rows, key=lambda row: -row["velocity_joint"])
    shown, more = rows[:MOST_ROWS], len(rows) - MOST_ROWS
    seconds = numbers.whole(shown[0]["seconds"])
    return Table(
        f"Errors of free inertial navigation after {seconds} s, the attitude known at its start: "
        "of a user who corrects with the joint result and knows nothing of the effects, and what "
        "the extended result, with the effects, leaves uncertain.",
        (
            Column("Manoeuvre"),
            Column("Motion"),
            Column("joint", "number", ATTITUDE),
            Column("± σ", "sigma", ATTITUDE),
            Column("extended", "number", ATTITUDE),
            Column("joint", "number", VELOCITY),
            Column("± σ", "sigma", VELOCITY),
            Column("extended", "number", VELOCITY),
        ),
        tuple(
            Row(
                (
                    numbers.shortened(row["manoeuvre"], 60),
                    _motion(row),
                    *_cells(row, "attitude", MILLI),
                    *_cells(row, "velocity", units.Unit("m/s", 1.0)),
                )
            )
            for row in shown
        ),
        note="Each as if the manoeuvre went on so long. Only what the named effects do is in it."
        + (f" {numbers.whole(more)} more in the table of worth." if more > 0 else ""),
    )


def _motion(row: Record) -> str:
    if row["motion"] == "rest":
        return "at rest"
    return f"turning, {numbers.significant(DEGREES.of(row['rate']), 2)} °/s"


def _cells(row: Record, what: str, unit: units.Unit) -> tuple[str, str, str]:
    each = (row[f"{what}_joint"], row[f"{what}_joint_sigma"], row[f"{what}_extended"])
    joint, sigma, extended = (numbers.significant(unit.of(value), 2) for value in each)
    return joint, sigma, extended

"""What the plan wanted and what was recorded of it."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from inertial.tables import AXES
from inertial.text import numbers
from inertial.text.units import DEGREES, DEGREES_PER_SECOND
from stages.reporting.outline import Column, Row, Section, Table, Tone
from stages.reporting.rows import Record, records

COLUMNS = (
    Column("", "mark"),
    Column("Manoeuvre", "name"),
    Column("Set", "name"),
    Column("plan", "number", "Angle, °"),
    Column("recorded", "number", "Angle, °"),
    Column("missing", "number", "Angle, °"),
    Column("plan", "number", "Rate, °/s"),
    Column("recorded", "number", "Rate, °/s"),
    Column("plan", "number", "Time, s"),
    Column("recorded", "number", "Time, s"),
    Column("In words", "note"),
)
NUMBERS = slice(3, 10)


def section(manoeuvres: pd.DataFrame, performed: pd.DataFrame) -> Section:
    """One row per manoeuvre of the plan."""
    done = {row["manoeuvre"]: row for row in records(performed)}
    rows = [_row(row, done.get(row["manoeuvre"])) for row in records(manoeuvres)]
    return Section(
        "recorded",
        "What was recorded",
        "Every manoeuvre of the plan beside what its log holds of it.",
        "✓ recorded from rest to rest as planned; ◐ found, not complete; ✗ not found. Angle and "
        "rate are about the axis of the turn, right-hand rule. The angle is a sum of increments.",
        (
            Table(
                f"{numbers.counted(len(rows), 'manoeuvre')} of the plan.".capitalize(),
                COLUMNS,
                tuple(_set_right(rows)),
                empty="None: the plan has no manoeuvre.",
            ),
        ),
    )


def _row(plan: Record, done: Record | None) -> Row:
    mark, tone = _mark(done)
    done = done or dict.fromkeys(("angle", "missing_angle", "rate", "seconds", "sentence"), None)
    turns = plan["do"] == "turn"
    return Row(
        (
            mark,
            numbers.shortened(plan["manoeuvre"], 28),
            attitude(plan),
            _number(DEGREES.of(plan["angle"]), 1),
            _number(DEGREES.of(done["angle"]) if turns else None, 2),
            _number(DEGREES.of(done["missing_angle"]) or None if turns else None, 2),
            _number(DEGREES_PER_SECOND.of(plan["rate"]), 1),
            _number(DEGREES_PER_SECOND.of(done["rate"]) if turns else None, 4),
            _number(plan["seconds"], 1),
            _number(done["seconds"], 1),
            numbers.shortened(done["sentence"] or "not found", 300),
        ),
        tone=tone,
    )


def _mark(done: Record | None) -> tuple[str, Tone]:
    if done is None or not done["found"]:
        return "✗", "poor"
    return ("✓", "") if done["complete"] else ("◐", "fair")


def _number(value: float | None, decimals: int) -> str:
    return "" if value is None else numbers.fixed(value, decimals)


def _set_right(rows: list[Row]) -> Iterator[Row]:
    """Digits under digits in every column of numbers."""
    columns = [
        numbers.aligned(column)
        for column in zip(*(row.cells[NUMBERS] for row in rows), strict=True)
    ]
    for row, cells in zip(rows, zip(*columns, strict=True), strict=True):
        yield Row((*row.cells[:3], *cells, *row.cells[10:]), tone=row.tone)


def attitude(plan: Record) -> str:
    """A manoeuvre in a few words: rest, +x up; turn about +x."""
    if plan["do"] == "turn":
        return f"turn about {direction(plan, 'about')}"
    if plan["do"] == "positions":
        return "positions, attitudes unknown"
    return f"{plan['do']}, {direction(plan, 'up')} up"


def direction(plan: Record, stem: str) -> str:
    """A unit vector in words: +x, or its three components; unknown where it is not stated."""
    vector = [plan[f"{stem}_{axis}"] for axis in AXES]
    if any(value is None for value in vector):
        return "unknown"
    for axis, value in zip(AXES, vector, strict=True):
        if abs(abs(value) - 1) < 1e-9:
            return ("+" if value > 0 else "−") + axis
    return f"({', '.join(numbers.fixed(value, 2) for value in vector)})"

"""What the estimation took as known, how sure, and on whose word."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from inertial.text import numbers
from inertial.text.units import DEGREES, DEGREES_PER_HOUR, PPM, SECONDS_OF_ARC, Unit
from stages.reporting.outline import Column, Row, Section, Table
from stages.reporting.rows import Record, records

NAME = {
    "gravity": "gravity",
    "earth_rate_up": "earth rate, vertical part",
    "earth_rate_level": "earth rate, level part",
    "heading": "heading of the table's zero mark",
    "position": "attitude of a set position",
    "turn_angle": "angle of a turn",
    "turn_rate": "rate of the table, relative",
}
UNIT = {
    "earth_rate_up": DEGREES_PER_HOUR,
    "earth_rate_level": DEGREES_PER_HOUR,
    "heading": DEGREES,
    "position": SECONDS_OF_ARC,
    "turn_angle": SECONDS_OF_ARC,
    "turn_rate": PPM,
}
# Known as exactly what was set: only how far it may be off says something.
ERRORS = ("position", "turn_angle", "turn_rate")


def section(known: pd.DataFrame) -> Section:
    """One row per quantity."""
    rows = list(_rows(records(known)))
    return Section(
        "known",
        "What was taken as known",
        "The quantities that the estimation did not solve for.",
        "The σ of the parameters contain these; what is known without one is taken as exact. "
        "Stated: by the campaign file; computed: from what is stated; assumed: by the pipeline, "
        "for want of a statement.",
        (
            Table(
                "Taken as known.",
                (
                    Column("Quantity"),
                    Column("Value", "number"),
                    Column("± σ", "sigma"),
                    Column("Unit", "unit"),
                    Column("Origin"),
                ),
                tuple(rows),
            ),
        ),
    )


def _rows(known: list[Record]) -> Iterator[Row]:
    cells = [_cells(row) for row in known]
    if not cells:
        return
    values, sigmas = (numbers.aligned(column) for column in zip(*cells, strict=True))
    for row, value, sigma in zip(known, values, sigmas, strict=True):
        assumed = row["origin"].startswith("assumed")
        yield Row(
            (
                NAME.get(row["quantity"]) or numbers.shortened(row["quantity"], 60),
                value,
                sigma,
                _unit(row).name,
                numbers.shortened(row["origin"], 300),
            ),
            anchor=f"known/{row['quantity']}",
            tone="fair" if assumed else "",
        )


def _unit(row: Record) -> Unit:
    return UNIT.get(row["quantity"]) or Unit(row["unit"], 1.0)


def _cells(row: Record) -> tuple[str, str]:
    unit = _unit(row)
    value, sigma = unit.of(row["value"]), unit.of(row["sigma"])
    decimals = numbers.decimals_of(sigma)
    if row["value"] is None:
        return "not known", "—"
    if row["quantity"] in ERRORS:
        return "as set", numbers.significant(sigma, 2) if sigma else "—"
    if decimals is None:
        return numbers.significant(value, 7), "—"
    return numbers.fixed(value, decimals), numbers.fixed(sigma, decimals)

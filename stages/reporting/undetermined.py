"""What this campaign could not determine, and what was left out of the fits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from inertial.text import numbers
from stages.reporting.outline import Column, Paragraph, Part, Row, Section, Table
from stages.reporting.parameters import Estimate, symbol

MOST_SYMBOLS = 18


def section(found: Sequence[Estimate]) -> Section:
    """Parameters without a value with the reason; manoeuvres without a part in the fit."""
    rows = tuple(row for estimate in found for row in _undetermined(estimate))
    parts: list[Part] = [
        Table(
            "Parameters that are not determined.",
            (
                Column("Sensor, method"),
                Column("Parameters", "symbol"),
                Column("Reason, and what would help"),
            ),
            rows,
            empty="Not determined: none. Every parameter of every method has a value.",
        ),
        Table(
            "Manoeuvres by fit.",
            (Column("Sensor, method"), Column("Used"), Column("Left out, with the reason")),
            tuple(
                Row(
                    (
                        estimate.name,
                        numbers.shortened(estimate.fit["used"] or "none", 1500),
                        numbers.shortened(estimate.fit["left_out"] or "none", 1500),
                    ),
                    tone="fair" if estimate.fit["left_out"] else "",
                )
                for estimate in found
                if estimate.fit
            ),
            empty="No fit was made.",
        ),
    ]
    if not found:
        parts = [
            Paragraph("Nothing was determined: no method found the manoeuvres it needs.", "poor")
        ]
    return Section(
        "undetermined",
        "Not determined, and left out",
        "What the plan or the recording cannot fix, and which manoeuvres a fit did not use.",
        "A parameter that is not determined has no value anywhere in this report; it is not zero. "
        "Each reason names the manoeuvre that would help.",
        parts,
    )


def _undetermined(estimate: Estimate) -> Iterator[Row]:
    """One row per reason, its parameters together."""
    gaps = [row for row in estimate.parameters if row["value"] is None]
    for reason, group in groupby(gaps, lambda row: row["reason"]):
        each = [symbol(row["parameter"]) for row in group]
        more = f" and {len(each) - MOST_SYMBOLS} more" if len(each) > MOST_SYMBOLS else ""
        yield Row(
            (
                estimate.name,
                ", ".join(each[:MOST_SYMBOLS]) + more,
                numbers.shortened(reason or "no reason is stated", 600),
            ),
            tone="fair",
        )

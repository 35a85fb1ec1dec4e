"""Effects that were looked for and not found, and how small they would still have been seen."""

from collections.abc import Iterator, Sequence

from stages.notation import numbers, units
from stages.reporting.outline import Column, Row, Table
from stages.reporting.parameters import symbol
from stages.reporting.sought import LABORATORY, SI, Sought, capital

NOT_VISIBLE = "not visible by this plan"


def table(missed: Sequence[Sought]) -> Table:
    """One block of rows for each effect."""
    return Table(
        "Effects that were looked for and not found, with the smallest that this campaign could "
        "have seen (5 σ).",
        (
            Column("", "symbol"),
            Column("seen from", "number", LABORATORY),
            Column("unit", "unit", LABORATORY),
            Column("seen from", "number", SI),
            Column("unit", "unit", SI),
            Column("Meaning", "note"),
        ),
        tuple(row for one in missed for row in _rows(one)),
    )


def _rows(one: Sought) -> Iterator[Row]:
    cause = numbers.shortened(one.score["cause"], 300)
    if not one.score["degrees"]:
        told = numbers.shortened(one.score["sentence"], 300)
        yield Row((f"{capital(one.name)}: {told} {capital(cause)}.",), heads=True)
        return
    p_is = numbers.p_is(one.score["p_value"])
    yield Row((f"{capital(one.name)}: not needed ({p_is}). {capital(cause)}.",), heads=True)
    for row in one.parameters:
        if row["visible"] is None and row["unit"] == "Hz":
            continue  # any frequency is heard; what counts is the amplitude
        quantity = units.quantity(row["parameter"], row["unit"])
        seen = [
            (numbers.significant(unit.of(row["visible"]), 2), unit.name)
            if row["visible"] is not None
            else (NOT_VISIBLE, "")
            for unit in (quantity.laboratory, quantity.si)
        ]
        meaning = numbers.shortened(row["meaning"], 160)
        yield Row(
            (symbol(row["parameter"]), *seen[0], *seen[1], meaning),
            row["id"],
            "" if row["visible"] is not None else "fair",
        )

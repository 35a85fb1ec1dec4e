"""The parameters of an effect as criticism has them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from inertial.text import numbers, units
from stages.reporting.outline import Column, Row, Table
from stages.reporting.parameters import symbol, written
from stages.reporting.rows import Record
from stages.reporting.sought import LABORATORY, SI, capital

CLEAR = 3.0  # sigmas from which a parameter stands out
# As criticism writes it of a finding: k1_x = 1.2e-05 ± 3e-07 m/s²/K
TOLD = re.compile(r"(\S+) = (\S+)(?: ± (\S+))? (.+)")


def told(text: str | None, known: Sequence[Record]) -> list[Record]:
    """The parameters in a finding's own words; what they mean as far as it is known."""
    meanings = {row["parameter"]: row["meaning"] for row in known}
    found = []
    for part in (text or "").split("; "):
        match = TOLD.fullmatch(part.strip())
        if match is None:
            continue
        name, value, sigma, unit = match.groups()
        try:
            size, scatter = float(value), None if sigma is None else float(sigma)
        except ValueError:
            continue
        found.append(
            {
                "id": "",
                "parameter": name,
                "value": size,
                "sigma": scatter,
                "unit": unit,
                "meaning": meanings.get(name, ""),
            }
        )
    return found


def table(title: str, rows: Sequence[Record]) -> Table:
    """Those beyond 3 σ in the units of the laboratory and of the SI; how many others there are."""
    clear = [row for row in rows if _clear(row)]
    others = sum(row["value"] is not None and bool(row["sigma"]) for row in rows) - len(clear)
    gaps = sum(row["value"] is None for row in rows)
    more = [f"{numbers.counted(others, 'parameter')} within 3 σ of zero not listed"] * bool(others)
    more += [f"{numbers.counted(gaps, 'parameter')} not determined"] * bool(gaps)
    return Table(
        f"{capital(title)}: the parameters beyond 3 σ.",
        (
            Column("", "symbol"),
            Column("value", "number", LABORATORY),
            Column("± σ", "sigma", LABORATORY),
            Column("unit", "unit", LABORATORY),
            Column("value", "number", SI),
            Column("± σ", "sigma", SI),
            Column("unit", "unit", SI),
            Column("in σ", "number"),
            Column("Meaning", "note"),
        ),
        tuple(_rows(clear)),
        empty="None by itself: only together they are beyond noise.",
        note=capital("; ".join(more) + ".") if more else "",
    )


def _clear(row: Record) -> bool:
    value, sigma = row["value"], row["sigma"]
    return value is not None and bool(sigma) and bool(abs(value) > CLEAR * sigma)


def _rows(rows: Sequence[Record]) -> Iterator[Row]:
    for row, cells in zip(rows, written(rows), strict=True):
        value, sigma, si_value, si_sigma = cells
        quantity = units.quantity(row["parameter"], row["unit"])
        yield Row(
            (
                symbol(row["parameter"]),
                *(value, sigma, quantity.laboratory.name),
                *(si_value, si_sigma, quantity.si.name),
                numbers.significant(row["value"] / row["sigma"], 3),
                numbers.shortened(row["meaning"] or "", 160),
            ),
            row["id"],
        )

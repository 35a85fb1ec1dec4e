"""The parameters of the extended model beside those of the joint fit, and how far they move."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from inertial.text import numbers, units
from stages.reporting.outline import Column, Heading, Part, Row, Table
from stages.reporting.parameters import (
    KIND,
    Estimate,
    by_kind,
    in_units,
    in_words_of,
    kind_of,
    symbol,
)
from stages.reporting.rows import Record
from stages.reporting.sought import capital

CLEAR = 3.0  # sigmas of the joint fit from which a shift is marked
Pair = tuple[Record, Record | None]


@dataclass(frozen=True)
class Shift:
    """A parameter by the extended and by the joint fit, and how far apart in sigmas of the latter.

    `method`: the stage of its sensor, with @ and the mount where there are several.
    """

    method: str
    extended: Record
    joint: Record
    sigmas: float

    @property
    def name(self) -> str:
        """The parameter in words, a sentence beginning with it."""
        kind, _, axes = self.joint["parameter"].partition("_")
        sensor = in_words_of(self.method).lower()
        return capital(f"{KIND.get(kind, kind).lower()} {axes} of the {sensor}")


def parts(rows: Sequence[Record], joint: Sequence[Estimate]) -> Iterator[Part]:
    """A table for each sensor that shows an effect."""
    by_method = _pairs(rows, joint)
    if by_method:
        yield Heading("The parameters with the effects in the model")
    for method, pairs in by_method.items():
        yield Table(
            f"{in_words_of(method)}: the joint fit, and the same with the effects in the model.",
            (
                Column("", "symbol"),
                Column("value", "number", "Joint fit"),
                Column("± σ", "sigma", "Joint fit"),
                Column("value", "number", "Extended"),
                Column("± σ", "sigma", "Extended"),
                Column("unit", "unit"),
                Column("Shift, in σ of the joint fit", "number"),
                Column("Meaning", "note"),
            ),
            tuple(_beside(pairs)),
        )


def shifts(rows: Sequence[Record], joint: Sequence[Estimate]) -> list[Shift]:
    """How far each parameter moves with the effects in the model."""
    return [
        Shift(method, row, before, moved)
        for method, pairs in _pairs(rows, joint).items()
        for row, before in pairs
        if before is not None and (moved := _shift(row, before)) is not None
    ]


def _pairs(rows: Sequence[Record], joint: Sequence[Estimate]) -> dict[str, list[Pair]]:
    """Each parameter of the extended model with its like in the joint fit, by method."""
    before = {
        (estimate.stage, estimate.method, row["parameter"]): row
        for estimate in joint
        for row in estimate.determined
    }
    pairs: dict[str, list[Pair]] = {}
    for row in by_kind(row for row in rows if "." not in row["parameter"]):
        stage, _, mount = row["method"].partition("@")
        key = (stage, f"joint@{mount}" if mount else "joint", row["parameter"])
        pairs.setdefault(row["method"], []).append((row, before.get(key)))
    return pairs


def _beside(pairs: Sequence[Pair]) -> Iterator[Row]:
    gap = {"value": None, "sigma": None}
    cells: list[tuple[str, str]] = []
    for kind in dict.fromkeys(kind_of(row["parameter"]) for row, _ in pairs):
        group = [(row, old or row | gap) for row, old in pairs if kind_of(row["parameter"]) == kind]
        each = [units.quantity(row["parameter"], row["unit"]).laboratory for row, _ in group]
        both = in_units([r for pair in group for r in pair], [u for u in each for _ in range(2)])
        cells += both
    new, old = cells[::2], cells[1::2]
    columns = [
        numbers.aligned([pair[place] for pair in side]) for side in (old, new) for place in (0, 1)
    ]
    shifts = [_shift(row, before) for row, before in pairs]
    told = numbers.aligned([numbers.fixed(shift, 1) for shift in shifts])
    kind = ""
    for (row, _), shift, text, *line in zip(pairs, shifts, told, *columns, strict=True):
        if kind != kind_of(row["parameter"]):
            kind = kind_of(row["parameter"])
            yield Row((KIND.get(kind, kind),), heads=True)
        unit = units.quantity(row["parameter"], row["unit"]).laboratory
        far = shift is not None and abs(shift) > CLEAR
        yield Row(
            (
                symbol(row["parameter"]),
                *line,
                unit.name,
                text,
                numbers.shortened(row["meaning"], 160),
            ),
            row["id"],
            "fair" if far else "",
        )


def _shift(row: Record, before: Record | None) -> float | None:
    if before is None or row["value"] is None or not before["sigma"]:
        return None
    return float((row["value"] - before["value"]) / before["sigma"])

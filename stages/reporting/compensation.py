"""The compensated readings against what is known."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

import pandas as pd

from inertial.campaign.final_result import EXTENDED
from inertial.text import numbers
from inertial.text.units import DEGREES, DEGREES_PER_HOUR, METRES, MICRO_G, SECONDS_OF_ARC, Unit
from stages.reporting import compensated
from stages.reporting.certainty import SENSORS, listed
from stages.reporting.outline import Column, Heading, Paragraph, Part, Row, Section, Table
from stages.reporting.rows import Record, records

FAR = 3.0  # sigmas from which a check is marked
MOST_ROWS = 60


@dataclass(frozen=True)
class Checked:
    """A quantity that is checked: its name, the unit of its value, that of the difference."""

    name: str
    value: Unit
    difference: Unit
    in_full: bool = True


CHECKED = {
    "gravity": Checked("Gravity in every position", METRES, MICRO_G),
    # It is |f| but for the tilt; in full it would say the same again.
    "force_up": Checked("Specific force along up", METRES, MICRO_G, in_full=False),
    "rate_up": Checked("Earth's rate along up", DEGREES_PER_HOUR, DEGREES_PER_HOUR),
    "angle": Checked("Angle of every whole turn", DEGREES, SECONDS_OF_ARC),
}


def section(
    checks: pd.DataFrame,
    before: pd.DataFrame,
    after: pd.DataFrame,
    segments: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    decision: pd.DataFrame,
) -> Section:
    """The checks by quantity, and up to four figures; `decision`: whose extended result counts."""
    rows = records(checks)
    by_quantity = {
        quantity: [row for row in rows if row["quantity"] == quantity] for quantity in CHECKED
    }
    parts: list[Part] = [
        *_joint(records(decision)),
        _summary({q: own for q, own in by_quantity.items() if own}),
    ]
    parts += [
        Paragraph(numbers.shortened(row["sentence"], 900), "fair")
        for row in rows
        if row["quantity"] not in CHECKED
    ]
    drawn = list(compensated.figures(before, after, records(segments), records(manoeuvres)))
    parts.append(Heading("Before, after and difference"))
    parts += drawn or [Paragraph("None: no compensated log could be drawn.")]
    for quantity, own in by_quantity.items():
        if own and CHECKED[quantity].in_full:
            parts += [Heading(CHECKED[quantity].name), _table(CHECKED[quantity], own)]
    return Section(
        "compensation",
        "Compensation",
        "The readings with the errors taken out by the joint parameters, and whether they then "
        "show what is known: gravity in every position, the earth's rate, the angle of every turn.",
        "Before and after are differences from what is known. In σ is the difference that is left "
        "over its own sigma; beyond 3 these parameters are not all there is, and “What the model "
        "lacks” may say why. In the figures grey is before, colour after.",
        parts,
    )


def _joint(decision: Sequence[Record]) -> Iterator[Paragraph]:
    """That these are not the parameters that count, where they are not."""
    better = [SENSORS[row["sensor"]] for row in decision if row["result"] == EXTENDED]
    if better:
        yield Paragraph(
            f"The readings are corrected by the joint result, though of the "
            f"{listed(list(dict.fromkeys(better)))} the extended one counts: what the named "
            "effects do is still in them.",
            "fair",
        )


def _summary(by_quantity: Mapping[str, Sequence[Record]]) -> Table:
    return Table(
        "Root mean square of the difference from what is known, before and after.",
        (
            Column("Quantity"),
            Column("Checks", "number"),
            Column("before", "number", "rms"),
            Column("after", "number", "rms"),
            Column("unit", "unit", "rms"),
            Column("Largest, in σ", "number"),
            Column("Beyond 3 σ", "number"),
        ),
        tuple(_summed(CHECKED[quantity], own) for quantity, own in by_quantity.items()),
        empty="None: there is nothing compensated that could be checked.",
    )


def _summed(checked: Checked, rows: Sequence[Record]) -> Row:
    unit = checked.difference
    far = [abs(row["in_sigmas_after"]) for row in rows if row["in_sigmas_after"] is not None]
    beyond = sum(value > FAR for value in far)
    return Row(
        (
            checked.name,
            numbers.whole(len(rows)),
            *(numbers.significant(unit.of(_rms(rows, which)), 3) for which in ("before", "after")),
            unit.name,
            numbers.fixed(max(far, default=None), 1),
            numbers.whole(beyond),
        ),
        tone="fair" if beyond else "",
    )


def _rms(rows: Sequence[Record], which: str) -> float | None:
    off = [
        row[which] - row["expected"]
        for row in rows
        if row[which] is not None and row["expected"] is not None
    ]
    return sqrt(sum(value**2 for value in off) / len(off)) if off else None


def _table(checked: Checked, rows: Sequence[Record]) -> Table:
    shown = list(rows)
    more = len(shown) - MOST_ROWS
    if more > 0:
        shown.sort(key=lambda row: -abs(row["in_sigmas_after"] or 0.0))
        shown = shown[:MOST_ROWS]
    unit = checked.difference
    sigmas = [unit.of(row["after_sigma"]) for row in shown]
    decimals = numbers.common_decimals(sigmas)
    cells = [
        (
            numbers.fixed(checked.value.of(row["expected"]), 5),
            *(
                numbers.with_sigma(unit.of(_off(row, which)), sigma, decimals)[0]
                for which in ("before", "after")
            ),
            numbers.with_sigma(None, sigma, decimals)[1],
            numbers.fixed(row["in_sigmas_after"], 1),
        )
        for row, sigma in zip(shown, sigmas, strict=True)
    ]
    columns = [numbers.aligned(column) for column in zip(*cells, strict=True)]
    return Table(
        f"{checked.name}: {numbers.counted(len(rows), 'check')}.",
        (
            Column("Manoeuvre"),
            Column(f"Known, {checked.value.name}", "number"),
            Column("before", "number", f"Difference, {unit.name}"),
            Column("after", "number", f"Difference, {unit.name}"),
            Column("± σ", "sigma", f"Difference, {unit.name}"),
            Column("in σ", "number"),
        ),
        tuple(
            Row(
                (numbers.shortened(row["manoeuvre"] or "", 60), *line),
                row["id"],
                "fair" if abs(row["in_sigmas_after"] or 0.0) > FAR else "",
            )
            for row, line in zip(shown, zip(*columns, strict=True), strict=True)
        ),
        note=f"{numbers.whole(more)} more, nearer to what is known." if more > 0 else "",
    )


def _off(row: Record, which: str) -> float | None:
    if row[which] is None or row["expected"] is None:
        return None
    return float(row[which] - row["expected"])

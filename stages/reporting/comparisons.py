"""Rests against turns, forward against backward, method against method, published against ours."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from inertial.text import numbers, units
from stages.reporting.outline import Column, Paragraph, Part, Row, Section, Table
from stages.reporting.rows import Record, records

KINDS = {
    "static_against_turns": "Static, turn",
    "forward_against_backward": "Forward, backward",
    "method_against_method": "Two methods",
    "straight_line": "Rates, straight line",
    "published": "Published, ours",
    "fencepost": "Published, ours",
}
BEYOND = ": more than chance"  # as the sentences of comparison say it
MOST_ROWS = 120


def section(differences: pd.DataFrame) -> Section:
    """Every difference in units of its sigma with the verdict in words, worst first."""
    rows = sorted(
        records(differences),
        key=lambda row: (
            not _fencepost(row),
            row["in_sigmas"] is None,
            -abs(row["in_sigmas"] or 0.0),
            row["id"],
        ),
    )
    compared = [row for row in rows if row["in_sigmas"] is not None]
    beyond = [row for row in compared if _beyond(row)]
    parts: list[Part] = []
    if compared:
        told = numbers.counted(len(compared), "comparison")
        text = f"{numbers.counted(len(beyond), 'value')} of {told} differ by more than chance."
        if len(beyond) == 1:
            text = text.replace("differ ", "differs ")
        parts.append(Paragraph(text[:1].upper() + text[1:], "fair" if beyond else "good"))
    for row in filter(_fencepost, rows):
        said = str(row["sentence"])
        parts.append(Paragraph(said[:1].upper() + said[1:], "fair"))
    parts.append(_table(rows))
    if rows and not any(_kind(row) == "published" for row in rows):
        parts.append(Paragraph("Published values: none are known for this instrument."))
    return Section(
        "comparisons",
        "Comparisons",
        "Static against turn, forward against backward, method against method, published against "
        "ours: the same parameter by two ways that should agree.",
        "Worst first, the difference in units of its sigma. p is the chance of a difference this "
        "large if the two are the same; among many comparisons some are large by chance, which "
        "the verdict allows for.",
        parts,
    )


def _kind(row: Record) -> str:
    return str(row["kind"]).partition("@")[0]


def _fencepost(row: Record) -> bool:
    """Whether it says why published values are wrong, rather than that they are."""
    return _kind(row) == "fencepost"


def _beyond(row: Record) -> bool:
    return BEYOND in row["sentence"] or _fencepost(row)


def _table(rows: Sequence[Record]) -> Table:
    shown = rows[:MOST_ROWS]
    more = len(rows) - len(shown)
    sigmas = numbers.aligned([numbers.fixed(row["in_sigmas"], 1) for row in shown])
    return Table(
        f"Differences: {numbers.counted(len(rows), 'pair')} of values.",
        (
            Column("Compared"),
            Column("Verdict"),
            Column("first", "number", "Values"),
            Column("second", "number", "Values"),
            Column("unit", "unit", "Values"),
            Column("in σ", "number"),
            Column("p", "number"),
        ),
        tuple(_row(row, sigma) for row, sigma in zip(shown, sigmas, strict=True)),
        empty="None: no parameter was found in two ways that could be compared.",
        note=f"{numbers.whole(more)} more in the table of differences." if more > 0 else "",
    )


def _row(row: Record, sigma: str) -> Row:
    mount = numbers.shortened(str(row["kind"]).partition("@")[2], 60)
    kind = KINDS.get(_kind(row), numbers.shortened(_kind(row), 60))
    sentence = numbers.shortened(row["sentence"], 600)
    unit = units.quantity(row["parameter"].rpartition("/")[2], row["unit"]).laboratory
    decimals = numbers.decimals_of(unit.of(row["sigma"]))
    values = [
        numbers.significant(unit.of(row[which]), 5)
        if decimals is None
        else numbers.fixed(unit.of(row[which]), decimals)
        for which in ("first_value", "second_value")
    ]
    return Row(
        (
            f"{kind} (mount {mount})" if mount else kind,
            sentence[:1].upper() + sentence[1:],
            *values,
            unit.name,
            sigma,
            numbers.probability(row["p_value"]),
        ),
        row["id"],
        "fair" if _beyond(row) else "",
    )

"""The encoder of the table against the gyros: a part of the section of studies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.units import PPM, SECONDS_OF_ARC, Unit
from stages.report.outline import Column, Heading, Paragraph, Part, Row, Table, table_row
from stages.report.tables import Record, Tables

QUANTITIES = {
    "scale": _("scale factor of the gyro less that of the encoder"),
    "delay": _("delay of the gyro less that of the encoder"),
    "spread": _("variance of this delay: 0 where gyro and encoder are only late"),
    "low_pass": _("time constant of the gyro's low pass of first order, with that variance"),
    "dead_time": _("dead time of the gyro less latency of the encoder"),
    "sine": _("error of the encoder, sine of {order:g} times its angle"),
    "cosine": _("error of the encoder, cosine of {order:g} times its angle"),
    "ripple": _("ripple of the drive, {order:g} periods in a turn, amplitude"),
}
UNITS = {
    "1": PPM,
    "rad": SECONDS_OF_ARC,
    "s": Unit("ms", 1e-3),
    "s²": Unit(_("ms²"), 1e-6),
}


def encoder_parts(tables: Tables) -> Iterator[Part]:
    """What all turns have in common, and turn by turn; nothing without an encoder."""
    rows = tables.rows("encoder")
    if not rows:
        return
    yield Heading(_("Encoder of the table"))
    common = [row for row in rows if row["manoeuvre"] is None]
    yield _table(_("The encoder of the table against the gyros, all turns together."), common)
    of_turns = [row for row in rows if row["manoeuvre"] and row["quantity"] not in COMMON]
    yield _table(_("Turn by turn."), of_turns)
    yield Paragraph(
        _(
            "A scale factor that all gyros have in common and one of the encoder are one unknown: "
            "all scale factors of this result rest on the encoder's. A delay is that of the gyro "
            "less that of the encoder, by the ramps of the rate. {apart} A ripple of the drive is "
            "seen by both, an error of the encoder by the gyros alone; windows by the encoder are "
            "corrected for the harmonics above.",
            apart=_apart(common),
        )
    )


COMMON = ("delay", "spread", "sine", "cosine")  # shown of all turns together


def _apart(common: Sequence[Record]) -> str:
    """What of the delay is told apart."""
    if any(row["quantity"] == "low_pass" for row in common):
        return _(
            "Its variance tells the low pass of the gyro from times by which something is read "
            "late; of these, the dead time of the gyro and the latency of the encoder, only the "
            "difference is known."
        )
    return _(
        "Low pass and dead time of the gyro and latency of the encoder are one class: their sum, "
        "the encoder's negative, is known, its parts are not, for the variance of the delay is not "
        "certain. Steeper ramps, or more of them, tell the low pass apart."
    )


def _table(caption: str, rows: Sequence[Record]) -> Table:
    return Table(
        caption,
        (
            Column(_("Turn"), "name"),
            Column(_("Quantity")),
            Column(_("value"), "number"),
            Column("± σ", "sigma"),
            Column(_("unit"), "unit"),
            Column(_("p-value"), "number"),
        ),
        [_row(row) for row in rows],
        note=_("p-value: of a ripple, that there is none; of all turns, that they agree."),
    )


def _row(row: Record) -> Row:
    unit = UNITS[row["unit"]]
    sigma = unit.of(row["sigma"])
    return table_row(
        numbers.shortened(row["manoeuvre"] or _("all"), 60),
        QUANTITIES[row["quantity"]].format(order=row["order"] or 0),
        *numbers.with_own_sigma(unit.of(row["value"]), sigma),
        unit.name,
        numbers.probability(row["p_value"]),
    )

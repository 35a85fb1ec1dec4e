"""The figures by which the standards describe a sensor, over the inputs that were applied."""

from collections.abc import Iterator, Sequence

from inertial.campaign.records import grouped
from inertial.sensors import SINGULAR
from inertial.text import numbers
from inertial.text.messages import _, listed
from inertial.text.units import DEGREES_PER_HOUR, DEGREES_PER_SECOND, METRES, PPM, Unit
from stages.report.outline import (
    Column,
    Part,
    Row,
    Section,
    Sentences,
    Table,
    head,
    table_row,
    value_and_sigma,
)
from stages.report.tables import Record, Tables

NAMES = {
    "composite_error": _("Composite error, over the largest input"),
    "linearity_error": _("Linearity error, over the largest input"),
    "asymmetry": _("Scale factor asymmetry"),
    "threshold": _("Threshold"),
    "resolution": _("Resolution"),
    "acceleration_insensitive_drift": _("Acceleration-insensitive drift rate"),
}
UNITS = {"1": PPM, "rad/s": DEGREES_PER_HOUR, "m/s²": METRES}
INPUTS = {"rad/s": DEGREES_PER_SECOND, "m/s²": METRES}


def parts(tables: Tables) -> Iterator[Part]:
    """One table of both sensors, and why figures are missing."""
    rows = tables.rows("characteristics")
    known = [row for row in rows if row["value"] is not None or row["lower"] is not None]
    if known:
        yield _figures(known)
    if missing := list(_missing(rows)):
        yield Sentences(tuple(missing))
    yield from _bandwidths(tables.rows("bandwidths"))


def _figures(known: Sequence[Record]) -> Table:
    return Table(
        _("Figures of each axis, named as in IEEE Std 528; the definitions are those above."),
        (
            Column(_("Axis"), "name"),
            Column(_("value"), "number"),
            Column("± σ", "sigma"),
            Column(_("by noise alone, 95 %"), "number"),
            Column(_("unit"), "unit"),
            Column(_("largest mean input"), "number"),
            Column(_("points"), "number"),
        ),
        list(_table_rows(known)),
        note=_(
            "By noise alone: what the largest of so many errors does not exceed in 95 % of the "
            "cases if noise, the table and the site are all there is. The input of a whole turn is "
            "its angle over its duration, ramps included. The acceleration-insensitive drift rate "
            "is estimated from the static positions alone; the bias of the result, from all "
            "manoeuvres, is the better value."
        ),
    )


# ---- Bandwidth: of the response to rates, and of the noise, which are not the same.

BY = {
    "encoder": _("ramps, by the encoder of the table: response to rates"),
    "ramps": _("ramps, as the gyro reads them: gyro and drive together"),
    "noise": _("white noise at rest: bandwidth of the noise"),
}


def _bandwidths(rows: Sequence[Record]) -> Iterator[Part]:
    """One table of both sensors, and why there is no bandwidth of some axes."""
    known = [row for row in rows if row["lower"] is not None or row["value"] is not None]
    if known:
        estimated = any(row["value"] is not None for row in known)
        yield Table(
            _("Bandwidth (−3 dB) of each axis."),
            (
                Column(_("Axis"), "name"),
                *(value_and_sigma() if estimated else ()),
                Column(_("at least, 95 %"), "number"),
                Column(_("unit"), "unit"),
                Column(_("turns"), "number"),
            ),
            list(_bandwidth_rows(known, estimated=estimated)),
            note=_(
                "As of a first-order low pass; one of second order with the damping 1/√2 delays "
                "all ramps alike, which ramps do not tell from dead time. Without an encoder a "
                "drive that rounds the corners of its ramps makes the bandwidth smaller, so only "
                "the limit is one of the gyro. The noise shows the filters that it passes, and "
                "not what is before its source."
            ),
        )
    missing = [
        _(
            "{axis} {sensor}, bandwidth: not determined, for {reason}.",
            axis=axes,
            sensor=SINGULAR[row["sensor"]],
            reason=row["reason"],
        )
        for axes, row in _by_reason(rows)
    ]
    if missing:
        yield Sentences(tuple(missing))


def _bandwidth_rows(rows: Sequence[Record], *, estimated: bool) -> Iterator[Row]:
    for by, name in BY.items():
        for sensor in ("accel", "gyro"):
            own = [r for r in rows if (r["by"], r["sensor"]) == (by, sensor)]
            if own:
                yield head(f"{SINGULAR[sensor]}: {name}")
            for row in own:
                value: tuple[str, ...] = ("", "") if estimated else ()
                if row["value"] is not None:
                    value = numbers.with_own_sigma(row["value"], row["sigma"])
                mount = f" ({row['mount']})" if row["mount"] else ""
                yield table_row(
                    row["axis"] + mount,
                    *value,
                    numbers.significant(row["lower"], 2) if row["lower"] else "",
                    "Hz",
                    numbers.whole(row["turns"]) if row["turns"] else "",
                    anchor=row["id"],
                )


def _by_reason(rows: Sequence[Record]) -> Iterator[tuple[str, Record]]:
    """The axes for which a quantity of a sensor is missing for the same reason, and one of them."""
    alike = grouped(
        (row for row in rows if row["reason"]),
        lambda row: (row["sensor"], row.get("quantity") or row["by"], row["reason"]),
    )
    for own in alike.values():
        yield ", ".join(dict.fromkeys(row["axis"] for row in own)), own[0]


SECTION = Section(
    "characteristics",
    _("Sensor characteristics"),
    _(
        "How far the output of each axis departs from its input and from a straight line, over the "
        "inputs that were applied and not over the range of the data sheet; bias, cross terms and "
        "the effects of the result are taken out, but for those that depend on the axis's own "
        "input."
    ),
    _(
        "Composite error: largest difference of the compensated output, by the whole result, from "
        "the input. Linearity error: largest deviation of the output from a least-squares line in "
        "the input; one within the figure for noise alone is an upper limit. Asymmetry: "
        "difference of the scale factors for positive and for negative input. Threshold and "
        "resolution: the least input, and the least change of it, that give at least half of the "
        "expected output; the plan and the counts set limits to them, with 95 % confidence: the "
        "sensor may feel less than the plan applied. Acceleration-insensitive drift rate: what a "
        "gyro reads independent of specific force."
    ),
    ("characteristics", "bandwidths"),
    parts,
)


def _table_rows(rows: Sequence[Record]) -> Iterator[Row]:
    for quantity, name in NAMES.items():
        for sensor in ("accel", "gyro"):
            own = [r for r in rows if (r["quantity"], r["sensor"]) == (quantity, sensor)]
            if not own:
                continue
            yield head(f"{name}: {SINGULAR[sensor]}")
            unit = UNITS[own[0]["unit"]]
            sigmas = [unit.of(row["sigma"]) for row in own if row["sigma"] is not None]
            decimals = numbers.common_decimals(sigmas)
            for row in own:
                yield _table_row(row, unit, decimals)


def _table_row(row: Record, unit: Unit, decimals: int | None) -> Row:
    if row["sigma"] is None:
        value, sigma = between(row, unit), ""
    else:
        value, sigma = numbers.with_sigma(unit.of(row["value"]), unit.of(row["sigma"]), decimals)
    largest = ""
    if row["largest_input"] is not None:
        given = INPUTS[row["input_unit"]]
        largest = f"{numbers.significant(given.of(row['largest_input']), 3)} {given.name}"
    mount = f" ({row['mount']})" if row["mount"] else ""
    return table_row(
        row["axis"] + mount,
        value,
        sigma,
        numbers.significant(unit.of(row["by_noise"]), 2) if row["by_noise"] else "",
        unit.name,
        largest,
        numbers.whole(row["points"]),
        anchor=row["id"],
    )


def between(row: Record, unit: Unit) -> str:
    """The limits of a threshold or a resolution."""
    for digits in (2, 3, 4):  # as many as tell them apart
        lower, upper = (
            None if row[key] is None else numbers.significant(unit.of(row[key]), digits)
            for key in ("lower", "value")
        )
        if lower != upper:
            break
    if lower is None:
        return f"≤ {upper}"
    return f"≥ {lower}" if upper is None else f"{lower} – {upper}"


def _missing(rows: Sequence[Record]) -> Iterator[str]:
    """What is not determined, all that is missing for the same reason in one sentence."""
    alike = grouped(_by_reason(rows), lambda each: (each[0], each[1]["sensor"], each[1]["reason"]))
    for (axes, sensor, reason), own in alike.items():
        names = [NAMES[row["quantity"]].partition(",")[0].lower() for _axes, row in own]
        yield _(
            "{axis} {sensor}, {quantity}: not determined, for {reason}.",
            axis=axes,
            sensor=SINGULAR[sensor],
            quantity=listed(names),
            reason=reason,
        )

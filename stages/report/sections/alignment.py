"""Alignment at rest, and how far the attitude errs afterwards, with rotation and without."""

from collections.abc import Iterator, Sequence
from itertools import groupby

import numpy as np

from inertial.text import numbers, units
from inertial.text.messages import _
from stages.report import drawing
from stages.report.outline import Column, Figure, Paragraph, Part, Row, Section, Table, columns
from stages.report.outline import table_row as line_of
from stages.report.tables import Record, Tables, arrays

MOST_FIGURES = 4
MARGINS = drawing.Margins(left=0.5, across=0.5)
ARC_MINUTE = units.Unit("arcmin", units.DEGREE / 60)
METHODS = {"static": _("means at rest"), "rotation": _("the turn that follows")}
UNITS = {"rad": units.DEGREES, "rad/s": units.DEGREES_PER_HOUR}


def parts(tables: Tables) -> Iterator[Part]:
    """Nothing where the campaign has no alignment."""
    rows = tables.rows("alignments")
    if not rows:
        return
    yield Table(
        _("Alignment by the means at rest and, where a turn follows, by that turn."),
        (
            *columns("text", _("Alignment"), _("By"), _("Readings"), _("Quantity")),
            Column(_("value"), "number"),
            Column("± σ", "sigma"),
            Column(_("known"), "number"),
            Column(_("unit"), "unit"),
        ),
        [_row(row) for row in rows],
        note=_(
            "Tilt: at rest of the case, with the biases of the accelerometers in it; by a turn of "
            "the axis it is about. The level rate is the horizontal part of the earth's rate."
        ),
    )
    if wrong := [row for row in rows if row["method"] == "static" and row["per_bias"]]:
        per_hour = wrong[0]["per_bias"] * units.DEGREE_PER_HOUR / units.DEGREE
        yield Paragraph(
            _(
                "At rest a bias of the gyros to the east of 1 °/h turns the azimuth by {turned}°, "
                "and nothing there tells the two apart. A turn does: the bias turns with the case, "
                "the earth's rate does not.",
                turned=numbers.significant(per_hour, 2),
            )
        )
    curves = tables.rows("attitude_errors")
    kinds = [(key, list(own)) for key, own in groupby(curves, key=_case)]
    for number, (key, own) in enumerate(kinds[:MOST_FIGURES]):
        yield _figure(number, key, own)
    yield from (Paragraph(_gain(row)) for row in tables.rows("modulation_gains"))


SECTION = Section(
    "alignment",
    _("Alignment and rotation modulation"),
    _(
        "The attitude found at rest, and the integral of the rate that remains after it: over a "
        "turn about the vertical and at rest."
    ),
    _(
        "What is fixed in the case, the bias and the cross terms of the rate, goes round with "
        "it, so its integral in the level frame is bounded; at rest it grows with time. Along the "
        "vertical nothing is modulated, and the scale factor's error times the angle remains."
    ),
    ("alignments", "attitude_errors", "modulation_gains"),
    parts,
)


def _row(row: Record) -> Row:
    unit = UNITS[row["unit"]]
    if row["quantity"].startswith("tilt"):
        unit = units.SECONDS_OF_ARC
    value, sigma = unit.of(row["value"]), unit.of(row["sigma"])
    decimals = numbers.decimals_of(sigma)
    quantity = str(row["quantity"]).replace("_", " ")
    if row["direction"]:
        quantity = _("azimuth of {direction}", direction=row["direction"])
    known = "" if row["known"] is None else numbers.fixed(unit.of(row["known"]), decimals or 0)
    return line_of(
        numbers.shortened(row["alignment"], 60),
        METHODS[row["method"]],
        row["readings"],
        quantity,
        *numbers.with_sigma(value, sigma, decimals),
        known,
        unit.name,
    )


def _case(row: Record) -> tuple[str, str, str]:
    return row["mount"], row["alignment"], row["readings"]


def _figure(number: int, key: tuple[str, str, str], rows: Sequence[Record]) -> Figure:
    """The level error against time with its prediction, and the error about the vertical."""
    with drawing.style():
        figure, [axes] = drawing.panels(1, 2, 1.6, MARGINS)
        runs = {name: list(own) for name, own in groupby(rows, key=lambda row: row["manoeuvre"])}
        for name, own in runs.items():
            colour = drawing.AXIS_COLOUR["z" if own[0]["modulated"] else "x"]
            seconds, sigma = arrays(own, "seconds", "sigma")
            for panel, level in zip(axes, (True, False), strict=True):
                measured, predicted = (_size(own, prefix, level) for prefix in ("", "predicted_"))
                reach = sigma / ARC_MINUTE.size
                drawing.band(panel, seconds, measured - reach, measured + reach, colour, alpha=0.2)
                panel.plot(seconds, measured, color=colour, label=numbers.shortened(name, 24))
                panel.plot(seconds, predicted, color=drawing.INK, linewidth=0.6, linestyle="--")
        for panel, title in zip(axes, (_("levels"), _("about the vertical")), strict=True):
            panel.set_title(f"{title}, {ARC_MINUTE.name}", pad=3)
            panel.set_xlabel(_("Time, s"))
        axes[0].legend(loc="upper left")
        drawn = drawing.svg(figure, f"alignment-{number}")
    _mount, alignment, readings = key
    return Figure(
        _(
            "Attitude error after {alignment}, readings {readings}: the integral of the rate that "
            "remains ± σ of white noise; dashed: as predicted from what is fixed in the case.",
            alignment=numbers.shortened(alignment, 60),
            readings=readings,
        ),
        drawn,
        _("Attitude error against time with rotation and without."),
    )


def _size(rows: Sequence[Record], prefix: str, level: bool) -> drawing.Array:
    """The error of the levels, or that about the vertical, arc minutes."""
    if not level:
        return arrays(rows, f"{prefix}up")[0] / ARC_MINUTE.size
    east, north = arrays(rows, f"{prefix}east", f"{prefix}north")
    return np.asarray(np.hypot(east, north) / ARC_MINUTE.size)


def _gain(row: Record) -> str:
    factor, sigma = numbers.with_own_sigma(row["factor"], row["factor_sigma"])
    still, modulated = (
        numbers.significant(ARC_MINUTE.of(row[key]), 3)
        for key in ("still_error", "modulated_error")
    )
    return _(
        "Readings {readings}: within {seconds} s the levels err by up to {still} arcmin at rest "
        "and by {modulated} arcmin under rotation, {factor} ± {sigma} times less; what is fixed in "
        "the case explains {predicted} times.",
        readings=row["readings"],
        seconds=numbers.fixed(row["seconds"], 0),
        still=still,
        modulated=modulated,
        factor=factor,
        sigma=sigma,
        predicted=numbers.significant(row["predicted_factor"], 3),
    )

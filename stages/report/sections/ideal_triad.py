"""Annex: what ideal sensors would read at the site of the campaign."""

from collections.abc import Iterator

from inertial.text import numbers, units
from inertial.text.messages import _
from stages.report.outline import Column, Paragraph, Part, Row, Section, Table, columns, head
from stages.report.outline import table_row as row
from stages.report.tables import Record, Tables

FRAMES = {
    "NED": _("North, east, down (NED; body axes forward, right, down)"),
    "ENU": _("East, north, up (ENU; body axes right, forward, up)"),
}
SITUATIONS = {
    "at_rest": _("at rest on the level"),
    "in_free_fall": _("in free fall"),
    "at_equator": _("at rest at the equator"),
    "at_pole": _("at rest at the pole of this hemisphere"),
    "under_way_north": _("{speed:g} m/s to the north at {height:g} m"),
    "under_way_east": _("{speed:g} m/s to the east at {height:g} m"),
}


def parts(tables: Tables) -> Iterator[Part]:
    """One table in both frames, and how gravity of the site compares."""
    readings = tables.rows("ideal_readings")
    if not readings:
        return
    site = readings[0]
    yield Table(
        _(
            "Ideal readings at latitude {latitude}° and height {height} m; the equator and the "
            "pole at the same height.",
            latitude=numbers.fixed(units.DEGREES.of(site["latitude"]), 4),
            height=numbers.fixed(site["height"], 0),
        ),
        (
            Column(_("Situation")),
            *columns("number", "1", "2", "3", group=_("Gyros, °/h")),
            *columns("number", "1", "2", "3", group=_("Accelerometers, m/s²")),
        ),
        list(_rows(readings)),
        note=_(
            "Under way: at a steady speed, the triad on the level and to the north. In free fall "
            "accelerometers read zero however fast the fall becomes."
        ),
    )
    for gravity in tables.rows("known"):
        if gravity["quantity"] != "gravity":
            continue
        value, sigma = numbers.with_own_sigma(gravity["value"], gravity["sigma"])
        yield Paragraph(
            _(
                "Normal gravity of the site is {normal} m/s²; the calibration takes gravity as "
                "{value} ± {sigma} m/s² ({origin}).",
                normal=numbers.fixed(-site["down"], 6),
                value=value,
                sigma=sigma,
                origin=numbers.shortened(gravity["origin"], 300),
            )
        )


SECTION = Section(
    "ideal",
    _("Ideal readings at the site"),
    _("What sensors without errors would read, by the earth's rate, gravity and the speed alone."),
    _(
        "1, 2, 3: the axes in the order of the frame. Gyros read the rate against inertial space, "
        "accelerometers specific force, acceleration less gravity: at rest the axis that points up "
        "reads +g, the one that points down −g."
    ),
    ("ideal_readings", "known"),
    parts,
)


def _rows(readings: list[Record]) -> Iterator[Row]:
    """A row per situation, for the accelerometers and the gyros of one stand one after another."""
    for frame, name in FRAMES.items():
        yield head(name)
        for accel, gyro in zip(readings[::2], readings[1::2], strict=True):
            rates = (each / units.DEGREE_PER_HOUR for each in _in_frame(gyro, frame))
            yield row(
                SITUATIONS[gyro["situation"]].format(**gyro),
                *(numbers.fixed(each, 4) for each in rates),
                *(numbers.fixed(each, 6) for each in _in_frame(accel, frame)),
            )


def _in_frame(reading: Record, frame: str) -> tuple[float, float, float]:
    north, east, down = (reading[name] for name in ("north", "east", "down"))
    return (north, east, down) if frame == "NED" else (east, north, -down)

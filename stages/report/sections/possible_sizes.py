"""How large an effect can be at most: what exceeds that is not undetected, but not observable."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf, pi

from inertial.text.messages import _
from inertial.text.units import PER_CENT, STANDARD_GRAVITY
from stages.report.results import quantity_of
from stages.report.tables import Record, Tables

LARGEST_ANGLE, LARGEST_SHARE = pi, 1.0  # rad; no error is larger
# Of gravity, or of the range of a gyro: no sensor that is worth a calibration reads that wrong.
LARGEST_ERROR = 0.5
POWERS = {  # by unit of an effect, of gravity in the reading of an axis that points up
    "m/s²": 0,
    "(m/s²)/(m/s²)²": 2,
    "(m/s²)/(m/s²)³": 3,
    "rad/s": 0,
    "(rad/s)/(m/s²)": 1,
    "(rad/s)/(m/s²)²": 2,
}
FULL_SCALE = "full_scale"  # of the gyros, rad/s, beside the columns of a detection limit
TOO_LARGE = _(
    "It would be seen here only if it changed a reading by more than half of gravity, or of the "
    "sensor's range"
)


def limits_of(tables: Tables) -> Iterator[Record]:
    """The detection limits, each with the range of the gyros where the campaign states one."""
    stated = [row[FULL_SCALE] for row in tables.rows("sensors") if row["sensor"] == "gyro"]
    full_scale = min(filter(None, stated), default=None)
    return (row | {FULL_SCALE: full_scale} for row in tables.rows("detection_limits"))


def largest(row: Record) -> float:
    """The largest size that is possible of an effect, in the unit of the row."""
    if quantity_of(row).shown == PER_CENT:
        return LARGEST_SHARE
    unit = row["unit"]
    if unit == "rad":
        return LARGEST_ANGLE
    if unit not in POWERS:
        return inf
    most = STANDARD_GRAVITY if unit.startswith(("m/s²", "(m/s²)")) else row.get(FULL_SCALE) or inf
    return float(LARGEST_ERROR * most / STANDARD_GRAVITY ** POWERS[unit])


def possible(row: Record) -> bool:
    """Whether an effect of the size of a limit can be: at the place where it shows best at least.

    A share or an angle that cannot be is said in the row of its effect.
    """
    if row["unit"] not in POWERS:
        return True
    return bool(min(filter(None, (row["limit"], row["smallest"]))) <= largest(row))


def observable(rows: Sequence[Record], visible: str) -> bool:
    """Whether an effect can be seen, by its detection limits; one without any is sought elsewhere.

    visible : the reason of a limit that the data have
    """
    seen = [row for row in rows if row["reason"] == visible and row["limit"] is not None]
    return not seen or any(map(possible, seen))

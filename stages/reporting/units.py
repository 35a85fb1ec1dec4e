"""The units of the laboratory beside those of the SI."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

STANDARD_GRAVITY = 9.80665  # m/s², by definition: what a g in µg is
DEGREE = pi / 180
ARC_SECOND = DEGREE / 3600
DEGREE_PER_HOUR = DEGREE / 3600
DEGREE_PER_SQRT_HOUR = DEGREE / 60  # rad/√s
METRE_PER_SECOND_PER_SQRT_HOUR = 1 / 60  # m/s/√s


@dataclass(frozen=True)
class Unit:
    """A unit and its size in the SI unit of the quantity."""

    name: str
    size: float

    def of(self, value: float | None) -> float | None:
        """`value` from the SI into this unit."""
        return None if value is None else value / self.size


@dataclass(frozen=True)
class Quantity:
    """How one kind of parameter is written: in the laboratory's unit and in the SI's."""

    laboratory: Unit
    si: Unit


MICRO_G = Unit("µg", STANDARD_GRAVITY * 1e-6)
PPM = Unit("ppm", 1e-6)
SECONDS_OF_ARC = Unit("arcsec", ARC_SECOND)
DEGREES = Unit("°", DEGREE)
DEGREES_PER_SECOND = Unit("°/s", DEGREE)
DEGREES_PER_HOUR = Unit("°/h", DEGREE_PER_HOUR)
RANDOM_WALK = {
    "gyro": Unit("°/√h", DEGREE_PER_SQRT_HOUR),
    "accel": Unit("m/s/√h", METRE_PER_SECOND_PER_SQRT_HOUR),
}

_ANGLE = Quantity(SECONDS_OF_ARC, Unit("µrad", 1e-6))
_BY_UNIT = {
    "m/s²": Quantity(MICRO_G, Unit("10⁻³ m/s²", 1e-3)),
    "rad/s": Quantity(DEGREES_PER_HOUR, Unit("10⁻⁶ rad/s", 1e-6)),
    "rad": _ANGLE,
}
_RATIO = Quantity(PPM, Unit("10⁻⁶", 1e-6))
_DIMENSIONLESS = {
    "scale": _RATIO,
    "cross": _ANGLE,
    "symmetric": _ANGLE,
    "mounting": _ANGLE,
}


def quantity(parameter: str, unit: str) -> Quantity:
    """How `parameter`, which is tabled in `unit`, is written.

    A cross-axis term is a small angle, whether its unit is stated as 1 or as rad;
    a term on the diagonal is a ratio. A unit that is not known here stays as it is.
    """
    kind, _, axes = parameter.partition("_")
    if axes in ("xx", "yy", "zz") and unit in ("1", ""):
        return _RATIO
    if kind in _DIMENSIONLESS and unit in ("1", "rad", ""):
        return _DIMENSIONLESS[kind]
    return _BY_UNIT.get(unit) or Quantity(Unit(unit, 1.0), Unit(unit, 1.0))

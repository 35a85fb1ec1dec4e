"""The units of the laboratory and of the campaign file, beside those of the SI."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from math import pi

STANDARD_GRAVITY = 9.80665  # m/s², by definition: what a g in µg is
COVERAGE_FACTOR = 2.0  # k of an expanded uncertainty U = k σ, about 95 %
DEGREE = pi / 180
HOUR = 3600.0  # s
ICE_POINT = 273.15  # K, 0 °C
ARC_SECOND = DEGREE / 3600
DEGREE_PER_HOUR = DEGREE / HOUR
DEGREE_PER_SQRT_HOUR = DEGREE / 60  # rad/√s
METRE_PER_SECOND_PER_SQRT_HOUR = 1 / 60  # m/s/√s
PER_ROOT_HOUR = 1 / 60  # a random walk per √h, per √s
CHANNEL_UNITS = {"m/s2": 1.0, "g": STANDARD_GRAVITY, "rad/s": 1.0, "deg/s": DEGREE}  # of a reading
INCREMENT_UNITS = {"m/s": 1.0, "rad": 1.0, "deg": DEGREE}  # of what a sample adds to the one before


_SYSTEM = ContextVar("_SYSTEM", default="laboratory")


@contextmanager
def written_in(system: str) -> Iterator[None]:
    """What is written meanwhile uses the units of the `laboratory` or of the `SI`."""
    token = _SYSTEM.set(system)
    try:
        yield
    finally:
        _SYSTEM.reset(token)


@dataclass(frozen=True)
class Unit:
    """A unit and its size in the SI unit of the quantity; `zero`: its zero, in SI."""

    name: str
    size: float
    zero: float = 0.0

    def of(self, value: float | None) -> float | None:
        """`value` from the SI into this unit."""
        return None if value is None else (value - self.zero) / self.size


@dataclass(frozen=True)
class Quantity:
    """How one kind of parameter is written: in the laboratory's unit and in the SI's."""

    laboratory: Unit
    si: Unit

    @property
    def shown(self) -> Unit:
        """The one that what is being written uses."""
        return self.si if _SYSTEM.get() == "SI" else self.laboratory


MICRO_G = Unit("µg", STANDARD_GRAVITY * 1e-6)
MILLI_G = Unit("mg", STANDARD_GRAVITY * 1e-3)
PPM = Unit("ppm", 1e-6)
PER_CENT = Unit("%", 0.01)
SECONDS_OF_ARC = Unit("arcsec", ARC_SECOND)
DEGREES = Unit("°", DEGREE)
DEGREES_PER_SECOND = Unit("°/s", DEGREE)
METRES = Unit("m/s²", 1.0)
MILLIMETRES = Unit("mm/s²", 1e-3)
DEGREES_PER_HOUR = Unit("°/h", DEGREE_PER_HOUR)
RANDOM_WALK = {
    "gyro": Unit("°/√h", DEGREE_PER_SQRT_HOUR),
    "accel": Unit("m/s/√h", METRE_PER_SECOND_PER_SQRT_HOUR),
}

_RATIO = Quantity(PPM, Unit("10⁻⁶", 1e-6))
_SHARE = Quantity(PER_CENT, PER_CENT)  # of a whole, 0 to 1
_ANGLE = Quantity(SECONDS_OF_ARC, Unit("µrad", 1e-6))
_TEMPERATURES = ("T0", "T_min", "T_max")  # constants of effects, which have no sigma
_CELSIUS = Quantity(Unit("°C", 1.0, ICE_POINT), Unit("°C", 1.0, ICE_POINT))
_NUMBER = Quantity(Unit("", 1.0), Unit("", 1.0))
_NUMBERS = ("shape", "degree", "probability")  # of laws and functions of temperature: no ratios
_BY_UNIT = {
    "m/s²": Quantity(MICRO_G, Unit("10⁻³ m/s²", 1e-3)),
    "rad/s": Quantity(DEGREES_PER_HOUR, Unit("10⁻⁶ rad/s", 1e-6)),
    "rad": _ANGLE,
    "(rad/s)/(m/s²)": Quantity(
        Unit("°/h/g", DEGREE_PER_HOUR / STANDARD_GRAVITY), Unit("10⁻⁶ (rad/s)/(m/s²)", 1e-6)
    ),
    "rad/s²": Quantity(Unit("°/h/h", DEGREE_PER_HOUR / HOUR), Unit("10⁻⁹ rad/s²", 1e-9)),
    "(m/s²)/(m/s²)²": Quantity(
        Unit("µg/g²", 1e-6 / STANDARD_GRAVITY), Unit("10⁻⁶ (m/s²)/(m/s²)²", 1e-6)
    ),
    "m/s³": Quantity(Unit("µg/h", STANDARD_GRAVITY * 1e-6 / HOUR), Unit("10⁻⁹ m/s³", 1e-9)),
    "m": Quantity(Unit("mm", 1e-3), Unit("m", 1.0)),
    "m/s": Quantity(Unit("mm/s", 1e-3), Unit("m/s", 1.0)),
    "rad/√s": Quantity(RANDOM_WALK["gyro"], Unit("10⁻⁶ rad/√s", 1e-6)),
    "m/s/√s": Quantity(RANDOM_WALK["accel"], Unit("10⁻³ m/s/√s", 1e-3)),
    "1": _RATIO,
    "(rad/s)/(m/s²)²": Quantity(
        Unit("°/h/g²", DEGREE_PER_HOUR / STANDARD_GRAVITY**2),
        Unit("10⁻⁶ (rad/s)/(m/s²)²", 1e-6),
    ),
    "(rad/s)/(rad/s)²": Quantity(
        Unit("°/h/(°/s)²", DEGREE_PER_HOUR / DEGREE**2), Unit("10⁻⁶ (rad/s)/(rad/s)²", 1e-6)
    ),
    "1/(rad/s)": Quantity(Unit("ppm/(°/s)", 1e-6 / DEGREE), Unit("1/(rad/s)", 1.0)),
    "1/(rad/s)²": Quantity(Unit("ppm/(°/s)²", 1e-6 / DEGREE**2), Unit("1/(rad/s)²", 1.0)),
    "1/(m/s²)": Quantity(Unit("ppm/g", 1e-6 / STANDARD_GRAVITY), Unit("10⁻⁶ 1/(m/s²)", 1e-6)),
    "1/s": Quantity(Unit("ppm/h", 1e-6 / HOUR), Unit("10⁻⁹ 1/s", 1e-9)),
    "1/K": Quantity(Unit("ppm/K", 1e-6), Unit("10⁻⁶ 1/K", 1e-6)),
    "1/K²": Quantity(Unit("ppm/K²", 1e-6), Unit("10⁻⁶ 1/K²", 1e-6)),
    "1/K³": Quantity(Unit("ppm/K³", 1e-6), Unit("10⁻⁶ 1/K³", 1e-6)),
    "rad/s/K": Quantity(Unit("°/h/K", DEGREE_PER_HOUR), Unit("10⁻⁶ rad/s/K", 1e-6)),
    "m/s²/K": Quantity(Unit("µg/K", 1e-6 * STANDARD_GRAVITY), Unit("10⁻⁶ m/s²/K", 1e-6)),
    "rad/s/K²": Quantity(Unit("°/h/K²", DEGREE_PER_HOUR), Unit("10⁻⁹ rad/s/K²", 1e-9)),
    "rad/s/K³": Quantity(Unit("°/h/K³", DEGREE_PER_HOUR), Unit("10⁻⁹ rad/s/K³", 1e-9)),
    "m/s²/K²": Quantity(Unit("µg/K²", 1e-6 * STANDARD_GRAVITY), Unit("10⁻⁶ m/s²/K²", 1e-6)),
    "m/s²/K³": Quantity(Unit("µg/K³", 1e-6 * STANDARD_GRAVITY), Unit("10⁻⁶ m/s²/K³", 1e-6)),
    "(m/s²)/(m/s²)³": Quantity(
        Unit("µg/g³", 1e-6 / STANDARD_GRAVITY**2), Unit("10⁻⁶ (m/s²)/(m/s²)³", 1e-6)
    ),
    "s": Quantity(Unit("s", 1.0), Unit("s", 1.0)),
    "rad/s/√s": Quantity(
        Unit("°/h/√h", DEGREE_PER_HOUR / 60), Unit("10⁻⁶ rad/s/√s", 1e-6)
    ),  # K per √s is 60 K per √h
    "m/s²/√s": Quantity(Unit("µg/√h", STANDARD_GRAVITY * 1e-6 / 60), Unit("10⁻⁶ m/s²/√s", 1e-6)),
    "s²/rad²": Quantity(Unit("ppm/(°/s)²", 1e-6 / DEGREE**2), Unit("s²/rad²", 1.0)),
}
_OF_OSCILLATION = Quantity(DEGREES_PER_SECOND, Unit("rad/s", 1.0))
_DIMENSIONLESS = {
    "asymmetry": _RATIO,
    "scale": _RATIO,
    "cross": _ANGLE,
    "symmetric": _ANGLE,
    "mounting": _ANGLE,
    **{"s": _SHARE, "l": _SHARE},  # of the earth's rate that is missing; that a dead band loses
}


def in_si(value: float | None, unit: float) -> float | None:
    """A value in a unit; none where it is not stated."""
    return None if value is None else value * unit


def in_degrees(value: float, unit: str) -> tuple[float, str]:
    """A rate or an angle in degrees, as people think of a turn; any other unit as it is."""
    return (value / DEGREE, unit.replace("rad", "°")) if unit in ("rad", "rad/s") else (value, unit)


def quantity(parameter: str, unit: str) -> Quantity:
    """How `parameter`, which is tabled in `unit`, is written.

    A cross-axis term is a small angle, whether its unit is stated as 1 or as rad;
    a term on the diagonal is a ratio. A unit that is not known here stays as it is.
    """
    if parameter == "amplitude":
        return _OF_OSCILLATION
    kind, _, axes = parameter.partition("_")
    if axes in ("xx", "yy", "zz") and unit in ("1", ""):
        return _RATIO
    if unit == "K" and (parameter in _TEMPERATURES or kind == "knot"):
        return _CELSIUS
    if kind in _NUMBERS and unit == "1":
        return _NUMBER
    if kind in _DIMENSIONLESS and unit in ("1", "rad", ""):
        return _DIMENSIONLESS[kind]
    return _BY_UNIT.get(unit) or Quantity(Unit(unit, 1.0), Unit(unit, 1.0))

"""Bias, scale factors and cross terms of three sensors as functions of temperature.

    reading_i += Σ_j P_ij(T) u_j + p_i(T),    u: specific force or angular rate

Each function is a polynomial in T − T0 up to the third degree or, where a polynomial fails, a
straight line whose slope changes at a knot. All vanish at T0, where the twelve parameters hold.
Which of them a campaign determines is selected from its data: `inertial.estimation.temperature`.
"""

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from typing import Self

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import delay, temperature_constants, warmer, without_temperature
from inertial.physics.effect import Constant, Effect, Parameter, Reading, Term, Truth
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.parameters import PARTS
from inertial.text.units import DEGREE, STANDARD_GRAVITY

MAX_ORDER = 3
# "Powers" of the change of slope at a knot, and of that times a shift of the knot: the derivative
# by its temperature. A mean over knots has two more, to either side of it.
BEND, SHIFT, BELOW, ABOVE = 0, -1, -2, -3
NAMES = {BEND: "bend", SHIFT: "shift", BELOW: "bend_below", ABOVE: "bend_above"}
BENDS = (BELOW, BEND, ABOVE)
SIDES = {BELOW: "_below", BEND: "", ABOVE: "_above"}  # of the three knots of a function
FUNCTIONS = tuple(name for name, parts in PARTS.items() if parts.kind in ("bias", "scale", "cross"))
# Per K, K², K³ and per K beyond a knot, in units of the first.
TYPICAL_SHARES = {1: 1.0, 2: 0.1, 3: 3e-3, BEND: 1.0, SHIFT: 1.0, BELOW: 1.0, ABOVE: 1.0}
TYPICAL = {
    ("accel", "bias"): ("m/s²", 1e-4 * STANDARD_GRAVITY),
    ("gyro", "bias"): ("rad/s", 5e-3 * DEGREE),
}
RELATIVE = ("1", 1e-4)  # of scale factors and cross terms
IN_WORDS = {
    "bias": _("bias {axes}"),
    "scale": _("scale error {axes}"),
    "cross": _("cross-axis term {axes}"),
}
MEANINGS = {
    1: _("change of the {function} per kelvin"),
    2: _("of the {function}, times (T − T0)²"),
    3: _("of the {function}, times (T − T0)³"),
    BEND: _("change of the slope of the {function} at its knot"),
    SHIFT: _("the same times what its knot is uncertain by"),
    BELOW: _("change of the slope of the {function} at the lower of the knots that it may have"),
    ABOVE: _("change of the slope of the {function} at the upper of the knots that it may have"),
}
KNOTS = {
    "": _("knot of the {function}"),
    "_below": _("lower of the knots that the {function} may have"),
    "_above": _("upper of the knots that the {function} may have"),
}
OF_DEGREE = _("degree of the likeliest shape of the {function}; 1: a line with a knot")
LIKELIEST = _("probability of the likeliest shape of the {function}")
LAG = "lag"  # constant: of the sensors behind the thermometer
POWERS = {1: "/K", 2: "/K²", 3: "/K³", BEND: "/K", SHIFT: "", BELOW: "/K", ABOVE: "/K"}


@dataclass(frozen=True, order=True)
class Piece:
    """A power of the temperature in the function of a parameter, or its change of slope, BEND."""

    function: str  # one of FUNCTIONS
    power: int

    @property
    def name(self) -> str:
        """The name of its coefficient."""
        return f"{self.function}_{NAMES.get(self.power, self.power)}"

    @property
    def knot(self) -> str:
        """The key of its knot: the function, or the function and the side."""
        return self.function + SIDES.get(self.power, "")


def _in_words(function: str) -> str:
    """The bias x for bias_x."""
    kind, axes = PARTS[function]
    return IN_WORDS[kind].format(axes=axes)


def polynomials(orders: Mapping[str, int]) -> tuple[Piece, ...]:
    """The pieces of polynomials without constants, of these degrees by function."""
    return tuple(Piece(f, power) for f, order in orders.items() for power in range(1, order + 1))


EVERY = (
    *polynomials(dict.fromkeys(FUNCTIONS, MAX_ORDER)),
    *(Piece(function, power) for power in NAMES for function in FUNCTIONS),
)


class TemperatureModel(Effect):
    """The selected functions of one sensor; those that are not selected are absent.

    `pieces`: of the functions; `knots`: by function, or `Piece.knot`, the temperature, K, at which
    its slope changes; `likeliest`: by function, of one that is a mean over shapes, the degree of
    the likeliest, 1 with a knot, and its probability; `lag`: s, of the sensors behind the
    thermometer, see `drift.delay`; `course`: times, s, and by how much the sensors are warmer than
    the thermometer at each, K, where the motion is not all of the campaign.
    """

    source = (
        "IEEE Std 1293-2018 and 952-2020, model equations, terms of temperature; Friedman 1991,"
        " multivariate adaptive regression splines (knots)"
    )
    sizes = {"fog": 1.0, "tactical": 1.0, "mti": 1.0, "consumer": 1.0}  # noqa: RUF012 (typical sizes)

    def __init__(
        self,
        sensor: str,
        pieces: Iterable[Piece] = EVERY,
        knots: Mapping[str, float] | None = None,
        lag: float = 0.0,
    ) -> None:
        self.sensor, self.lag = sensor, lag
        self.course: tuple[Array, Array] | None = None
        self.likeliest: Mapping[str, tuple[int, float]] = {}
        self.pieces = tuple(pieces)
        self.knots = dict(knots or {})
        self.name = temperature_name(sensor)
        self.cause = CAUSES[sensor] + _behind(lag)
        self.parameters = tuple(map(self._parameter, self.pieces))
        self.terms = tuple(map(self._term, self.pieces))

    def _parameter(self, piece: Piece) -> Parameter:
        unit, size = TYPICAL.get((self.sensor, PARTS[piece.function].kind), RELATIVE)
        meaning = MEANINGS[piece.power].format(function=_in_words(piece.function))
        return Parameter(
            piece.name,
            f"{unit}{POWERS[piece.power]}",
            size * TYPICAL_SHARES[piece.power],
            meaning,
        )

    def _term(self, piece: Piece) -> Term:
        parts = PARTS[piece.function]
        knot = knot_name(piece.knot)
        if piece.power > 0:
            factor = " * ".join(["(T - T0)"] * piece.power)
        else:
            factor = f"(T > {knot})" + f" * (T - {knot})" * (piece.power in BENDS)
        if parts.kind != "bias":
            factor += f" * {'f' if self.sensor == 'accel' else 'w'}_{parts.input_axis}"
        return Term(f"{self.sensor}_{parts.sensor_axis}", piece.name, factor)

    @property
    def key(self) -> tuple[object, ...]:
        """What distinguishes it from others of its campaign."""
        return (*super().key, self.pieces, tuple(sorted(self.knots.items())), self.lag)

    def largest_of(self, parameter: Parameter) -> float:
        """Its own, for the units differ."""
        return self.thinkable * parameter.typical

    def constants(self, motion: Motion) -> Sequence[Constant]:
        knots = [
            Constant(
                knot_name(f + side),
                "K",
                KNOTS[side].format(function=_in_words(f)),
                self.knots[f + side],
            )
            for f in FUNCTIONS
            for side in SIDES.values()
            if f + side in self.knots
        ]
        lag = Constant(
            LAG,
            "s",
            _("time constant with which T follows the recorded temperature; below 0: it precedes"),
            self.lag,
        )
        shapes = [
            constant
            for f, (degree, probability) in self.likeliest.items()
            for words in (_in_words(f),)
            for constant in (
                Constant(degree_name(f), "1", OF_DEGREE.format(function=words), degree),
                Constant(probability_name(f), "1", LIKELIEST.format(function=words), probability),
            )
        ]
        return [
            *temperature_constants(motion, self.reference, self.valid),
            *knots,
            *shapes,
            *([lag] if self.lag else []),
        ]

    def with_constants(self, values: Mapping[str, float]) -> Self:
        effect = super().with_constants(values)
        keys = [f + side for f in FUNCTIONS for side in SIDES.values()]
        effect.knots = {key: values[knot_name(key)] for key in keys if knot_name(key) in values}
        effect.lag = values.get(LAG, 0.0)
        return effect

    def along(self, time: Array, temperature: Array) -> Self:
        effect = copy(self)
        known = np.isfinite(time) & np.isfinite(temperature)
        if self.lag and known.any():
            order = np.argsort(time[known], kind="stable")
            at = time[known][order]
            effect.course = at, delay(at, temperature[known][order], self.lag)
        return effect

    def as_named(self, values: Mapping[str, float]) -> "TemperatureModel":
        """The pieces and knots of which criticism gave numbers."""
        pieces = tuple(piece for piece in self.pieces if piece.name in values)
        knots = {f: values[knot_name(f)] for f in FUNCTIONS if knot_name(f) in values}
        return TemperatureModel(self.sensor, pieces, knots, values.get(LAG, 0.0))

    def blind(self, motion: Motion) -> str:
        return without_temperature(motion)

    def shape(self, piece: Piece, motion: Motion) -> Array:
        """What a coefficient is multiplied with in each stretch, (n,); NaN beyond its range."""
        ahead = self._ahead(motion)
        above = warmer(motion, self.reference, self.valid) + ahead
        if piece.power > 0:
            return np.asarray(above**piece.power)
        beyond = motion.temperature + ahead - self.knots.get(piece.knot, np.nan)
        bent = np.maximum(beyond, 0.0) if piece.power in BENDS else 1.0 * (beyond > 0)
        return np.asarray(bent + 0.0 * above)

    def _ahead(self, motion: Motion) -> Array:
        """By how much the sensors are warmer than the thermometer in each stretch, (n,), K."""
        if self.course is not None:
            return np.interp(motion.time, *self.course)
        return delay(motion.time, motion.temperature, self.lag)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        change = np.zeros_like(getattr(reading, self.sensor))
        felt = truth.force if self.sensor == "accel" else truth.rate
        for piece, value in zip(self.pieces, values, strict=True):
            if not value:
                continue
            parts = PARTS[piece.function]
            moved = value * self.shape(piece, motion)
            if parts.kind != "bias":
                moved = moved * felt[:, "xyz".index(parts.input_axis)]
            change[:, "xyz".index(parts.sensor_axis)] += moved
        return reading.plus(self.sensor, change)


CAUSES = {
    "accel": _(
        "bias, scale factors or cross terms of the accelerometers are functions of the temperature"
    ),
    "gyro": _("bias, scale factors or cross terms of the gyros are functions of the temperature"),
}


def _behind(lag: float) -> str:
    """Which of sensors and thermometer follows the other; nothing where both go together."""
    if not lag:
        return ""
    seconds = significant(abs(lag), 2)
    if lag < 0:
        return _(", which the thermometer follows with a time constant of {s} s", s=seconds)
    return _(", which they follow with a time constant of {s} s", s=seconds)


def temperature_name(sensor: str) -> str:
    """The name of the model of a sensor, gyro or accel."""
    return f"{sensor}_temperature"


def knot_name(knot: str) -> str:
    """The name of the constant that is the temperature of a knot; `knot`: see `Piece.knot`."""
    return f"knot_{knot}"


def degree_name(function: str) -> str:
    """The name of the constant that is the degree of the likeliest shape, 1 with a knot."""
    return f"degree_{function}"


def probability_name(function: str) -> str:
    """The name of the constant that is the probability of the likeliest shape."""
    return f"probability_{function}"

"""The forward model, from the motion of the table to the readings of the IMU, and its inverse.

reading = M · truth + bias, for both triads,   truth: angular rate and specific force

with the earth's rate and gravity in body axes, and the effects one after another.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, sin, tan

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import SettingIn
from inertial.physics.effect import Effect, Reading, Truth
from inertial.physics.motion import Motion, cross, turned_all
from inertial.physics.site import EARTH_RATE, normal_gravity, radii

Values = Mapping[str, Array]  # label of an effect → values of its parameters


@dataclass(frozen=True)
class Site:
    """Gravity, m/s², and the earth's rate, rad/s: its upward and its horizontal component."""

    gravity: float
    earth_up: float
    earth_level: float

    def earth_rate(self, up: Array, north: Array) -> Array:
        """The earth's rate in body axes, (…, 3), rad/s; an unknown north, NaN, leaves it out."""
        return np.asarray(self.earth_up * up + self.earth_level * np.nan_to_num(north))


@dataclass(frozen=True)
class Triad:
    """Three sensors in one case: M (3, 3), and bias (3,)."""

    matrix: Array
    bias: Array


UNKNOWN_TRIAD = Triad(np.full((3, 3), np.nan), np.full(3, np.nan))  # that is not determined


def truth_of(motion: Motion, site: Site) -> Truth:
    """Truth from the motion of the table, gravity and the earth's rate; (n, 3) each."""
    earth = site.earth_rate(motion.up, motion.north)
    return Truth(rate=motion.omega + earth, force=site.gravity * motion.up)


def sensed(truth: Truth, gyro: Triad, accelerometer: Triad) -> Reading:
    """Readings of the two triads for the truth, (n, 3) each."""
    return Reading(
        gyro=truth.rate @ gyro.matrix.T + gyro.bias,
        accel=truth.force @ accelerometer.matrix.T + accelerometer.bias,
    )


def predict(
    motion: Motion,
    site: Site,
    gyro: Triad,
    accelerometer: Triad,
    effects: Sequence[Effect] = (),
    values: Values | None = None,
) -> Reading:
    """Predicted readings of the IMU in this motion with all these effects."""
    truth = truth_of(motion, site)
    for effect in effects:
        truth = effect.moves(truth, motion, (values or {})[effect.label])
    reading = sensed(truth, gyro, accelerometer)
    for effect in effects:
        acting = _acting(effect, truth, gyro, accelerometer)
        reading = effect.reads(reading, acting, motion, (values or {})[effect.label])
    return reading


def _acting(effect: Effect, truth: Truth, gyro: Triad, accelerometer: Triad) -> Truth:
    """The truth by which an effect reads: along the axes of its own sensors, where it says so."""
    if effect.own_axis == "gyro":
        return replace(truth, rate=_along_own_axes(truth.rate, gyro))
    if effect.own_axis == "accel":
        return replace(truth, force=_along_own_axes(truth.force, accelerometer))
    return truth


def _along_own_axes(truth: Array, triad: Triad) -> Array:
    """M · truth, (n, 3); of an M that is not determined the unit matrix."""
    return truth @ np.where(np.isnan(triad.matrix), np.eye(3), triad.matrix).T


def signatures(
    motion: Motion, site: Site, gyro: Triad, accelerometer: Triad, effects: Iterable[Effect]
) -> Iterator[Reading]:
    """Change of the readings per unit of each parameter of effects that are absent.

    The derivative is central, about zero. It is zero where an effect is not observable, or its
    input is not known.

    Returns
    -------
    for each effect gyro and accel, (n, 3, number of parameters) each
    """
    truth = truth_of(motion, site)
    plain = sensed(truth, gyro, accelerometer)

    def reading(effect: Effect, values: Array) -> Reading:
        moved = effect.moves(truth, motion, values)
        before = plain if moved is truth else sensed(moved, gyro, accelerometer)
        return effect.reads(before, _acting(effect, moved, gyro, accelerometer), motion, values)

    whole: dict[tuple[object, ...], Reading] = {}  # of what sets in, as if before all

    def signature(effect: Effect) -> Reading:
        if (known := effect.signature(motion)) is not None:
            return known
        if (added := effect.added(truth, motion)) is not None:
            return Reading(*np.nan_to_num([added.gyro, added.accel]))
        if not (isinstance(effect, SettingIn) and effect.by_share):
            return derivative(effect)
        ever = effect.fixed(-np.inf)
        if ever.key not in whole:
            whole[ever.key] = derivative(ever)
        share = np.nan_to_num(effect.since(motion))[:, None, None]
        return Reading(share * whole[ever.key].gyro, share * whole[ever.key].accel)

    def derivative(effect: Effect) -> Reading:
        derivatives = np.zeros((2, len(motion.rate), 3, len(effect.parameters)))
        for i, parameter in enumerate(effect.parameters if not effect.blind(motion) else ()):
            step = np.zeros(len(effect.parameters))
            step[i] = parameter.typical
            plus, minus = reading(effect, step), reading(effect, -step)
            derivatives[0, :, :, i] = (plus.gyro - minus.gyro) / (2 * parameter.typical)
            derivatives[1, :, :, i] = (plus.accel - minus.accel) / (2 * parameter.typical)
        return Reading(*np.nan_to_num(derivatives, posinf=0.0, neginf=0.0))

    return map(signature, effects)


# ---- The inverse of the forward model: specific force and angular rate from readings
#
#     truth = M⁻¹ (reading − bias − effects(truth))                (S0, compensation; effects added)
#
# Effects are small, so the equation is solved by inserting its result into it again.

Sized = tuple[Effect, Array]  # an effect with the values of its parameters

MAX_ROUNDS = 20  # in which effects of one part in two are taken out to one in a million
MAX_RELATIVE_CHANGE = 1e-12  # of the truth in the last round


def force_of(
    reading: Array, accelerometer: Triad | None, effects: Sequence[Sized], motion: Motion
) -> Array:
    """Specific force from the readings of accelerometers, (n, 3); NaN where it is not known."""

    def felt(force: Array) -> Truth:
        return Truth(np.zeros_like(force), force)

    return _truth(reading, accelerometer, "accel", felt, effects, motion)


def rate_of(
    reading: Array, gyro: Triad | None, effects: Sequence[Sized], motion: Motion, force: Array
) -> Array:
    """Angular rate from the readings of gyros and the specific force that they feel, (n, 3)."""
    return _truth(reading, gyro, "gyro", lambda rate: Truth(rate, force), effects, motion)


def _truth(
    reading: Array,
    triad: Triad | None,
    sensor: str,
    felt: Callable[[Array], Truth],
    effects: Sequence[Sized],
    motion: Motion,
) -> Array:
    """The truth of three sensors, of which one that is not recorded leaves none."""
    if triad is None:
        return np.full(reading.shape, np.nan)
    inverse = np.linalg.inv(triad.matrix).T
    plain = reading - triad.bias
    truth = np.asarray(plain @ inverse)
    if not effects:
        return truth
    nothing = np.zeros_like(reading)

    def added(truth: Array) -> Array:
        read = Reading(nothing, nothing)
        return sum(
            (
                getattr(e.reads(read, _acting(e, felt(truth), triad, triad), motion, v), sensor)
                for e, v in effects
            ),
            nothing,
        )

    for _unused in range(MAX_ROUNDS):
        before, truth = truth, np.asarray((plain - added(truth)) @ inverse)
        change = np.linalg.norm(truth - before, axis=1)
        unsettled = change > MAX_RELATIVE_CHANGE * np.linalg.norm(truth, axis=1)
        if not unsettled.any():
            break
    truth[unsettled] = np.nan  # an effect as large as the reading
    return truth


# ---- The angle of the table by the gyros.


def measured_angles(
    sums: Array,
    seconds: Array,
    about: Array,
    earth: Array,
    gyro: Triad,
    at_middle: Callable[[Array], Array],
    weight: Array | None = None,
) -> Array:
    """The angle of the table in each stretch as measured by the gyros, (k,), rad.

    The earth's rate is subtracted in the direction that follows from the angle so far. Whoever
    weights as the equations of a turn do has the same angles: else an effect that every calibration
    takes up, such as gyros that are mounted askew, would differ from the parameters that take it up
    by the noise of the angles.

    Parameters
    ----------
    sums : (k, 3), rad, NaN where a channel is not recorded
    about, earth : (3,), axis of the turn, and the earth's rate as it begins, rad/s, body axes
    at_middle : converts the angles of the stretches to that of the table at the middle of each
    weight : (3,), 1 over the white noise of each channel, NaN where it is unknown; none: equal
    """
    weight = np.ones(3) if weight is None else weight
    known = np.isfinite(weight) & np.isfinite(sums).all(axis=0)
    weight = np.where(known, weight, 0.0)
    along = weight * (gyro.matrix @ about)
    read = np.where(known, sums, 0.0) - np.outer(seconds, gyro.bias)
    angle = np.zeros(len(sums))
    for _unused in range(3):
        rate = turned_all(earth, about, at_middle(angle))
        sensed = read - rate * seconds[:, None] @ gyro.matrix.T
        angle = (sensed * weight) @ along / (along @ along)
    return np.asarray(angle)


# ---- What ideal sensors read on the earth: at rest, in free fall, under way.
#
# Axes along the local level frame, north, east, down (NED): forward north, right east. The triad
# keeps them there, so that it turns with the earth and with the local level (Titterton & Weston
# 2004, 3.7; Savage 2000):
#
#     rate   ω = ω_ie + ω_en,   ω_ie = ω_e (cos φ, 0, −sin φ)
#                               ω_en = (v_E / (N + h), −v_N / (M + h), −v_E tan φ / (N + h))
#     force  f = a − g,         with a = dv/dt + (2 ω_ie + ω_en) × v;  at a steady speed dv/dt = 0
#
# g is normal gravity, straight down: its north component at height, 8·10⁻⁹ h sin 2φ m/s² with h in
# m, is left out. In free fall a = g.


@dataclass(frozen=True)
class IdealReading:
    """Angular rate, rad/s, and specific force, m/s², (3,) each, along north, east, down."""

    rate: Array
    force: Array

    @property
    def in_enu(self) -> "IdealReading":
        """The same along east, north, up."""
        return IdealReading(*(each[[1, 0, 2]] * (1, 1, -1) for each in (self.rate, self.force)))


def at_steady_speed(
    latitude: float, height: float, velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> IdealReading:
    """At `latitude` (rad) and `height` (m), with a steady velocity (m/s) to north, east, down.

    At a pole there is neither north nor east, so there it holds at rest only.
    """
    meridian, across = radii(latitude)
    north, east, _ = velocity
    earth = EARTH_RATE * np.array([cos(latitude), 0.0, -sin(latitude)])
    over = east / (across + height)
    transport = np.array([over, -north / (meridian + height), -over * tan(latitude)])
    down = np.array([0.0, 0.0, normal_gravity(latitude, height)])
    acceleration = cross(2 * earth + transport, np.array(velocity))
    return IdealReading(earth + transport, acceleration - down)


def in_free_fall(latitude: float) -> IdealReading:
    """Falling freely without turning against the earth, at `latitude` (rad)."""
    return IdealReading(at_steady_speed(latitude, 0.0).rate, np.zeros(3))

"""How a turntable moves, and what is up for the IMU on it."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from inertial.arrays import Array, Booleans
from inertial.text.messages import _

# ---- Products of vectors.


MIN_VERTICAL_COSINE = 1 - 1e-6  # of the angle from an axis to the vertical: 0.1 degrees
MIN_PART_OF_TURN = 1e-3  # sine of half the angle: less is whole turns
MAX_LEAN = 0.01  # of a direction cosine: 34', what a set position leans and nobody meant
NEARLY = 0.1  # of a direction cosine: differences that do not count
_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


def cross(a: Array, b: Array) -> Array:
    """a × b over the last axis, (…, 3): numpy's own to the last bit, in an eighth of its time."""
    return np.asarray(a.take(_NEXT, -1) * b.take(_LAST, -1) - a.take(_LAST, -1) * b.take(_NEXT, -1))


# ---- The motion of a turntable, and the upward direction for the IMU on it.


def turned(direction: Array, about: Array, angle: float) -> Array:
    """A direction of the laboratory in body axes after a rotation of the IMU by `angle`.

    `direction` and `about` are body vectors before the turn. The IMU turns about `about` by the
    right-hand rule, so a direction fixed in the laboratory turns the other way in body axes.
    """
    return np.asarray(Rotation.from_rotvec(-angle * about).apply(direction), dtype=np.float64)


def level_axes(up: Array) -> tuple[Array, Array]:
    """Two horizontal directions in body axes that form, with `up`, a right-handed triad."""
    first, second = all_level_axes(up[None])[0]
    return first, second


def component(vectors: Array, axis: Array) -> Array:
    """Of vectors, (n, 3), along an axis, (n,), by the channels that it needs: others may be NaN."""
    own = np.flatnonzero(axis)
    return np.asarray(vectors[:, own] @ axis[own])


def horizontal(direction: Array, up: Array) -> Array:
    """The horizontal part of a direction, (3,), as a unit vector."""
    level = direction - up * (up @ direction)
    return np.asarray(level / np.linalg.norm(level))


def north_of(up: Array, mark: Array, azimuth: float) -> Array:
    """North in body axes, (3,), where the horizontal direction `mark` has an azimuth, rad.

    It counts clockwise, so north lies counter-clockwise of the mark, seen from above.
    """
    return np.asarray(np.cos(azimuth) * mark + np.sin(azimuth) * cross(up, mark))


def turned_between(up: Array, before: Array, after: Array) -> float:
    """The angle, rad, through which a case has turned about the vertical, in body axes, (3,).

    `before`, `after`: a direction that stays in the laboratory, such as a mark.
    """
    return float(np.arctan2(cross(after, before) @ up, after @ before))


def without_leans(up: Array) -> Array:
    """Upward directions (n, 3) with 0 for components that are but the lean of a set position.

    How far it leans is known by its own readings. A function of these that is steep there, or that
    nothing else determines, would explain the readings by themselves.
    """
    return np.where(np.abs(up) < MAX_LEAN, 0.0, up)


def is_vertical(up: Array, about: Array) -> bool:
    """Whether a table turns about the vertical: about a body axis that points up, or down."""
    return bool(abs(up @ about) > MIN_VERTICAL_COSINE)


def are_parts_of_turns(angle: Array) -> Booleans:
    """Which angles, rad, are no whole turns."""
    return np.asarray(np.abs(np.sin(angle / 2)) > MIN_PART_OF_TURN)


def all_level_axes(ups: Array) -> Array:
    """`level_axes` of many upward directions (n, 3), (n, 2, 3).

    The first is across a body axis that is nearly level: the first of those that are, so that no
    small tilt makes it another one.
    """
    size = np.abs(ups)
    least = np.eye(3)[np.argmax(size < size.min(axis=1, keepdims=True) + NEARLY, axis=1)]
    first = cross(least, ups)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([first, cross(ups, first)], axis=1)


@dataclass(frozen=True)
class Profile:
    """A turn with constant acceleration at its start and stop: a trapezoid of the rate.

    `angle` (rad) and `rate` (rad/s) are magnitudes; `acceleration` in rad/s².
    """

    angle: float
    rate: float
    acceleration: float

    @property
    def ramp_seconds(self) -> float:
        """Duration of the acceleration, and of the braking, s."""
        return self.rate / self.acceleration

    @property
    def seconds(self) -> float:
        """From start to stop, A/r + r/a, s."""
        return self.angle / self.rate + self.ramp_seconds

    def at(self, time: Array) -> tuple[Array, Array]:
        """Angle, rad, and rate, rad/s, at times since the start, (n,) each; still outside."""
        t = np.clip(time, 0.0, self.seconds)
        ramp, remaining = self.ramp_seconds, self.seconds - t
        up = self.acceleration * t**2 / 2
        steady = self.rate * (t - ramp / 2)
        down = self.angle - self.acceleration * remaining**2 / 2
        angle = np.where(t < ramp, up, np.where(remaining < ramp, down, steady))
        rate = np.minimum(self.rate, self.acceleration * np.minimum(t, remaining))
        return angle, rate


@dataclass(frozen=True)
class Motion:
    """Motion of the IMU on the table in n stretches of time, samples or blocks; body axes.

    `time`: (n,), s since the first sample of all logs, NaN where they have no common clock;
    `about`: (3,) or (n, 3), axis of the turn; `angle`, `rate`, `acceleration`: (n,), rad, rad/s,
    rad/s², turned about it since the start, at the middle of each stretch; `up`: (n, 3), the
    table's vertical; `north`: (n, 3), NaN where the azimuth is not known.

    Further properties of a stretch: `seconds`: (n,), its duration; `switched_on`: (n,), s, when the
    instrument was last switched on, 0 up to the first stated switch-on; `visit`: (n,), the place of
    its manoeuvre in the plan, `position`: (n,), that of its position among those of the plan, and
    `run`: (n,), which run of the instrument it is of, from switch-on to switch-off; `surveyed`:
    (n,), whether north is known from the table's heading and not from the gyros; `temperature`:
    (n,), K, and `vibration`: (n, 3), m/s², the standard deviation of the samples of specific force;
    `peaks`: (n, 3), m/s², the last extreme of specific force along each axis on the way to the
    manoeuvre; `senses`: (n, 3), ±1, in which it last turned about each axis on that way. These four
    are NaN where they are not known. `tumbled`: (n, 3), rad, the angle through which a tumble has
    turned the table to the position since its start, along its axis; else 0. `square`: (n,),
    rad²/s², the mean of the squared rate. `log_time`: (n,), s since the first sample of its log
    where each log begins with a switch-on, NaN where that is not so.

    `since`: (n, 3), s, from the end of the last turn about each axis in the same log to the middle
    of the stretch, negative in a turn, NaN where none is known; `turned`: (n, 3), its sense, ±1, 0
    where none is known. `measured_force`: (n, 3), m/s², the specific force in a turn as the
    accelerometers measured it, that of a lever arm with it; NaN where not known, or at rest.
    """

    time: Array
    about: Array
    angle: Array
    rate: Array
    acceleration: Array
    up: Array
    north: Array
    seconds: Array
    switched_on: Array
    visit: Array
    position: Array
    run: Array
    surveyed: Booleans
    temperature: Array
    vibration: Array
    peaks: Array
    senses: Array
    tumbled: Array
    square: Array
    log_time: Array
    since: Array
    turned: Array
    measured_force: Array

    @property
    def running(self) -> Array:
        """Time since the last switch-on, or since the first sample, (n,), s; NaN if not known."""
        return np.where(np.isfinite(self.time), self.time - self.switched_on, self.log_time)

    @property
    def omega(self) -> Array:
        """Rate of the table as a vector, (n, 3), rad/s."""
        return self.rate[:, None] * self.about

    @property
    def alpha(self) -> Array:
        """Angular acceleration of the table as a vector, (n, 3), rad/s²."""
        return self.acceleration[:, None] * self.about

    def pull(self, arm: Array) -> Array:
        """The mean of ω × (ω × r) over each stretch, (n, 3), m/s², for an arm r (3,), m."""
        return self.square[:, None] * cross(self.about, cross(self.about, arm))

    @property
    def averaging_factor(self) -> Array:
        """What is left of a vector that goes round, in its mean over each stretch, (n,).

        As `up` shows it; of a turn about the vertical, in which that stays, all.
        """
        along = self.about * np.sum(self.about * self.up, axis=1, keepdims=True)
        across = np.sqrt(np.maximum(1 - np.sum(along**2, axis=1), 0.0))
        seen = np.linalg.norm(self.up - along, axis=1)
        return np.where(across > NEARLY, seen / np.maximum(across, NEARLY), 1.0)

    @property
    def up_at_start(self) -> Array:
        """The upward direction in body axes when the manoeuvre began, (n, 3): fixed to the case."""
        return turned_all(self.up, self.about, -self.angle)

    @property
    def north_at_start(self) -> Array:
        """The north direction in body axes when the manoeuvre began, (n, 3): fixed to the case."""
        return turned_all(self.north, self.about, -self.angle)

    def ripples(self, order: float, sine: float, cosine: float) -> Array:
        """The mean rate over each stretch, (n,), rad/s, for an error of the table's angle θ of

        a sin nθ + b cos nθ, rad.
        """
        half = self.rate * self.seconds / 2
        first, last = order * (self.angle - half), order * (self.angle + half)
        ahead = sine * (np.sin(last) - np.sin(first)) + cosine * (np.cos(last) - np.cos(first))
        return np.asarray(ahead / self.seconds)

    @property
    def ends(self) -> Booleans:
        """Which stretches are the first or the last of their visit, (n,)."""
        new = np.diff(self.visit) != 0
        return np.asarray(np.append(True, new) | np.append(new, True))

    @property
    def since_middle(self) -> Array:
        """Time since the middle of the visit, (n,), s; without a clock by the stretches before."""
        place = np.cumsum(np.diff(self.visit, prepend=self.visit[0]) != 0)
        elapsed = np.cumsum(self.seconds) - self.seconds / 2
        time = np.where(np.isfinite(self.time), self.time, elapsed)
        middle = np.bincount(place, time) / np.bincount(place)
        return np.asarray(time - middle[place])


def without_north(motion: Motion) -> str:
    """Why directions fixed to the laboratory are not known; empty where they are."""
    if np.isfinite(motion.north).any():
        return ""
    return _("Neither a heading nor the earth's rate tells the azimuth of the positions.")


def turning(
    about: Array,
    up: Array,
    north: Array,
    angle: Array,
    rate: Array,
    acceleration: Array,
    time: Array,
    seconds: Array,
) -> Motion:
    """A turn from given up and north at its start, (3,); further properties are not known."""
    n = len(angle)
    return Motion(
        time,
        about,
        angle,
        rate,
        acceleration,
        turned_all(up, about, angle),
        turned_all(north, about, angle),
        seconds,
        *(np.zeros(n),) * 4,
        np.zeros(n, bool),
        np.full(n, np.nan),
        *(np.full((n, 3), np.nan),) * 3,
        np.zeros((n, 3)),
        rate**2 + (acceleration * seconds) ** 2 / 12,  # as constant as the acceleration is
        np.full(n, np.nan),
        np.full((n, 3), np.nan),
        np.zeros((n, 3)),
        np.full((n, 3), np.nan),
    )


def stretches(time: Array, seconds: Array, temperature: Array) -> Motion:
    """Stretches of which nothing but time, duration and temperature is known, (n,) each."""
    n = len(time)
    zero, unknown = np.zeros(n), np.full((n, 3), np.nan)
    return Motion(
        time,
        np.zeros(3),
        *(zero, zero, zero),
        *(unknown, unknown),
        seconds,
        *(zero, zero, zero, zero),
        np.zeros(n, bool),
        temperature,
        *(unknown, unknown, unknown),
        np.zeros((n, 3)),
        zero,
        np.full(n, np.nan),
        unknown,
        np.zeros((n, 3)),
        unknown,
    )


def joined(motions: Sequence[Motion]) -> Motion:
    """Several motions one after another."""

    def all_of(name: str) -> Array:
        return np.concatenate([getattr(motion, name) for motion in motions])

    names = [field.name for field in fields(Motion)]
    parts: dict[str, Any] = {name: all_of(name) for name in names if name != "about"}
    about = [np.broadcast_to(motion.about, motion.up.shape) for motion in motions]
    return Motion(about=np.concatenate(about), **parts)


def turned_all(direction: Array, about: Array, angles: Array) -> Array:
    """`turned` for many angles at once, (n, 3), by Rodrigues' formula.

    `direction`, `about`: (3,), or (n, 3) each its own.
    """
    along = about * np.sum(about * direction, axis=-1, keepdims=True)
    across = np.cos(angles)[:, None] * (direction - along)
    return np.asarray(along + across - np.sin(angles)[:, None] * cross(about, direction))


def mean_turned(direction: Array, about: Array, middle: Array, angle: Array) -> Array:
    """The mean of a direction while it turns by `angle` (n,) about each `middle` (n,), (n, 3).

    The component across the axis is reduced by sin(θ/2) / (θ/2).
    """
    along = (direction @ about) * about
    reduction = np.sinc(angle / (2 * np.pi))[:, None]
    return np.asarray(along + reduction * turned_all(direction - along, about, middle))

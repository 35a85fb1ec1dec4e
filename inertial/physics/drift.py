"""Drift from stretch to stretch: with the time since the start, and with the temperature.

A stretch may last for minutes, so its mean of a function of time is not the function at its
middle. The start is the first sample of all logs: for an instrument that was switched on before,
a warm-up began earlier, and its amplitude differs by a factor. Where the campaign states that it
was switched off and on between, a warm-up begins anew.
"""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from copy import copy
from typing import Self

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.physics.effect import (
    COLDEST,
    MEAN_TEMPERATURE,
    WARMEST,
    Constant,
    Effect,
    OfEither,
    Reading,
    Scan,
    Truth,
)
from inertial.physics.motion import Motion
from inertial.text.messages import _

THERMOMETER_ERROR = 1.0  # K beyond the coldest and the warmest mean; resolution of many

SLOPE_SHARE = 0.5  # of the thermometer's time constant, over which its slope is taken
SLOPE_POINTS = 17  # of a straight line

NO_CLOCK = _(
    "The logs share no clock, so nothing tells how long after one another they were recorded."
)
NO_TEMPERATURE = _("No temperature is recorded.")
NOT_EVERYWHERE = _("The temperature is not recorded everywhere.")


class Drift(OfEither):
    """A bias of each axis of a sensor, gyro or accel, that has a course in time.

    Its parameters are the sizes on x, y and z. `of_scale`: the scale factors have it, not the bias.
    """

    of_scale: bool = False

    @abstractmethod
    def course(self, motion: Motion) -> Array:
        """The mean of the course over each stretch, (n,)."""

    def blind(self, motion: Motion) -> str:
        return without_clock(motion)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        course = self.course(motion)
        if not self.of_scale:
            return reading.plus(self.sensor, np.outer(course, values))
        sensed = truth.rate if self.sensor == "gyro" else truth.force
        return reading.plus(self.sensor, values * sensed * course[:, None])


class Ramp(Drift):
    """An even drift: its course is the time since the first sample of all logs."""

    def course(self, motion: Motion) -> Array:
        return motion.time


def without_clock(motion: Motion) -> str:
    """Why drift with time is not observable; empty where it is."""
    return "" if np.isfinite(motion.time).all() else NO_CLOCK


def without_temperature(motion: Motion) -> str:
    """Why drift with temperature is not observable; empty where it is."""
    known = np.isfinite(motion.temperature)
    if known.all():
        return ""
    return NOT_EVERYWHERE if known.any() else NO_TEMPERATURE


def evenly(motion: Motion, count: int) -> Array:
    """`count` equally spaced times between the first stretch and the last, s, without the ends."""
    if without_clock(motion):
        return np.zeros(0)
    return np.unique(np.linspace(motion.time.min(), motion.time.max(), count + 2)[1:-1])


def after(motion: Motion, time: float) -> Array:
    """The share of each stretch after a time, (n,)."""
    return np.clip((motion.time - time) / motion.seconds + 0.5, 0.0, 1.0)


def mean_temperature(motion: Motion, reference: float | None) -> Constant:
    """The temperature that others are relative to: the mean of the campaign, K."""
    mean = reference
    if mean is None:
        mean = float(np.average(motion.temperature, weights=motion.seconds))
    return Constant(MEAN_TEMPERATURE, "K", _("mean temperature of the campaign"), mean)


def temperature_constants(
    motion: Motion, reference: float | None, valid: tuple[float, float] | None
) -> list[Constant]:
    """The mean temperature, and the range within which what depends on it is known, K."""
    low, high = valid or (float(motion.temperature.min()), float(motion.temperature.max()))
    return [
        mean_temperature(motion, reference),
        Constant(COLDEST, "K", _("lowest mean temperature of a block that the fit used"), low),
        Constant(WARMEST, "K", _("highest mean temperature of a block that the fit used"), high),
    ]


class OfTemperature(Drift):
    """A drift that goes with the temperature of the instrument less its mean."""

    def course(self, motion: Motion) -> Array:
        return warmer(motion, self.reference, self.valid)

    def constants(self, motion: Motion) -> Sequence[Constant]:
        return temperature_constants(motion, self.reference, self.valid)

    def blind(self, motion: Motion) -> str:
        return without_temperature(motion)


def warmer(
    motion: Motion, reference: float | None = None, valid: tuple[float, float] | None = None
) -> Array:
    """Temperature of each stretch less `reference`, the mean of the campaign, (n,), K.

    Without a reference the motion is all of the campaign. Outside of the range that is valid it is
    not extrapolated: NaN.
    """
    above = motion.temperature - mean_temperature(motion, reference).value
    return np.asarray(np.where(known_at(motion.temperature, valid), above, np.nan))


def known_at(temperature: Array, valid: tuple[float, float] | None) -> Booleans:
    """Which temperatures are within a range, or as near to it as a thermometer is sure, (n,)."""
    low, high = valid or (-np.inf, np.inf)
    return np.asarray(
        (temperature >= low - THERMOMETER_ERROR) & (temperature <= high + THERMOMETER_ERROR)
    )


def delay(time: Array, temperature: Array, lag: float) -> Array:
    """By how much a part of the instrument is warmer than its thermometer, (n,), K.

    It follows with a time constant `lag`, s, of first order: τ dT'/dt = T − T', both alike at the
    first of the times (n,), which are in any order. A negative one is that of the thermometer,
    which follows the part: T' = T + |τ| dT/dt. Between the times the temperature is linear.
    """
    if not lag or not np.isfinite(time).all():
        return np.zeros(len(time))
    constant = abs(lag)
    at, place = np.unique(time, return_inverse=True)
    course = np.bincount(place, temperature) / np.bincount(place)
    if lag < 0:
        return np.asarray(constant * _slopes(at, course, constant)[place])
    behind, below = np.zeros(len(at)), 0.0
    for i, (step, rise) in enumerate(zip(np.diff(at), np.diff(course), strict=True), 1):
        ramp = constant * rise / step
        below = (below - ramp) * np.exp(-step / constant) + ramp
        behind[i] = below
    return np.asarray(-behind[place])


def _slopes(time: Array, course: Array, constant: float) -> Array:
    """The slope of a course at its times, (n,), by straight lines over half a time constant.

    So short a line hardly changes what a first-order response shows, and averages the thermometer.
    """
    shortest = constant * SLOPE_SHARE / (SLOPE_POINTS - 1)
    count = int((time[-1] - time[0]) / shortest) + 1
    if count <= SLOPE_POINTS:
        return np.full(len(time), np.polyfit(time - time[0], course, 1)[0] if count > 1 else 0.0)
    grid = np.linspace(time[0], time[-1], count)
    step = float(grid[1] - grid[0])
    _each, place = np.unique(np.rint((time - time[0]) / step), return_inverse=True)
    number = np.bincount(place)
    at, means = np.bincount(place, time) / number, np.bincount(place, course) / number
    even = np.interp(grid, at, means)
    from scipy.signal import savgol_filter  # here, for it takes longer to load than most stages run

    slopes = savgol_filter(even, SLOPE_POINTS, 1, deriv=1, delta=step, mode="interp")
    return np.interp(time, grid, slopes)


# ---- Effects that are there from a moment on: of logs that share no clock, from one of them on.

BETWEEN_LOGS = Scan(
    "manoeuvre", "1", _("place in the plan of the first manoeuvre after it"), between=False
)
SHORT_RUNS = _("Each log holds so little that a bias of its own in each would explain as much.")
MIN_VISITS = 2  # of a log, on average: of more manoeuvres the bias of one of them is no scatter
BY_LOG = _("it sets in between two logs, and a reading does not tell of which it is")
JUMP_TIMES = 72  # that are tried: a jump between two of them loses 2 to 4 % of its SNR²


class SettingIn(Effect):
    """An effect that sets in at t₀, which is scanned, and stays.

    Of logs that share no clock it is sought between one and the next, in the order of the plan.
    """

    times: int  # that are tried
    by_share = True  # what each stretch has of it is in proportion to its share that is after

    def blind(self, motion: Motion) -> str:
        return "" if len(np.unique(motion.run)) > 1 else without_clock(motion)

    def grid(self, motion: Motion) -> Array:
        if not without_clock(motion):
            return evenly(motion, self.times)
        return np.unique(np.floor(motion.visit))[1:]

    def candidates(self, motion: Motion) -> Sequence[Self]:
        every = super().candidates(motion)
        return [one.between_logs() for one in every] if without_clock(motion) else every

    def as_named(self, values: Mapping[str, float]) -> Effect:
        at = values.get(BETWEEN_LOGS.name)
        return super().as_named(values) if at is None else self.fixed(at).between_logs()

    def between_logs(self) -> Self:
        """The effect with the place in the plan as what is scanned."""
        effect = copy(self)
        effect.scan = BETWEEN_LOGS
        if effect.terms:
            effect.terms = ()
            effect.stays = BY_LOG
        return effect

    def since(self, motion: Motion) -> Array:
        """The share of each stretch after it has set in, (n,)."""
        at = self.value(motion)
        if without_clock(motion):
            return np.asarray(motion.visit >= at, np.float64)
        return after(motion, at)


def of_short_runs(motion: Motion) -> bool:
    """Whether logs without a common clock hold hardly more than a manoeuvre each."""
    runs, visits = (len(np.unique(each)) for each in (motion.run, motion.visit))
    return bool(without_clock(motion)) and visits <= MIN_VISITS * runs

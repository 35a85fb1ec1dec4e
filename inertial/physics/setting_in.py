"""Effects that are there from a moment on: of logs that share no clock, from one of them on."""

from collections.abc import Mapping, Sequence
from copy import copy
from typing import ClassVar, Self

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import Drift, after, evenly, without_clock
from inertial.physics.effect import Effect, Reading, Scan, Truth
from inertial.physics.motion import Motion
from inertial.text.messages import _

BETWEEN_LOGS = Scan(
    "manoeuvre", "1", _("place in the plan of the first manoeuvre after it"), between=False
)
SHORT_RUNS = _("Each log holds so little that a bias of its own in each would explain as much.")
MIN_VISITS = 2  # of a log, on average: of more manoeuvres the bias of one of them is no scatter
BY_LOG = _("it sets in between two logs, and a reading does not tell of which it is")
JUMP_TIMES = 72  # that are tried: a jump between two of them loses 2 to 4 % of its SNR²
MIN_SENSED = 0.25  # of the most along an axis: what shows its scale factor
NEVER_BOTH_WAYS = _(
    "There is no time before and after which every axis is sensed both ways, by which a scale "
    "factor that jumps is told from one that depends on direction, rate or attitude."
)


class SettingIn(Effect):
    """An effect that sets in at t₀, which is scanned, and stays.

    Of logs that share no clock it is sought between one and the next, in the order of the plan.
    """

    times: ClassVar[int]  # that are tried

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
        effect.scan = BETWEEN_LOGS  # type: ignore[misc]
        if effect.terms:
            effect.terms = ()  # type: ignore[misc]
            effect.stays = BY_LOG  # type: ignore[misc]
        return effect

    def since(self, motion: Motion) -> Array:
        """The share of each stretch after it has set in, (n,)."""
        at = self.value(motion)
        if without_clock(motion):
            return np.asarray(motion.visit >= at, np.float64)
        return after(motion, at)


class Jump(SettingIn, Drift):
    """Reading += b H(t − t₀): a bias of each axis that jumps once; t₀ is scanned.

    Unlike a drift it is instantaneous. Where logs without a common clock hold a manoeuvre or two,
    biases of each run, which are a scatter of the manoeuvres, stand for it.
    """

    cause = _(
        "stress is released, the electronics switch, or the instrument is knocked or restarted"
    )
    source = "Basseville & Nikiforov 1993, Detection of Abrupt Changes, chapter 2"
    scan = Scan("t0", "s", _("time of the jump since the first sample of all logs"))
    times = JUMP_TIMES

    def blind(self, motion: Motion) -> str:
        return super().blind(motion) or (SHORT_RUNS if _of_short_runs(motion) else "")

    def grid(self, motion: Motion) -> Array:
        return np.zeros(0) if _of_short_runs(motion) else super().grid(motion)

    def course(self, motion: Motion) -> Array:
        return self.since(motion)


def _of_short_runs(motion: Motion) -> bool:
    """Whether logs without a common clock hold hardly more than a manoeuvre each."""
    runs, visits = (len(np.unique(each)) for each in (motion.run, motion.visit))
    return bool(without_clock(motion)) and visits <= MIN_VISITS * runs


class ScaleJump(SettingIn):
    """Reading_i += k_i H(t − t₀) times what is sensed along i: scale factors that jump once.

    t₀ is scanned, over the times before and after which every axis is sensed both ways. Told from
    a bias that jumps by the directions, from a drift of the scale factors by being instantaneous.
    """

    cause = _("the instrument is restarted, set to another range, or knocked")
    source = "IEEE Std 528-2019, 'repeatability'"
    sensor: ClassVar[str]
    scan = Scan("t0", "s", _("time of the jump since the first sample of all logs"))
    times = JUMP_TIMES
    thinkable = 10.0

    def blind(self, motion: Motion) -> str:
        return super().blind(motion) or ("" if len(self.grid(motion)) else NEVER_BOTH_WAYS)

    def grid(self, motion: Motion) -> Array:
        every = super().grid(motion)
        shown = [self._shown(motion, float(at)) for at in every]
        return np.asarray(every[np.array(shown, bool)])

    def _shown(self, motion: Motion, at: float) -> bool:
        """Whether each axis is sensed both ways before a jump and after it."""
        sensed = motion.omega if self.sensor == "gyro" else motion.up
        clear = np.abs(sensed) > MIN_SENSED * np.abs(sensed).max(axis=0)
        after = self.fixed(at).since(motion)
        return all(
            bool((clear & (way * sensed > 0))[after == side].any(axis=0).all())
            for side in (0, 1)
            for way in (1, -1)
        )

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        sensed = truth.rate if self.sensor == "gyro" else truth.force
        return reading.plus(self.sensor, self.since(motion)[:, None] * sensed * values)

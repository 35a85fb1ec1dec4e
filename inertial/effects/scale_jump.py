"""Scale factors of a sensor that jump once."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import JUMP_TIMES, Drift, SettingIn, without_clock
from inertial.physics.effect import OfSensor, Scan, by_grade
from inertial.physics.motion import Motion
from inertial.text.messages import _

MIN_SENSED = 0.25  # of the most along an axis: what shows its scale factor
NEVER_BOTH_WAYS = _(
    "There is no time before and after which every axis is sensed both ways, by which a scale "
    "factor that jumps is told from one that depends on direction, rate or attitude."
)


class ScaleJump(SettingIn, Drift):
    """Reading_i += k_i H(t − t₀) times what is sensed along i: scale factors that jump once.

    t₀ is scanned, over the times before and after which every axis is sensed both ways. Told from
    a bias that jumps by the directions, from a drift of the scale factors by being instantaneous.
    """

    kind, letter, factor = "scale_jump", "k", "(t > t0) * s_{i}"
    of_scale = True
    cause = _("the instrument is restarted, set to another range, or knocked")
    source = "IEEE Std 528-2019, 'repeatability'"
    scan = Scan("t0", "s", _("time of the jump since the first sample of all logs"))
    times = JUMP_TIMES
    gyro = OfSensor(
        _("jump of the scale factor of the {axis} gyro"),
        "1",
        1e-5,
        by_grade(1e-6, 5, 50, 300, 1000),
    )
    accel = OfSensor(
        _("jump of the scale factor of the {axis} accelerometer"),
        "1",
        1e-5,
        by_grade(1e-6, 50, 200, 500, 1000),
    )
    thinkable = 10.0

    def blind(self, motion: Motion) -> str:
        return super().blind(motion) or ("" if len(self.grid(motion)) else NEVER_BOTH_WAYS)

    def grid(self, motion: Motion) -> Array:
        every = super().grid(motion)
        sensed = motion.omega if self.sensor == "gyro" else motion.up
        clear = np.abs(sensed) > MIN_SENSED * np.abs(sensed).max(axis=0)
        begin, end = _ends(motion)
        either_way = np.concatenate([clear & (way * sensed > 0) for way in (1, -1)], axis=1)
        shown_before = np.where(either_way, end[:, None], np.inf).min(axis=0).max()
        shown_after = np.where(either_way, begin[:, None], -np.inf).max(axis=0).min()
        return np.asarray(every[(every >= shown_before) & (every <= shown_after)])

    def course(self, motion: Motion) -> Array:
        return self.since(motion)


def _ends(motion: Motion) -> tuple[Array, Array]:
    """From when on, and until when, what sets in comes in or after each stretch, (n,) each."""
    if without_clock(motion):
        place = np.floor(motion.visit)
        return place, place + 1
    return motion.time - motion.seconds / 2, motion.time + motion.seconds / 2

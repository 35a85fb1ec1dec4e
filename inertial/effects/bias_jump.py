"""Biases of a sensor that jump once."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import JUMP_TIMES, SHORT_RUNS, Drift, SettingIn, of_short_runs
from inertial.physics.effect import OfSensor, Scan, by_grade
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY

# Of a bias that is another one at once: unit and typical size, and sizes by grade.
TYPICAL = {"gyro": ("rad/s", DEGREE_PER_HOUR), "accel": ("m/s²", 1e-5 * STANDARD_GRAVITY)}
SIZES = {
    "gyro": by_grade(DEGREE_PER_HOUR, 0.3, 10, 30, 100),
    "accel": by_grade(1e-6 * STANDARD_GRAVITY, 20, 100, 200, 1000),
}


class BiasJump(SettingIn, Drift):
    """Reading += b H(t − t₀): a bias of each axis that jumps once; t₀ is scanned.

    Unlike a drift it is instantaneous. Where logs without a common clock hold a manoeuvre or two,
    biases of each run, which are a scatter of the manoeuvres, stand for it.
    """

    kind, letter, factor = "bias_jump", "b", "(t > t0)"
    cause = _(
        "stress is released, the electronics switch, or the instrument is knocked or restarted"
    )
    source = "Basseville & Nikiforov 1993, Detection of Abrupt Changes, chapter 2"
    scan = Scan("t0", "s", _("time of the jump since the first sample of all logs"))
    times = JUMP_TIMES
    gyro = OfSensor(_("jump of the bias of the {axis} gyro"), *TYPICAL["gyro"], SIZES["gyro"])
    accel = OfSensor(
        _("jump of the bias of the {axis} accelerometer"), *TYPICAL["accel"], SIZES["accel"]
    )

    def blind(self, motion: Motion) -> str:
        return super().blind(motion) or (SHORT_RUNS if of_short_runs(motion) else "")

    def grid(self, motion: Motion) -> Array:
        return np.zeros(0) if of_short_runs(motion) else super().grid(motion)

    def course(self, motion: Motion) -> Array:
        return self.since(motion)

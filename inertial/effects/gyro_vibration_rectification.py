"""A gyro whose bias grows with vibration."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Reading, Truth, by_grade, parameters_by_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY

UNIT = DEGREE_PER_HOUR / STANDARD_GRAVITY**2


class GyroVibrationRectification(Effect):
    """ω̃_i += k_i (σ_x² + σ_y² + σ_z²), with σ the scatter of the samples of specific force.

    What is elastic in the gyro rectifies forces and rotations that oscillate with the same period,
    coning of its case among them: a resonance of the table at one of its rates does it there
    alone. Told from a bias by two levels of vibration. Vibration that is too fast for the samples
    is not observable in them.
    """

    name = "gyro_vibration_rectification"
    cause = _("vibration does not average out in the gyro: its suspension, or its case, cones")
    source = "Weinberg 2011, Gyro mechanical performance, Analog Devices MS-2158"
    parameters = parameters_by_axis(
        "k",
        "(rad/s)/(m/s²)²",
        0.1 * UNIT,
        _("bias of the {axis} gyro per variance of the force along all axes"),
    )
    stays = _("it depends on how much the samples scatter, which one reading does not tell")
    sizes = by_grade(UNIT, 0.1, 1, 10, 100)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        shaken = np.sum(motion.vibration**2, axis=1, keepdims=True)
        return reading.plus("gyro", shaken * values)

    def blind(self, motion: Motion) -> str:
        if np.isfinite(motion.vibration).all():
            return ""
        return _("How much the table shakes is not known everywhere.")

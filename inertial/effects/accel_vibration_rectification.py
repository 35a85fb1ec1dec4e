"""An accelerometer whose bias grows with vibration."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Reading, Truth, by_grade, parameters_by_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY


class AccelVibrationRectification(Effect):
    """f̃_i += k_i σ_i², with σ the scatter of the samples of that accelerometer.

    Told from a bias by two levels of vibration: a quiet table and a shaking one. The sensor's own
    noise is in σ too, alike everywhere, and so in the bias. Vibration that is too fast for the
    samples is not observable in them.
    """

    name = "accel_vibration_rectification"
    cause = _("vibration does not average out where the accelerometer is not linear")
    source = "IEEE Std 1293-2018, vibration rectification error"
    parameters = parameters_by_axis(
        "k",
        "(m/s²)/(m/s²)²",
        1e-4 / STANDARD_GRAVITY,
        _("bias of the {axis} accelerometer per variance of the force along it"),
    )
    stays = _("it depends on how much the samples scatter, which one reading does not tell")
    sizes = by_grade(1e-6 / STANDARD_GRAVITY, 50, 100, 500, 1000)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        return reading.plus("accel", values * motion.vibration**2)

    def blind(self, motion: Motion) -> str:
        if np.isfinite(motion.vibration).all():
            return ""
        return _("How much the table shakes is not known everywhere.")

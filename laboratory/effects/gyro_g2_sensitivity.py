"""Sensitivity of a gyro to the square of specific force (g²-sensitivity)."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, STANDARD_GRAVITY


class GyroG2Sensitivity(ArrayEffect):
    """ω̃_i += G2_i f_i², f_i the specific force along the case's axis i; anisoelasticity.

    value: G2, (3,), (rad/s)/(m/s²)².
    Source: IEEE Std 528-2019, "acceleration-squared-sensitive drift rate".
    """

    KEY = "k_deg_h_g2"
    UNIT = DEGREE / HOUR / STANDARD_GRAVITY**2

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(self.value * truth.force**2)

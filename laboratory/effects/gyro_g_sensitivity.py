"""Sensitivity of a gyro to specific force (g-sensitivity)."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, STANDARD_GRAVITY


class GyroGSensitivity(ArrayEffect):
    """ω̃ += G f, f the specific force of the case; mass unbalance, stress of the package.

    value: G, (3, 3), (rad/s)/(m/s²), row = gyro, column = axis of the force.
    Source: IEEE Std 528-2019, "acceleration-sensitive drift rate".
    """

    KEY = "matrix_deg_h_g"
    UNIT = DEGREE / HOUR / STANDARD_GRAVITY

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(truth.force @ self.value.T)

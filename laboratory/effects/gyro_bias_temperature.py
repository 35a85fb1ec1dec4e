"""Temperature coefficient of the gyro biases."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


class GyroBiasTemperature(ArrayEffect):
    """ω̃ += k ΔT, ΔT from the temperature at which `truth` specifies the biases.

    value: k, (3,), (rad/s)/K.
    """

    KEY = "k_deg_h_k"
    UNIT = DEGREE / HOUR

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(truth.warmer("gyro")[:, None] * self.value)

"""Temperature coefficient of the accelerometer biases."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY


class AccelBiasTemperature(ArrayEffect):
    """f̃ += k ΔT, ΔT from the temperature at which `truth` specifies the biases.

    value: k, (3,), (m/s²)/K.
    """

    KEY = "k_micro_g_k"
    UNIT = MICROGRAVITY

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_accelerometers(truth.warmer("accelerometer")[:, None] * self.value)

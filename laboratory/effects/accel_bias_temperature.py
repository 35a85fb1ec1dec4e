"""Accelerometer biases that follow the temperature."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY


class AccelBiasTemperature(ArrayEffect):
    """f̃ += k ΔT, ΔT from the temperature at which the biases are as the laboratory says.

    value: k, (3,), (m/s²)/K.
    """

    KEY = "k_micro_g_k"
    UNIT = MICROGRAVITY

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_accelerometers(truth.warmer[:, None] * self.value)

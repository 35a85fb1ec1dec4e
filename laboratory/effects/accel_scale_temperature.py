"""Accelerometer scale factors that follow the temperature."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import PPM


class AccelScaleTemperature(ArrayEffect):
    """f̃_i += k_i ΔT f_i, f_i the specific force along the axis of accelerometer i.

    value: k, (3,), 1/K.
    """

    KEY = "k_ppm_k"
    UNIT = PPM

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.accelerometer.feels(truth.force)
        return Reading.of_accelerometers(truth.warmer[:, None] * self.value * felt)

"""Temperature coefficient of the gyro scale factors."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import PPM


class GyroScaleTemperature(ArrayEffect):
    """ω̃_i += k_i ΔT ω_i, ω_i the rate along the axis of gyro i.

    value: k, (3,), 1/K.
    """

    KEY = "k_ppm_k"
    UNIT = PPM

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        rate = sensors.gyro.project(truth.rate)
        return Reading.of_gyros(truth.warmer("gyro")[:, None] * self.value * rate)

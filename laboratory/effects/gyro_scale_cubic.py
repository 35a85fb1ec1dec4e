"""Cubic nonlinearity of a gyro."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, PPM


class GyroScaleCubic(ArrayEffect):
    """ω̃_i += K3_i ω_i³, ω_i the rate along the axis of gyro i.

    value: K3, (3,), 1/(rad/s)².
    Source: IEEE Std 528-2019, "nonlinearity".
    """

    KEY = "k3_ppm_per_deg_s_2"
    UNIT = PPM / DEGREE**2

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        rate = sensors.gyro.project(truth.rate)
        return Reading.of_gyros(self.value * rate * rate**2)

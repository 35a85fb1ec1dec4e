"""Dependence of a gyro scale factor on the specific force along its axis."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import PPM, STANDARD_GRAVITY


class GyroScaleGDependence(ArrayEffect):
    """ω̃_i += k_i ω_i f_i, the rate and the specific force along axis i.

    value: k, (3,), 1/(m/s²).
    """

    KEY = "k_ppm_g"
    UNIT = PPM / STANDARD_GRAVITY

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        rate = sensors.gyro.project(truth.rate)
        return Reading.of_gyros(self.value * rate * truth.force)

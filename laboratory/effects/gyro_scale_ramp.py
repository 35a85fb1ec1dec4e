"""Scale factors of the gyros that change with time."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import HOUR, PPM


class GyroScaleRamp(ArrayEffect):
    """ω̃_i += k_i t ω_i, t since the campaign's first sample: a light source ages.

    value: k, (3,), 1/s.
    """

    KEY = "k_ppm_h"
    UNIT = PPM / HOUR

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        rate = sensors.gyro.project(truth.rate)
        return Reading.of_gyros(truth.time[:, None] * rate * self.value)

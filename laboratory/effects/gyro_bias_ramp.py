"""Linear drift of the gyro biases."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


class GyroBiasRamp(ArrayEffect):
    """ω̃ += c t, t since the campaign's first sample, through all logs and the pauses between.

    value: c, (3,), rad/s².
    """

    KEY = "ramp_deg_h_h"
    UNIT = DEGREE / HOUR**2

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(truth.time[:, None] * self.value)

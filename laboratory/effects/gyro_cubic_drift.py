"""Cubic drift of the gyro biases."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


class GyroCubicDrift(ArrayEffect):
    """ω̃ += c t³, t since the campaign's first sample, through all logs and the pauses between.

    value: c, (3,), rad/s⁴.
    """

    KEY = "k_deg_h_h3"
    UNIT = DEGREE / HOUR**4

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(truth.time[:, None] ** 3 * self.value)

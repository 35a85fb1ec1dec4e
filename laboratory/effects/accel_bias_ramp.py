"""Linear drift of the accelerometer biases."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import HOUR


class AccelBiasRamp(ArrayEffect):
    """f̃ += c t, t since the campaign's first sample, through all logs and the pauses between.

    value: c, (3,), m/s³.
    """

    KEY = "ramp_m_s2_h"
    UNIT = 1 / HOUR

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_accelerometers(truth.time[:, None] * self.value)

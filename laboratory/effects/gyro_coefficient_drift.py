"""Temperature coefficients of the gyro biases that change with time."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


class GyroCoefficientDrift(ArrayEffect):
    """ω̃ += k t ΔT, t since the campaign's first sample: an adhesive cures.

    value: k, (3,), rad/s/K/s.
    """

    KEY = "k_deg_h_k_h"
    UNIT = DEGREE / HOUR / HOUR

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        warmer = truth.warmer("gyro") * truth.time
        return Reading.of_gyros(warmer[:, None] * self.value)

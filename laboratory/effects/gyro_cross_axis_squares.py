"""Squares of the angular rates in a gyro."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROSECOND


class GyroCrossAxisSquares(ArrayEffect):
    """ω̃_i += Σ K_ij ω_j², rates about the case's axes.

    value: K, (3, 3), s, row = gyro, column = axis of the rate.
    Source: IEEE Std 528-2019, "anisoinertia".
    """

    KEY = "matrix_us"
    UNIT = MICROSECOND

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(truth.rate**2 @ self.value.T)

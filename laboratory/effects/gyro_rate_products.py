"""Products of two angular rates in a gyro: anisoinertia."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROSECOND


class GyroRateProducts(ArrayEffect):
    """ω̃_i += K_i,yz ω_y ω_z + K_i,zx ω_z ω_x + K_i,xy ω_x ω_y, rates about the case's axes.

    value: K, (3, 3), s, row = gyro, columns yz, zx, xy.
    Source: IEEE Std 528-2019, "anisoinertia".
    """

    KEY = "matrix_us"
    UNIT = MICROSECOND

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        x, y, z = truth.rate.T
        return Reading.of_gyros(np.column_stack([y * z, z * x, x * y]) @ self.value.T)

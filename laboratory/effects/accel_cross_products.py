"""Cross-coupling of an accelerometer: sensitivity to products of specific forces."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY, STANDARD_GRAVITY


class AccelCrossProducts(ArrayEffect):
    """f̃_i += K_i,yz f_y f_z + K_i,zx f_z f_x + K_i,xy f_x f_y, forces along the case's axes.

    value: K, (3, 3), (m/s²)/(m/s²)², row = accelerometer, columns yz, zx, xy.
    Source: IEEE Std 1293-2018, model equation, cross-coupling coefficients.
    """

    KEY = "matrix_micro_g_g2"
    UNIT = MICROGRAVITY / STANDARD_GRAVITY**2

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        x, y, z = truth.force.T
        return Reading.of_accelerometers(np.column_stack([y * z, z * x, x * y]) @ self.value.T)

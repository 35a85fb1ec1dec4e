"""Quadratic nonlinearity of an accelerometer."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY, STANDARD_GRAVITY


class AccelQuadratic(ArrayEffect):
    """f̃_i += K2_i f_i², f_i the specific force along the axis of sensor i.

    value: K2, (3,), (m/s²)/(m/s²)². Source: IEEE Std 1293-2018, model equation, K_2.
    """

    KEY = "k2_micro_g_g2"
    UNIT = MICROGRAVITY / STANDARD_GRAVITY**2

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_accelerometers(
            self.value * sensors.accelerometer.project(truth.force) ** 2
        )

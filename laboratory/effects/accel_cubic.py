"""Cubic nonlinearity of an accelerometer."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY, STANDARD_GRAVITY


class AccelCubic(ArrayEffect):
    """f̃_i += K3_i f_i³, f_i the specific force along the axis of sensor i.

    value: K3, (3,), (m/s²)/(m/s²)³. Source: IEEE Std 1293-2018, model equation, K_3.
    """

    KEY = "k3_micro_g_g3"
    UNIT = MICROGRAVITY / STANDARD_GRAVITY**3

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        force = sensors.accelerometer.project(truth.force)
        return Reading.of_accelerometers(self.value * force * force**2)

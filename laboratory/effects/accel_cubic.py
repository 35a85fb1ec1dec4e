"""An accelerometer that answers to the third power of its force."""

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

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.accelerometer.feels(truth.force)
        return Reading.of_accelerometers(self.value * felt * felt**2)

"""A bias of the gyros that follows the rate of the temperature."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, MINUTE

STEP = 1.0  # s, over which the rate is taken: a coil takes that long to follow


class GyroTemperatureRate(ArrayEffect):
    """ω̃ += k dT/dt: light takes different times through the halves of a coil (Shupe).

    value: k, (3,), (rad/s)/(K/s). Source: D. M. Shupe, Appl. Opt. 19, 1980, 654.
    """

    KEY = "k_deg_h_k_min"
    UNIT = DEGREE / HOUR * MINUTE

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        ends = (truth.time - STEP / 2, truth.time + STEP / 2)
        before, after = (truth.temperature.at("gyro", time) for time in ends)
        return Reading.of_gyros(((after - before) / STEP)[:, None] * self.value)

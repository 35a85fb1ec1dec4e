"""Scale factors of the accelerometers that change with time."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import HOUR, PPM


class AccelScaleRamp(ArrayEffect):
    """f̃_i += k_i t f_i, t since the campaign's first sample: a magnet or a reference voltage ages.

    value: k, (3,), 1/s.
    """

    KEY = "k_ppm_h"
    UNIT = PPM / HOUR

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        force = sensors.accelerometer.project(truth.force)
        return Reading.of_accelerometers(truth.time[:, None] * force * self.value)

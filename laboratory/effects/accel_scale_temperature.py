"""Temperature coefficient of the accelerometer scale factors."""

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import PPM


class AccelScaleTemperature(ArrayEffect):
    """f̃_i += k_i ΔT f_i, f_i the specific force along the axis of accelerometer i.

    value: k, (3,), 1/K.
    """

    KEY = "k_ppm_k"
    UNIT = PPM

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        force = sensors.accelerometer.project(truth.force)
        return Reading.of_accelerometers(
            truth.warmer("accelerometer")[:, None] * self.value * force
        )

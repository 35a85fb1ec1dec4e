"""A bias that is another one in a single position."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import SHORT_RUNS, of_short_runs
from inertial.physics.effect import Effect, Reading, Scan, Truth, by_grade, parameters_by_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY

TYPICAL = {"gyro": ("rad/s", DEGREE_PER_HOUR), "accel": ("m/s²", 1e-5 * STANDARD_GRAVITY)}
SIZES = {
    "gyro": by_grade(DEGREE_PER_HOUR, 0.3, 10, 30, 100),
    "accel": by_grade(1e-6 * STANDARD_GRAVITY, 20, 100, 200, 1000),
}
MEANINGS = {
    "gyro": _("further bias of the {axis} gyro in this position"),
    "accel": _("further bias of the {axis} accelerometer in this position"),
}


class BiasOfPosition(Effect):
    """Reading += b in one position; the position is scanned.

    Whatever disturbs a sensor in one position alone changes its means there by some vector: a
    contact, a cable that pulls, a field, axes that are assigned otherwise in its log. Where each
    axis is up in one position and down in one, a square of the force along an axis, or another
    scale factor of its negative side, does the same to the data. Where logs without a common clock
    hold a manoeuvre or two, biases of each run stand for it, as for a `Jump`.
    """

    cause = _(
        "something disturbs the sensor there and nowhere else: a contact, a cable that pulls, a "
        "field, or axes that are exchanged in its log"
    )
    source = "IEEE Std 1293-2018, tumble test: residuals of single positions"
    stays = _("it is there in one position of the campaign alone")
    of_stillness = True  # by hand a single position is what it was held as
    scan = Scan("position", "1", _("place of the position among those of the plan"), between=False)

    def __init__(self, sensor: str) -> None:
        unit, size = TYPICAL[sensor]
        self.name, self.sensor, self.sizes = f"{sensor}_bias_of_position", sensor, SIZES[sensor]
        self.parameters = parameters_by_axis("b", unit, size, MEANINGS[sensor])

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        return reading.plus(self.sensor, np.outer(motion.position == self.value(motion), values))

    def blind(self, motion: Motion) -> str:
        return SHORT_RUNS if of_short_runs(motion) else ""

    def grid(self, motion: Motion) -> Array:
        return np.zeros(0) if of_short_runs(motion) else np.unique(motion.position)

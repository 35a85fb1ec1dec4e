"""A bias that is another one in a single position."""

import numpy as np

from inertial.arrays import Array
from inertial.effects.bias_jump import SIZES, TYPICAL
from inertial.physics.drift import SHORT_RUNS, of_short_runs
from inertial.physics.effect import OfEither, OfSensor, Reading, Scan, Truth
from inertial.physics.motion import Motion
from inertial.text.messages import _


class BiasOfPosition(OfEither):
    """Reading += b in one position; the position is scanned.

    Whatever disturbs a sensor in one position alone changes its means there by some vector: a
    contact, a cable that pulls, a field, axes that are assigned otherwise in its log. Where each
    axis is up in one position and down in one, a square of the force along an axis, or another
    scale factor of its negative side, does the same to the data. Where logs without a common clock
    hold a manoeuvre or two, biases of each run stand for it, as for a `BiasJump`.
    """

    kind, letter = "bias_of_position", "b"
    cause = _(
        "something disturbs the sensor there and nowhere else: a contact, a cable that pulls, a "
        "field, or axes that are exchanged in its log"
    )
    source = "IEEE Std 1293-2018, tumble test: residuals of single positions"
    stays = _("it is there in one position of the campaign alone")
    of_stillness = True  # by hand a single position is what it was held as
    scan = Scan("position", "1", _("place of the position among those of the plan"), between=False)
    gyro = OfSensor(
        _("further bias of the {axis} gyro in this position"), *TYPICAL["gyro"], SIZES["gyro"]
    )
    accel = OfSensor(
        _("further bias of the {axis} accelerometer in this position"),
        *TYPICAL["accel"],
        SIZES["accel"],
    )

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        return reading.plus(self.sensor, np.outer(motion.position == self.value(motion), values))

    def blind(self, motion: Motion) -> str:
        return SHORT_RUNS if of_short_runs(motion) else ""

    def grid(self, motion: Motion) -> Array:
        return np.zeros(0) if of_short_runs(motion) else np.unique(motion.position)

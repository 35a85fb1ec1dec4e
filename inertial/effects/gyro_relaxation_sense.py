"""A gyro bias with the sense of the last turn, which relaxes."""

import numpy as np

from inertial.arrays import Array
from inertial.effects.gyro_relaxation import Relaxing, excited
from inertial.physics.effect import Reading, Truth, parameters_by_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR


class GyroRelaxationSense(Relaxing):
    """ω̃_i += b_i s_i exp(−t/τ), t since the last turn about axis i ended, s_i = ±1 its sense.

    What carries the sense is turned about its own axis: the core, the suspension or the electrodes
    of that gyro. While the turn lasts it is b_i s_i (`in_turns`), as of what the rate strains or
    charges. In turns of one rate that is a scale factor.
    """

    name = "gyro_relaxation_sense"
    cause = _("each turn strains or charges the sensor with its sense, which then recovers")
    source = "Nowick & Berry 1972, Anelastic Relaxation in Crystalline Solids, ch. 1"
    parameters = parameters_by_axis(
        "b",
        "rad/s",
        0.1 * DEGREE_PER_HOUR,
        _("further bias of the {axis} gyro after a forward turn"),
    )
    in_turns: bool = True

    def added(self, truth: Truth, motion: Motion) -> Reading:
        shares = excited(motion.since, motion.seconds[:, None], self.value(motion))
        share = shares.left + shares.turning if self.in_turns else shares.left
        gyro = (motion.turned * share)[:, :, None] * np.eye(3)
        return Reading(gyro, np.zeros_like(gyro))

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        return reading.plus("gyro", self.added(truth, motion).gyro @ values)

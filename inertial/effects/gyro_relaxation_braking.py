"""A gyro bias that the stop of a turn leaves with its sense, and which relaxes."""

from inertial.effects.gyro_relaxation_sense import GyroRelaxationSense
from inertial.text.messages import _


class GyroRelaxationBraking(GyroRelaxationSense):
    """As `GyroRelaxationSense`, but nothing while the turn lasts: braking strains.

    The two differ by a scale factor in turns of one rate: as a class, their spread is in its sigma.
    """

    name = "gyro_relaxation_braking"
    cause = _("the stop of each turn strains the sensor with its sense, which then recovers")
    in_turns = False

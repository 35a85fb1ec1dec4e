"""A gyro at the end of its range."""

from inertial.physics.effect import Effect, Parameter, by_grade
from inertial.text.messages import _
from inertial.text.units import DEGREE


class GyroSaturation(Effect):
    """Reading = ±limit where the rate is beyond it.

    No part of the fit: the samples at the limit are detected, and masked, by their equal extreme
    counts. What a mean over them would be wrong by nobody knows.
    """

    name = "gyro_saturation"
    cause = _("the angular rate exceeds what the gyro or its converter can tell")
    source = "IEEE Std 528-2019, 'input limits'"
    parameters = (Parameter("limit", "rad/s", DEGREE, "the largest reading"),)
    sizes = by_grade(DEGREE, 450, 400, 450, 1000)
    sought_in = "quality"
    finding = "saturation"

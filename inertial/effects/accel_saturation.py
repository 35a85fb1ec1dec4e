"""A accelerometer at the end of its range."""

from inertial.physics.effect import Effect, Parameter, by_grade
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY


class AccelSaturation(Effect):
    """Reading = ±limit where the specific force is beyond it.

    No part of the fit: the samples at the limit are detected, and masked, by their equal extreme
    counts. What a mean over them would be wrong by nobody knows.
    """

    name = "accel_saturation"
    cause = _("the specific force exceeds what the accelerometer or its converter can tell")
    source = "IEEE Std 528-2019, 'input limits'"
    parameters = (Parameter("limit", "m/s²", STANDARD_GRAVITY, "the largest reading"),)
    sizes = by_grade(STANDARD_GRAVITY, 5, 10, 5, 8)
    sought_in = "quality"
    finding = "saturation"

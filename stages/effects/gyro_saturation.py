"""A gyro at the end of its range."""

from stages.model.effect import Effect, Parameter
from stages.model.sizes import by_grade
from stages.notation.units import DEGREE


class GyroSaturation(Effect):
    """Reading = ±limit where the rate is beyond it.

    No part of the fit: the samples at the limit are found, and masked, by their equal extreme
    counts. What a mean over them would be wrong by nobody knows.
    """

    name = "gyro_saturation"
    cause = "the angular rate exceeds what the gyro or its converter can tell"
    source = "IEEE Std 528-2019, 'input limits'"
    parameters = (Parameter("limit", "rad/s", DEGREE, "the largest reading"),)
    sizes = by_grade(DEGREE, 450, 400, 450, 1000)
    sought_in = "quality"
    finding = "saturation"

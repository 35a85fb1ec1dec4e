"""A sensor at the end of its range."""

from inertial.physics.effect import Effect, Parameter, by_grade
from inertial.text.messages import _
from inertial.text.units import DEGREE, STANDARD_GRAVITY

UNITS = {"gyro": ("rad/s", DEGREE), "accel": ("m/s²", STANDARD_GRAVITY)}
SIZES = {
    "gyro": by_grade(DEGREE, 450, 400, 450, 1000),
    "accel": by_grade(STANDARD_GRAVITY, 5, 10, 5, 8),
}
CAUSES = {
    "gyro": _("the angular rate exceeds what the gyro or its converter can tell"),
    "accel": _("the specific force exceeds what the accelerometer or its converter can tell"),
}


class Saturation(Effect):
    """Reading = ±limit where the rate, or the specific force, is beyond it.

    No part of the fit: the samples at the limit are detected, and masked, by their equal extreme
    counts. What a mean over them would be wrong by nobody knows.
    """

    source = "IEEE Std 528-2019, 'input limits'"
    sought_in = "quality"
    finding = "saturation"

    def __init__(self, sensor: str) -> None:
        self.name, self.cause, self.sizes = f"{sensor}_saturation", CAUSES[sensor], SIZES[sensor]
        self.parameters = (Parameter("limit", *UNITS[sensor], "the largest reading"),)

"""A bias of the gyros that is not stable."""

from inertial.physics.effect import Effect, Parameter, by_grade
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR


class GyroFlicker(Effect):
    """The bias has a power density B²/(2π f): the floor of its Allan deviation is 0.664 B.

    It has no mean, so no columns, but a covariance; between the white noise and the random walk
    it sets what a longer rest can gain.
    """

    name = "gyro_flicker"
    cause = _("flicker of the electronics and of what is sensed: bias instability")
    source = "IEEE Std 952-1997, annex C, bias instability"
    parameters = (
        Parameter("b", "rad/s", 0.1 * DEGREE_PER_HOUR, _("bias instability of each gyro")),
    )
    sizes = by_grade(DEGREE_PER_HOUR, 0.1, 0.5, 10, 20)
    sought_in = "noise"

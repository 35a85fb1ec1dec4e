"""A random walk of the biases of the gyros."""

from inertial.physics.effect import Effect, Parameter, by_grade
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, HOUR

UNIT = DEGREE_PER_HOUR / HOUR**0.5


class GyroRandomWalk(Effect):
    """The bias is the integral of white noise: its variance grows by K² t.

    It has no mean, so no columns, but a covariance: that of the biases at two times is K² times
    the time to the earlier one. Left out of the covariance it is taken for a drift or for
    g-sensitivity, according to the order of the positions.
    """

    name = "gyro_random_walk"
    cause = _("the bias wanders as the temperature, the light source or the electronics do")
    source = "IEEE Std 952-1997, annex C, rate random walk"
    parameters = (Parameter("k", "rad/s/√s", 0.1 * UNIT, _("rate random walk of each gyro")),)
    sizes = by_grade(UNIT, 0.02, 0.3, 3, 10)
    sought_in = "noise"

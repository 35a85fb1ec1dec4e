"""Thermal hysteresis: a bias that depends on which way the temperature came."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import without_clock, without_temperature
from inertial.physics.effect import OfEither, OfSensor, Reading, Scan, Truth, by_grade
from inertial.physics.motion import Motion
from inertial.sensors import PLURAL
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY

WIDTHS = (1.0, 2.0, 4.0, 8.0)  # K
MIN_RETURN = 5.0  # K, by which the temperature must go back on its way
ONE_WAY = _("The temperature goes one way only, so warming cannot be compared with cooling.")
CAUSE = _("the biases of the {sensors} are others after warming and after cooling")


class ThermalHysteresis(OfEither):
    """Reading += h (T − p(T)) / w: +h after long warming, −h after long cooling.

    p: the play operator of half width w, moved by T once it touches one of its sides. Told from a
    function of temperature by going through the same temperatures both ways, and from a drift in
    time by turning back more than once.
    """

    kind, letter = "thermal_hysteresis", "h"
    source = "Krasnosel'skii and Pokrovskii 1989, Systems with hysteresis, section 2"
    scan = Scan("half_width", "K", _("half of the change by which it turns over"))
    stays = _("it depends on which way the temperature came")
    gyro = OfSensor(
        _("half the difference of the bias of the {axis} gyro after warming and after cooling"),
        "rad/s",
        0.1 * DEGREE_PER_HOUR,
        by_grade(0.1 * DEGREE_PER_HOUR, 1, 1, 1, 1),
        CAUSE.format(sensors=PLURAL["gyro"]),
    )
    accel = OfSensor(
        _(
            "half the difference of the bias of the {axis} accelerometer after warming and after "
            "cooling"
        ),
        "m/s²",
        1e-5 * STANDARD_GRAVITY,
        by_grade(1e-5 * STANDARD_GRAVITY, 1, 1, 1, 1),
        CAUSE.format(sensors=PLURAL["accel"]),
    )
    thinkable = 1e4

    def blind(self, motion: Motion) -> str:
        reason = without_temperature(motion) or without_clock(motion)
        if reason:
            return reason
        course = motion.temperature[np.argsort(motion.time, kind="stable")]
        back = np.maximum.accumulate(course) - course, course - np.minimum.accumulate(course)
        return "" if min(each.max() for each in back) > MIN_RETURN else ONE_WAY

    def grid(self, motion: Motion) -> Array:
        return np.array(WIDTHS)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        if self.blind(motion):
            return reading
        change = np.outer(turned_over(motion, self.value(motion)), values)
        return reading.plus(self.sensor, change)


def turned_over(motion: Motion, width: float) -> Array:
    """(T − p(T)) / w of each stretch, (n,): from −1 to 1; p = T at the first of them."""
    at, place = np.unique(motion.time, return_inverse=True)
    course = np.bincount(place, motion.temperature) / np.bincount(place)
    play, before = np.empty(len(at)), course[0]
    for i, here in enumerate(course):
        before = play[i] = min(max(before, here - width), here + width)
    return np.asarray((course - play)[place] / width)

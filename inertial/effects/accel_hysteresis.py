"""An accelerometer that remembers on which side it was."""

from dataclasses import replace

import numpy as np

from inertial.physics.effect import Array, Effect, Parameter, Reading, Truth, by_grade
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY

MIN_REVERSAL = STANDARD_GRAVITY / 2  # m/s², of a force that reverses the hysteresis


def remembered(force: Array, order: Array, sides: Array) -> Array:
    """The sign of the last force beyond half of gravity along each axis, (n, 3), by `order`.

    0 before the first one. Between two manoeuvres the table may pass through any attitude: what
    was measured of that, `sides` (n, 3), is known at the start of a manoeuvre, or NaN.
    """
    sequence = np.argsort(order, kind="stable")
    signs = np.where(np.abs(force) > MIN_REVERSAL, np.sign(force), 0.0)[sequence]
    starts = np.diff(np.floor(order[sequence]), prepend=-1.0) != 0
    measured = np.where(starts[:, None], np.nan_to_num(sides[sequence]), 0.0)
    signs = np.where(signs != 0, signs, measured)
    place = np.where(signs != 0, np.arange(len(signs))[:, None], 0)
    last = np.maximum.accumulate(place, axis=0)
    result = np.zeros_like(signs)
    result[sequence] = np.take_along_axis(signs, last, axis=0)
    return result


class AccelHysteresis(Effect):
    """f̃_i += h_i s_i (1 − |f_i|/g), s_i = ±1 the side on which axis i was last.

    A loop that is widest where the axis is level and closed at ±g. Shown by an axis that comes
    to level from above and from below, in the order of the plan and by what the log has of the
    moves between. A level axis is also what the
    error of a set position moves, so the loop must exceed that.
    """

    name = "accel_hysteresis"
    cause = _("the suspension does not return quite to where it was before the load")
    source = "IEEE Std 528-2019, 'hysteresis error'"
    parameters = tuple(
        Parameter(
            f"h_{axis}",
            "m/s²",
            1e-5 * STANDARD_GRAVITY,
            _("half the loop of the {axis} axis", axis=axis),
        )
        for axis in "xyz"
    )
    stays = _("it depends on the forces before the reading, which the reading does not tell")
    sizes = by_grade(1e-6 * STANDARD_GRAVITY, 5, 20, 50, 500)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        side = remembered(truth.force, motion.visit, motion.sides)
        width = np.clip(1 - np.abs(truth.force) / STANDARD_GRAVITY, 0.0, 1.0)
        return replace(reading, accel=reading.accel + values * side * width)

"""A gyro whose bias keeps the sense of the last turn."""

import numpy as np

from inertial.arrays import Array
from inertial.effects.gyro_hysteresis import BREAK_AWAY
from inertial.physics.effect import Effect, Reading, Truth, by_grade, parameters_by_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR


def last_sense(rate: Array, order: Array, senses: Array) -> Array:
    """The sense of the last turn about each axis, ±1, by `order`, (n, 3), rad/s; 0 before one.

    A turn is what is faster than the break-away of a hysteresis. Between two manoeuvres the table
    may turn about any axis: `senses`, (n, 3), see `Motion`.
    """
    sequence = np.argsort(order, kind="stable")
    starts = np.diff(np.floor(order[sequence]), prepend=-1.0) != 0
    before = np.where(starts[:, None], np.nan_to_num(senses[sequence]), 0.0)
    turning = rate[sequence]
    changes = np.where(np.abs(turning) > BREAK_AWAY, np.sign(turning), before)
    rows = np.arange(len(changes))[:, None]
    latest = np.maximum.accumulate(np.where(changes != 0, rows, 0), axis=0)
    result = np.zeros_like(rate)
    result[sequence] = np.take_along_axis(changes, latest, axis=0)
    return result


class GyroBiasSense(Effect):
    """ω̃_i += b_i s_i, s_i = ±1 the sense of the last turn about axis i, of this one while it lasts.

    What the turn magnetises or strains stays so until one of the other sense. After turns it is a
    hysteresis; in them it has the other sign, which turns of one rate do not tell from a scale
    factor. Shown in the order of the plan, and by what the log has of the moves between.
    """

    name = "gyro_bias_sense"
    cause = _("the sensor or its read-out stays magnetised or strained by the last turn")
    source = "IEEE Std 528-2019, 'hysteresis error', of the other sense in a traverse"
    parameters = parameters_by_axis(
        "b",
        "rad/s",
        0.1 * DEGREE_PER_HOUR,
        _("further bias of the {axis} gyro after a forward turn"),
    )
    of_stillness = True
    stays = _("it depends on the turns before the reading, which the reading does not tell")
    sizes = by_grade(DEGREE_PER_HOUR, 0.05, 1, 10, 50)

    def added(self, truth: Truth, motion: Motion) -> Reading:
        senses = last_sense(truth.rate, motion.visit, motion.senses)
        gyro = senses[:, :, None] * np.eye(3)
        return Reading(gyro, np.zeros_like(gyro))

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        return reading.plus("gyro", self.added(truth, motion).gyro @ values)

"""A gyro that reads less while the rate rises than while it falls."""

from collections.abc import Iterator

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Reading, Truth, by_grade, parameters_by_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE, DEGREE_PER_HOUR

BREAK_AWAY = DEGREE  # rad/s, of a change of the rate: smaller ones leave the friction as it is


def course(rate: Array, order: Array, senses: Array) -> Array:
    """Whether the rate about each axis last rose, 1, or fell, −1, by `order`, (n, 3), rad/s.

    0 before it has changed. Between two manoeuvres the table may turn about any axis and comes to
    rest: `senses`, (n, 3), see `Motion`.
    """
    sequence = np.argsort(order, kind="stable")
    starts = np.diff(np.floor(order[sequence]), prepend=-1.0) != 0
    before = np.where(starts[:, None], np.nan_to_num(senses[sequence]), 0.0)
    result = np.zeros_like(rate)
    for i in range(3):
        result[sequence, i] = list(_followed(rate[sequence, i], before[:, i]))
    return result


def _followed(rates: Array, before: Array) -> Iterator[float]:
    """The friction after each of n rates, in units of its largest; 0 at first."""
    half = BREAK_AWAY / 2
    held = 0.0  # rad/s, rate about which the friction is zero
    for rate, sense in zip(rates.tolist(), before.tolist(), strict=True):
        held = sense * half if sense else held  # it fell to zero from rates of this sign
        held = min(max(held, rate - half), rate + half)
        yield (rate - held) / half


class GyroHysteresis(Effect):
    """ω̃_i −= h_i c_i, c_i = 1 since the rate about axis i last rose, −1 since it last fell.

    Coulomb's friction on what yields to the rate: the loop of a traverse of the range is 2 h wide.
    At rest it is h after a turn forwards and −h after one backwards, so the bias depends on the
    last turn. At a steady rate it is −h forwards, h backwards, as a scale factor in turns of one
    rate. Shown in the order of the plan, and by what the log has of the moves between.
    """

    name = "gyro_hysteresis"
    cause = _("friction in the suspension or the read-out holds on to the rate before")
    source = "IEEE Std 528-2019, 'hysteresis error'"
    parameters = parameters_by_axis(
        "h", "rad/s", 0.1 * DEGREE_PER_HOUR, _("half the width of the loop of the {axis} gyro")
    )
    of_stillness = True
    stays = _("it depends on the rates before the reading, which the reading does not tell")
    sizes = by_grade(DEGREE_PER_HOUR, 0.05, 1, 10, 50)

    def added(self, truth: Truth, motion: Motion) -> Reading:
        friction = course(truth.rate, motion.visit, motion.senses)
        gyro = -friction[:, :, None] * np.eye(3)
        return Reading(gyro, np.zeros_like(gyro))

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        return reading.plus("gyro", self.added(truth, motion).gyro @ values)

"""A gyro that does not feel small rates."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Reading, Scan, Truth, by_grade, known_earth
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE, DEGREE_PER_HOUR

MAX_WIDTH = 16  # °/h: the rate of the earth is 15
CANDIDATES = 8
# rad/s, of the table in a short mean just before or after it turns, as gyros measure it: their
# noise of some ten degrees per hour would take it out of the band
MAX_RATE_AT_REST = 0.02 * DEGREE


class GyroDeadBand(Effect):
    """ω̃_i −= l ω_i where |ω_i| < w, of one gyro i: in the band the share l of the rate is lost.

    All of it is lost for l = 1; the width w is scanned. Each gyro has a width of its own, so each
    is an effect of its own. The only rates so small are those of the earth at rest, so only bands
    up to 15 °/h are observable. A gyro senses something of a turn about another axis too,
    for it does not stand quite across it. Turns distinguish it from a scale factor.

    IEEE Std 528: within the dead band variations of the input give no detectable change of the
    output; the threshold is the least input that gives half of the expected output, so w where
    l > 1/2; the resolution is the least change of a larger input that does, which a dead band
    about zero does not touch: the counts limit it, see the detector `quantisation`.
    """

    cause = _("lock-in of counter-rotating waves, or a step of the converter, swallows small rates")
    source = "IEEE Std 528-2019, 'dead band'; IEEE Std 647-2006, lock-in of laser gyros"
    stays = _(
        "what the gyro does not feel is not in its reading, and noise hides whether a rate is small"
    )
    sizes = by_grade(1, 0.01, 0.01, 0.01, 1)
    thinkable = 1.0
    positive = True
    scan = Scan("width", "rad/s", _("largest rate that is lost"))

    def __init__(self, axis: str) -> None:
        self.axis = "xyz".index(axis)
        self.name = f"gyro_dead_band_{axis}"
        meaning = _("share of a small rate that the {axis} gyro loses", axis=axis)
        self.parameters = (Parameter(f"l_{axis}", "1", 0.1, meaning),)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        upward, level = known_earth(truth, motion)
        turns = np.abs(motion.rate) > MAX_RATE_AT_REST
        rate = motion.omega * turns[:, None] + upward + level
        own = rate[:, self.axis] + self._by_mounting(reading, truth, motion)
        lost = np.zeros_like(rate)
        lost[:, self.axis] = np.where(np.abs(own) < self.value(motion), values[0] * own, 0.0)
        return replace(reading, gyro=reading.gyro - lost)

    def _by_mounting(self, reading: Reading, truth: Truth, motion: Motion) -> Array:
        """What it reads beyond the rate along its axis, less its bias, (n,), rad/s."""
        beyond = reading.gyro[:, self.axis] - truth.rate[:, self.axis]
        still = motion.rate == 0
        return beyond - beyond[still].mean() if still.any() else np.zeros_like(beyond)

    def grid(self, motion: Motion) -> Array:
        return np.linspace(MAX_WIDTH / CANDIDATES, MAX_WIDTH, CANDIDATES) * DEGREE_PER_HOUR

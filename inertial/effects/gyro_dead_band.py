"""A gyro that does not feel small rates."""

from dataclasses import replace

import numpy as np

from inertial.physics.effect import (
    Array,
    Effect,
    Parameter,
    Reading,
    Scan,
    Truth,
    by_grade,
    known_earth,
)
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR

MAX_WIDTH = 16  # °/h: the rate of the earth is 15
CANDIDATES = 8


class GyroDeadBand(Effect):
    """ω̃_i −= l_i ω_i where |ω_i| < w: inside the band the share l of the rate is lost.

    All of it is lost for l = 1; the width w is scanned. The only rates so small are those of the
    earth at rest, so only bands up to 15 °/h are observable. Turns distinguish it from
    a scale factor.
    """

    name = "gyro_dead_band"
    cause = _("lock-in of counter-rotating waves, or a step of the converter, swallows small rates")
    source = "IEEE Std 528-2019, 'dead band'; IEEE Std 647-2006, lock-in of laser gyros"
    parameters = tuple(
        Parameter(
            f"l_{axis}", "1", 0.1, _("share of a small rate that the {axis} gyro loses", axis=axis)
        )
        for axis in "xyz"
    )
    stays = _(
        "what the gyro does not feel is not in its reading, and noise hides whether a rate is small"
    )
    sizes = by_grade(1, 0.01, 0.01, 0.01, 1)
    thinkable = 1.0
    scan = Scan("width", "rad/s", _("largest rate that is lost"))

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        upward, level = known_earth(truth, motion)
        rate = motion.omega + upward + level
        small = np.abs(rate) < self.value(motion)
        return replace(reading, gyro=reading.gyro - values * rate * small)

    def grid(self, motion: Motion) -> Array:
        return np.linspace(MAX_WIDTH / CANDIDATES, MAX_WIDTH, CANDIDATES) * DEGREE_PER_HOUR

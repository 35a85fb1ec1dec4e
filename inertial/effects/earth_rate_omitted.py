"""A log without the earth's rate."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, known_earth, usually
from inertial.physics.motion import Motion
from inertial.text.messages import _


class EarthRateOmitted(Effect):
    """ω −= s ω_earth: the share s of the earth's rate is missing from the readings.

    1 where an instrument, or whoever made the log, had taken the earth's rate out already, or
    where the log was made up without it.
    """

    name = "earth_rate_omitted"
    cause = _("the earth's rate was taken out of the log before, or never put in")
    source = "Titterton & Weston 2004, earth's rate in the local frame"
    parameters = (Parameter("s", "1", 1.0, _("share of the earth's rate that is missing")),)
    sizes = usually(1.0)
    thinkable = 1.0

    def level_rate_changes(self, up: float, level: float) -> Array:
        return np.array([-level])

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        upward, level = known_earth(truth, motion)
        return replace(truth, rate=truth.rate - values[0] * (upward + level))

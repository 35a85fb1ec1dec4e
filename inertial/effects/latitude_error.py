"""A latitude that is not that of the site."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Parameter, Truth, TurnedEarthRate, known_earth, usually
from inertial.physics.motion import Motion
from inertial.physics.site import EARTH_RATE
from inertial.text.messages import _
from inertial.text.units import DEGREE


class LatitudeError(TurnedEarthRate):
    """ω += Δφ (ω_e cosφ up − ω_e sinφ north): the upward part grows, the level part shrinks.

    Told from g-sensitivity, which also goes with up and down, by the level part alone, and that
    only where the heading of the table is known or the gyros tell it. The campaign's own sigma of
    the latitude holds.
    """

    name = "latitude_error"
    cause = _("the latitude was rounded, or of another place, so the earth's rate is wrong")
    source = "Titterton & Weston 2004, earth's rate in the local frame"
    parameters = (Parameter("dphi", "rad", 0.02 * DEGREE, _("true latitude less the known one")),)
    sizes = usually(0.02 * DEGREE)
    thinkable = 1000.0

    def level_rate_changes(self, up: float, level: float) -> Array:
        along, across = self._shares
        return np.array([along * level - across * up])

    def parts(self, truth: Truth, motion: Motion) -> tuple[Array, Array]:
        upward, level = known_earth(truth, motion)
        up_rate = np.sum(upward * motion.up, axis=1, keepdims=True)
        level_rate = np.sqrt(np.maximum(EARTH_RATE**2 - up_rate**2, 0.0))
        return upward + level, level_rate * motion.up - up_rate / level_rate * level

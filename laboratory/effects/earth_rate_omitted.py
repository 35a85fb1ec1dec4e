"""Gyros from which somebody took the rotation of the earth."""

from dataclasses import replace

from laboratory.effects.effect import ScalarEffect
from laboratory.site import Site


class EarthRateOmitted(ScalarEffect):
    """A share of the earth's rate is missing in what the gyros feel, as if it stood still.

    value: 1: all of it, 0: nothing.
    """

    KEY = "share"
    UNIT = 1.0

    def stands(self, site: Site) -> Site:
        return replace(site, spin=site.spin * (1 - self.value))

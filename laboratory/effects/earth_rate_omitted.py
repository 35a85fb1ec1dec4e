"""Earth rate removed from the readings of the gyros."""

from dataclasses import replace

from laboratory.effects.effect import ScalarEffect
from laboratory.site import Site


class EarthRateOmitted(ScalarEffect):
    """A fraction of the earth rate is missing in the readings of the gyros.

    value: fraction, 1: all of it.
    """

    KEY = "share"
    UNIT = 1.0

    def true_site(self, site: Site) -> Site:
        return replace(site, spin=site.spin * (1 - self.value))

"""Error of the stated azimuth of the zero mark."""

from dataclasses import replace

from laboratory.effects.effect import ScalarEffect
from laboratory.site import Site
from laboratory.units import DEGREE


class HeadingError(ScalarEffect):
    """Difference of the true azimuth of the zero mark, clockwise, from the stated value.

    value: rad.
    """

    KEY = "error_deg"
    UNIT = DEGREE

    def true_site(self, site: Site) -> Site:
        return replace(site, heading=None if site.heading is None else site.heading + self.value)

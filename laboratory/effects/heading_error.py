"""A zero mark of the table that points elsewhere."""

from dataclasses import replace

from laboratory.effects.effect import ScalarEffect
from laboratory.site import Site
from laboratory.units import DEGREE


class HeadingError(ScalarEffect):
    """The true azimuth of the zero mark is so much greater, clockwise, than the stated one.

    value: rad.
    """

    KEY = "error_deg"
    UNIT = DEGREE

    def stands(self, site: Site) -> Site:
        return replace(site, heading=None if site.heading is None else site.heading + self.value)

"""A laboratory that does not stand at its latitude."""

from dataclasses import replace

from laboratory.effects.effect import ScalarEffect
from laboratory.site import Site
from laboratory.units import DEGREE


class LatitudeError(ScalarEffect):
    """The true latitude is so much farther north than the stated one; gravity is as stated.

    value: rad.
    """

    KEY = "error_deg"
    UNIT = DEGREE

    def stands(self, site: Site) -> Site:
        return replace(site, latitude=site.latitude + self.value)

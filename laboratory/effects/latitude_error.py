"""Error of the stated latitude."""

from dataclasses import replace

from laboratory.effects.effect import ScalarEffect
from laboratory.site import Site
from laboratory.units import DEGREE


class LatitudeError(ScalarEffect):
    """Difference of the true latitude, north positive, from the stated value; gravity as stated.

    value: rad.
    """

    KEY = "error_deg"
    UNIT = DEGREE

    def true_site(self, site: Site) -> Site:
        return replace(site, latitude=site.latitude + self.value)

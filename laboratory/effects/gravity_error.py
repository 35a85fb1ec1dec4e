"""Error of the stated gravity."""

from dataclasses import replace

from laboratory.effects.effect import ScalarEffect
from laboratory.site import Site
from laboratory.units import MILLIGAL


class GravityError(ScalarEffect):
    """Difference of true gravity from the stated value.

    value: m/s².
    """

    KEY = "error_mgal"
    UNIT = MILLIGAL

    def true_site(self, site: Site) -> Site:
        return replace(site, gravity=site.gravity + self.value)

"""Gravity that is not what the laboratory takes it for."""

from dataclasses import replace

from laboratory.effects.effect import ScalarEffect
from laboratory.site import Site
from laboratory.units import MILLIGAL


class GravityError(ScalarEffect):
    """True gravity is so much greater than the stated one.

    value: m/s².
    """

    KEY = "error_mgal"
    UNIT = MILLIGAL

    def stands(self, site: Site) -> Site:
        return replace(site, gravity=site.gravity + self.value)

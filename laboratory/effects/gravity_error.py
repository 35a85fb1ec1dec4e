"""Gravity that is not what the laboratory takes it for."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from laboratory.effects.effect import Effect
from laboratory.site import Site
from laboratory.units import MILLIGAL


@dataclass(frozen=True)
class GravityError(Effect):
    """True gravity is so much greater than the stated one.

    error: m/s².
    """

    error: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["error_mgal"] * MILLIGAL)

    def stands(self, site: Site) -> Site:
        return replace(site, gravity=site.gravity + self.error)

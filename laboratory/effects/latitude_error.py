"""A laboratory that does not stand at its latitude."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from laboratory.effects.effect import Effect
from laboratory.site import Site
from laboratory.units import DEGREE


@dataclass(frozen=True)
class LatitudeError(Effect):
    """The true latitude is so much farther north than the stated one; gravity is as stated.

    error: rad.
    """

    error: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["error_deg"] * DEGREE)

    def stands(self, site: Site) -> Site:
        return replace(site, latitude=site.latitude + self.error)

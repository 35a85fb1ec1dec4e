"""A zero mark of the table that points elsewhere."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from laboratory.effects.effect import Effect
from laboratory.site import Site
from laboratory.units import DEGREE


@dataclass(frozen=True)
class HeadingError(Effect):
    """The true azimuth of the zero mark is so much greater, clockwise, than the stated one.

    error: rad.
    """

    error: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["error_deg"] * DEGREE)

    def stands(self, site: Site) -> Site:
        return replace(site, heading=None if site.heading is None else site.heading + self.error)

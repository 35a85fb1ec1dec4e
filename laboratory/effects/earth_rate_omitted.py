"""Gyros from which somebody took the rotation of the earth."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from laboratory.effects.effect import Effect
from laboratory.site import Site


@dataclass(frozen=True)
class EarthRateOmitted(Effect):
    """A share of the earth's rate is missing in what the gyros feel, as if it stood still.

    share: 1: all of it, 0: nothing.
    """

    share: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["share"])

    def stands(self, site: Site) -> Site:
        return replace(site, spin=site.spin * (1 - self.share))

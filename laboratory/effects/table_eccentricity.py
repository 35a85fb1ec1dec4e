"""Eccentricity of the angle encoder of the table."""

from collections.abc import Mapping
from typing import Any, ClassVar, Self

from laboratory.effects.periodic_angle import PeriodicAngle
from laboratory.harmonic import Harmonic
from laboratory.units import ARCSECOND


class TableEccentricity(PeriodicAngle):
    """ψ = s sin θ + c (cos θ − 1), the harmonic of order 1: zero after a whole turn."""

    of_scale: ClassVar[bool] = True

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        sine, cosine = parameters["sin_arcsec"] * ARCSECOND, parameters["cos_arcsec"] * ARCSECOND
        return cls(Harmonic(1.0, cosine, sine))

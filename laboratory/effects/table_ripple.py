"""Ripple of the table angle, from tooth to tooth of its gear."""

from collections.abc import Mapping
from math import cos, sin
from typing import Any, Self

from laboratory.effects.periodic_angle import PeriodicAngle
from laboratory.harmonic import Harmonic
from laboratory.units import ARCSECOND, DEGREE


class TableRipple(PeriodicAngle):
    """ψ = A (sin(nθ + φ) − sin φ), the harmonic of order n > 0, whole or not.

    Where a turn does not close, the next manoeuvre starts from its set position all the same.
    """

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        size = parameters["amplitude_arcsec"] * ARCSECOND
        phase = parameters.get("phase_deg", 0.0) * DEGREE
        return cls(Harmonic(parameters["order"], size * sin(phase), size * cos(phase)))

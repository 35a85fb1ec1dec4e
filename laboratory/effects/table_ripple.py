"""Ripple of the table angle, from tooth to tooth of its gear."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, sin
from typing import Any, Self

from laboratory.effects.periodic_angle import PeriodicAngle
from laboratory.harmonic import Harmonic
from laboratory.motion import Turning
from laboratory.units import ARCSECOND, DEGREE


@dataclass(frozen=True)
class TableRipple(PeriodicAngle):
    """ψ = A (r/r₀)^p (sin(nθ + φ) − sin φ), the harmonic of order n > 0, whole or not.

    r: the steady rate of the turn. An error of the angle has p = 0; a torque that the drive answers
    with the same rate error at any rate has p = −1; one that the table's inertia smooths, −2. Where
    a turn does not close, the next manoeuvre starts from its set position all the same.
    """

    rate_power: float = 0.0
    reference_rate: float = 1.0  # r₀, rad/s

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        size = parameters["amplitude_arcsec"] * ARCSECOND
        phase = parameters.get("phase_deg", 0.0) * DEGREE
        return cls(
            Harmonic(parameters["order"], size * sin(phase), size * cos(phase)),
            parameters.get("rate_power", 0.0),
            parameters.get("at_rate_deg_s", 10.0) * DEGREE,
        )

    def error_at(self, table: Turning) -> Harmonic:
        share = (abs(table.steady_rate) / self.reference_rate) ** self.rate_power
        return replace(self.error, cosine=share * self.error.cosine, sine=share * self.error.sine)

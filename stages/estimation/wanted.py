"""How long the rests must last for a bias of a wanted sigma, by S0's formulas.

S0 (5-1), (5-2) ask for T ≥ (3 N/b)² with a bias b that is not known yet. What a laboratory wants is
a sigma: of the means by which a formula makes the bias,

    σ² = a / T + floor²,   T = a / (σ² − floor²),

where a is what white noise does and the floor what no time averages out: tilts of the positions,
gravity, the azimuth.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Wanted:
    """The sigma of a bias by rests of so many seconds each, and its floor; SI."""

    sigma: float
    floor: float
    seconds: float

    def row(self, wanted: float) -> dict[str, Any]:
        """The time for a `wanted` sigma; null where the floor is too high for any."""
        noise = (self.sigma**2 - self.floor**2) * self.seconds
        room = wanted**2 - self.floor**2
        return {
            "seconds": self.seconds,
            "sigma": self.sigma,
            "floor": self.floor,
            "random_walk": float(np.sqrt(max(noise, 0.0))),
            "wanted": wanted,
            "wanted_seconds": noise / room if room > 0 else None,
        }

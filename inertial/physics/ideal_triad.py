"""What ideal sensors read on the earth: at rest, in free fall, under way.

Axes along the local level frame, north, east, down (NED): forward north, right east. The triad
keeps them there, so that it turns with the earth and with the local level (Titterton & Weston
2004, 3.7; Savage 2000):

    rate   ω = ω_ie + ω_en,   ω_ie = ω_e (cos φ, 0, −sin φ)
                              ω_en = (v_E / (N + h), −v_N / (M + h), −v_E tan φ / (N + h))
    force  f = a − g,         with a = dv/dt + (2 ω_ie + ω_en) × v;  at a steady speed dv/dt = 0

g is normal gravity, straight down: its north component at height, 8·10⁻⁹ h sin 2φ m/s² with h in m,
is left out. In free fall a = g.
"""

from dataclasses import dataclass
from math import cos, sin, tan

import numpy as np

from inertial.arrays import Array
from inertial.physics.motion import cross
from inertial.physics.site import EARTH_RATE, normal_gravity, radii


@dataclass(frozen=True)
class IdealReading:
    """Angular rate, rad/s, and specific force, m/s², (3,) each, along north, east, down."""

    rate: Array
    force: Array

    @property
    def in_enu(self) -> "IdealReading":
        """The same along east, north, up."""
        return IdealReading(*(each[[1, 0, 2]] * (1, 1, -1) for each in (self.rate, self.force)))


def at_steady_speed(
    latitude: float, height: float, velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> IdealReading:
    """At `latitude` (rad) and `height` (m), with a steady velocity (m/s) to north, east, down.

    At a pole there is neither north nor east, so there it holds at rest only.
    """
    meridian, across = radii(latitude)
    north, east, _ = velocity
    earth = EARTH_RATE * np.array([cos(latitude), 0.0, -sin(latitude)])
    over = east / (across + height)
    transport = np.array([over, -north / (meridian + height), -over * tan(latitude)])
    down = np.array([0.0, 0.0, normal_gravity(latitude, height)])
    acceleration = cross(2 * earth + transport, np.array(velocity))
    return IdealReading(earth + transport, acceleration - down)


def in_free_fall(latitude: float) -> IdealReading:
    """Falling freely without turning against the earth, at `latitude` (rad)."""
    return IdealReading(at_steady_speed(latitude, 0.0).rate, np.zeros(3))

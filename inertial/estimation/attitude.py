"""Attitude integrated from angular rates, with the coning correction."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from inertial.physics.vectors import cross

# ---- An attitude carried on by gyros: their rates summed as rotations, which do not commute.
#
#     R(t + τ) = R(t) exp([φ]×),   φ = θ + (θ₋ × θ + θ × θ₊) / 24
#
# θ is the integral of the rate over one short stretch, θ₋ and θ₊ over those beside it. The second
# term is for an axis that itself goes round (coning; Bortz 1971, Miller 1983) and is exact for a
# rate that changes evenly. By hand, with swings of up to 3 Hz and 270 °/s for 3 s, 100 readings a
# second leave an error of 1·10⁻⁶ rad with it and 3·10⁻⁴ rad without; where they are momentary,
# and no means over their stretch, 1·10⁻⁴ rad. Before the first stretch and behind the last one
# there is rest.

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Carried:
    """How the body turned, in k short stretches.

    `middles`: (k, 3, 3), from body axes at the start to those in the middle of each stretch, for
    directions that stand still; `whole`: (3, 3), to those at the end.
    """

    middles: Array
    whole: Array

    @property
    def to_the_end(self) -> Array:
        """From body axes in the middle of each stretch to those at the end, (k, 3, 3)."""
        return np.asarray(self.whole @ np.swapaxes(self.middles, 1, 2))


def carried(rates: Array, seconds: Array) -> Carried:
    """Sum mean rates of the body, (k, 3), rad/s, each over its own time, (k,), s."""
    steps = coned(rates * seconds[:, None])
    # Body axes at the end of each stretch as those at the start see them; a direction that stands
    # still is seen the other way about.
    ends = running_product(Rotation.from_rotvec(steps).as_matrix())
    middles = ends @ Rotation.from_rotvec(-steps / 2).as_matrix()
    return Carried(np.swapaxes(middles, 1, 2), ends[-1].T)


def coned(angles: Array) -> Array:
    """The rotation vector of each stretch from the integrals of the rate, (k, 3), rad."""
    pairs = cross(angles[:-1], angles[1:]) / 24
    result = angles.copy()
    result[1:] += pairs
    result[:-1] += pairs
    return result


def running_product(steps: Array) -> Array:
    """E₁, E₁E₂, E₁E₂E₃, … of k matrices, (k, 3, 3), in log₂ k products of all of them."""
    total, shift = steps, 1
    while shift < len(steps):
        total = np.concatenate([total[:shift], total[:-shift] @ total[shift:]])
        shift *= 2
    return total


# ---- Directions after many turns at once.


def all_turned(directions: Array, abouts: Array, angles: Array) -> Array:
    """`turned` of as many directions as axes and angles, (n, 3); angles (n,), rad."""
    turn = Rotation.from_rotvec(-np.asarray(angles)[:, None] * abouts)
    return np.asarray(turn.apply(directions), dtype=np.float64)

"""Means with an axis up and down: what keeps its sign, and what changes it.

    even = (up + down) / 2,   odd = (up − down) / 2 − input

After compensation both should be zero. The odd part is a scale factor error; the even part acts
like a bias, but one that the six-position formula has not taken out: a response to the square or
to the size of the force, or a drift between the positions.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.probability import chi_squared_beyond

Array = NDArray[np.float64]


@dataclass(frozen=True)
class EvenAndOdd:
    """Both parts of each axis, unit of the means, with their common sigma, (k,) each."""

    even: Array
    odd: Array
    sigma: Array

    def p_value(self, part: Array) -> float:
        """Chance of so much in all axes together, of `even` or `odd`, by the sigmas alone."""
        return float(chi_squared_beyond(np.sum((part / self.sigma) ** 2), len(part)))


def even_and_odd(up: Array, down: Array, size: float, sigma: tuple[Array, Array]) -> EvenAndOdd:
    """Split pairs of means.

    Parameters
    ----------
    up, down : (k,), means with the axis up and down
    size : the input, such as g; gravity's own error is in the odd part of all axes alike
    sigma : of `up` and of `down`, (k,) each
    """
    return EvenAndOdd(
        even=(up + down) / 2,
        odd=(up - down) / 2 - size,
        sigma=np.asarray(np.hypot(*sigma) / 2),
    )


def square_behind(even: Array, size: float) -> Array:
    """The response to the square of the input, K₂, that would leave such even parts, (k,).

    The six-position formula takes the mean of all six positions for the bias. Of K₂ f², which only
    two of them hold, that is a third, and two thirds stay: K₂ = 3/2 · even / size².
    """
    return np.asarray(1.5 * even / size**2)

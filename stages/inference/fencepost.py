"""Scale factors that are all off by one sample: N + 1 samples summed for N intervals.

    (1 + s) / (1 + s_reference) − 1 = m / N,   m a whole number, the same for all axes

S0's table 5-5 is such a case (design study, 0 and T11): its windows of 180° at 10 °/s and 100 Hz
last 1800 samples, and its scale factors exceed those of the whole turns by 581, 555 and 560 ppm,
where 1/1800 is 555.6 ppm. Where N differs between the axes the form is its own; where it does not,
that m comes out whole is what tells it from another common cause.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.inference.agreement import chance_of
from stages.inference.shared_cause import SharedCause, shared_cause
from stages.inference.tails import chi_squared_beyond

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Fencepost:
    """How many samples too many were summed, as a number that may be broken, and the nearest whole.

    `ratios`: (k,), by what the scale factors exceed the reference; `cause`: its `amount` is m;
    `whole_chi_squared`: of k degrees, with the nearest whole number.
    """

    ratios: Array
    cause: SharedCause
    whole: int
    whole_chi_squared: float

    @property
    def p_whole(self) -> float:
        """Chance of such scale factors if just so many samples too many were summed."""
        return float(chi_squared_beyond(self.whole_chi_squared, self.cause.k))

    def told(self, level: float) -> bool:
        """Whether it is a fencepost.

        Without it the ratios are not chance, with it they are, one by one and in common; and the
        sigma of m is small enough that not any number would be near a whole one.
        """
        sharp = self.cause.sigma < 0.1
        off = chance_of((self.cause.amount - self.whole) / self.cause.sigma)
        chance = min(self.p_whole, off)
        return sharp and self.whole != 0 and self.cause.p_without < level <= chance


def fencepost(scales: Array, reference: Array, sigma: Array, samples: Array) -> Fencepost:
    """Compare scale factors by windows of N samples with others of the same axes.

    Parameters
    ----------
    scales, reference : (k,), scale factor errors
    sigma : (k,), of their differences, ripple that the window cuts included
    samples : (k,), N, how many intervals the window should have had
    """
    ratios = (1 + scales) / (1 + reference) - 1
    cause = shared_cause(ratios, sigma, 1 / samples)
    whole = round(cause.amount)
    left = (ratios - whole / samples) / sigma
    return Fencepost(np.asarray(ratios), cause, whole, float(left @ left))

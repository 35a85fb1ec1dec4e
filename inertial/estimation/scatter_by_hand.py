"""What rests and motions by hand differ by beyond noise.

Rests differ by a rate, such as the g-sensitivity of a gyro, or by an angle: the IMU sways in the
hand, so its mean rate is the smaller the longer it rests. So does a motion; and it may not begin
and end exactly where the accelerometers determined the directions: an angle besides, its swing.
Each is a variance component of the equations, by restricted likelihood. A rest, or a motion, that
is far off all others was something else, such as a slip, a shock, or vibration: it is left out.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.estimation.least_squares import Estimate
from inertial.estimation.probability import f_sf
from inertial.estimation.scatter_and_random_walk import ScatterFit, with_scatter

RATE_RANGE = (1e-8, 0.1)  # rad/s
SWING_RANGE = (1e-6, 0.3)  # rad
ROUNDS = 3  # of one after the other
SETTLED = 0.02  # relative change of a scatter
FALSE_OMISSIONS = 1e-3  # of a session in which all are alike
FITTED = (3, 9)  # parameters that rests, and motions, determine: biases, and M


@dataclass(frozen=True)
class Scatter:
    """Of rests, rad/s, where the IMU `sways` for a rest of the usual length; `swing`, rad."""

    rate: float = 0.0
    sways: bool = False
    swing: float = 0.0

    def of_rate(self, seconds: float, usual: float) -> float:
        """Of the mean rates of a rest or a motion of so many seconds, rad/s."""
        return self.rate * usual / seconds if self.sways else self.rate


def likeliest(
    fit: Callable[[Scatter], Estimate], noise_degrees: float
) -> tuple[ScatterFit, Scatter]:
    """The scatters of largest restricted likelihood; `fit`: the estimate as a function of them."""
    found = Scatter()
    p_value = fit(found).p_value(noise_degrees)
    fitted: ScatterFit | None = None
    for _round in range(ROUNDS):
        swung = with_scatter(_swinging(fit, found), SWING_RANGE, noise_degrees)
        found = replace(found, swing=swung.scatter)
        fits = [
            (with_scatter(_resting(fit, found, sways), RATE_RANGE, noise_degrees), sways)
            for sways in (False, True)
        ]
        before = fitted
        fitted, sways = min(fits, key=lambda each: each[0].estimate.deviance)
        found = replace(found, rate=fitted.scatter, sways=sways)
        if before and abs(before.scatter - fitted.scatter) <= SETTLED * fitted.scatter:
            break
    assert fitted is not None  # there is a round
    return replace(fitted, p_value=p_value), found


def _swinging(fit: Callable[[Scatter], Estimate], about: Scatter) -> Callable[[float], Estimate]:
    return lambda size: fit(replace(about, swing=size))


def _resting(
    fit: Callable[[Scatter], Estimate], about: Scatter, sways: bool
) -> Callable[[float], Estimate]:
    return lambda size: fit(replace(about, rate=size, sways=sways))


def contradicting(
    residuals: Sequence[Array], stops: Sequence[int], firsts: Sequence[int]
) -> list[int]:
    """The places of rests and motions that contradict all others, the worst first.

    The share of one in the sum of squares of its kind follows the F distribution; without those
    that are too large the next is compared with the others. Of two beside each other the worse one
    alone, for its error is in both.

    Parameters
    ----------
    residuals : in units of their sigma, of the rests `stops`, by number, and of the motions from
        the rests `firsts` to the next
    """
    rests = len(stops)
    found: list[tuple[float, int]] = []
    for fitted, first, some in zip(
        FITTED, (0, rests), (residuals[:rests], residuals[rests:]), strict=True
    ):
        squares = np.array([float(each @ each) for each in some])
        counts = np.array([len(each) for each in some])
        left = int(counts.sum()) - fitted, float(squares.sum())
        for worst in np.argsort(-squares).tolist():
            degrees, own = left[0], int(counts[worst])
            if degrees <= 2 * fitted:
                break
            others = max(left[1] - float(squares[worst]), np.finfo(float).tiny)
            ratio = float(squares[worst]) / own / others * (degrees - own)
            p_value = float(f_sf(ratio, own, degrees - own)) * len(squares)
            if p_value >= FALSE_OMISSIONS:
                break
            found.append((p_value, first + worst))
            left = degrees - own, others
    ends = [{stop} for stop in stops] + [{first, first + 1} for first in firsts]
    apart, touched = list[int](), set[int]()
    for _p_value, place in sorted(found):
        if not ends[place] & touched:
            apart.append(place)
        touched |= {stop + k for stop in ends[place] for k in (-1, 0, 1)}
    return apart

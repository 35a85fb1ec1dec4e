"""Bias and scale factor of a gyro from windows of two rate segments."""

from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Integers
from inertial.estimation.consistency import CommonCause, common_cause, normal_p_value
from inertial.estimation.probability import chi2_sf


@dataclass(frozen=True)
class Window:
    """m windows of a turn forward and a turn backward.

    `first`, `after`: (m,), the first edge, and the edge after the last sample. A window of N
    intervals lies between N + 1 edges and holds N samples: its angle at a set rate ω is
    N · step · ω. A sum over N + 1 samples gives a scale factor that is too large by 1/N (design
    study, T11). `seconds`, `forward`, `backward`: (m,), s and rad, duration and angle of the
    table; forward positive, backward negative.
    """

    first: Integers
    after: Integers
    seconds: Array
    forward: Array
    backward: Array


def at_set_rate(first: Integers, samples: Integers | int, step: float, rate: float) -> Window:
    """Windows of N samples, whose angle is that of the set rate (rad/s) in N steps."""
    after = first + samples
    seconds = np.asarray((after - first) * step, dtype=np.float64)
    return Window(first, after, seconds, abs(rate) * seconds, -abs(rate) * seconds)


def by_angles(window: Window, forward: Array, backward: Array) -> Window:
    """The same windows, with their angles by those of the table at every edge, (n + 1,) each."""
    plus, minus = (angle[window.after] - angle[window.first] for angle in (forward, backward))
    return Window(window.first, window.after, window.seconds, plus, minus)


def edges_of(increments: Array) -> Array:
    """The angle at the edges of n increments, from 0 on, (n + 1,)."""
    return np.append(0.0, np.cumsum(increments))


def scale_and_bias(
    window: Window, forward: Array, backward: Array, earth: float
) -> tuple[Array, Array]:
    """Scale factor errors, and biases in rad/s, (m,) each.

        b = (α̃₁ + α̃₂ − (1 + s)(α₁ + α₂)) / (2T) − ω_e,   s = (α̃₁ − α̃₂) / (α₁ − α₂) − 1

    S0 (3-9), (3-10), where α₁ = −α₂.

    Parameters
    ----------
    forward, backward : (n + 1,), rad, the summed angle of the gyro at the edges of its samples
    earth : rad/s, upward earth rate along the gyro
    """
    plus, minus = (summed[window.after] - summed[window.first] for summed in (forward, backward))
    scale = (plus - minus) / (window.forward - window.backward) - 1
    residual = plus + minus - (1 + scale) * (window.forward + window.backward)
    return np.asarray(scale), np.asarray(residual / (2 * window.seconds) - earth)


def noise_of(
    window: Window, densities: tuple[float, float], each: Array | float = 0.0
) -> tuple[Array, Array]:
    """Sigma of scale factor errors and biases, (m,) each.

    Parameters
    ----------
    densities : rad/√s, white noise of the gyro in the turn forward and backward
    each : rad, further independent errors of either angle: a cut ripple, a horizontal rate
    """
    variance = (densities[0] ** 2 + densities[1] ** 2) * window.seconds + 2 * np.square(each)
    size = np.sqrt(variance)
    return np.asarray(size / (window.forward - window.backward)), size / (2 * window.seconds)


MAX_FENCEPOST_SIGMA = 0.1  # of m: else any number would be near a whole one


@dataclass(frozen=True)
class Fencepost:
    """Scale factors that are all off by the same number m of samples: N + 1 summed for N intervals.

        (1 + s) / (1 + s_reference) − 1 = m / N,   m a whole number, the same for all axes

    S0's table 5-5 is such a case (design study, 0 and T11): its windows of 180° at 10 °/s and 100
    Hz last 1800 samples, and its scale factors exceed those of the whole turns by 581, 555 and 560
    ppm, where 1/1800 is 555.6 ppm. Where N differs between the axes the pattern is characteristic;
    where it does not, only that m is whole distinguishes it from another common cause.

    `ratios`: (k,), by which the scale factors exceed the reference; `cause`: its `amount` is m;
    `whole`: the nearest whole number; `whole_chi_squared`: of k degrees, with that.
    """

    ratios: Array
    cause: CommonCause
    whole: int
    whole_chi_squared: float

    @property
    def p_whole(self) -> float:
        """p-value of the scale factors with that whole number."""
        return float(chi2_sf(self.whole_chi_squared, self.cause.k))

    def is_detected(self, level: float) -> bool:
        """Whether it is a fencepost error at significance `level`.

        Without it the ratios differ from zero, with it they do not, one by one and in common; and
        the sigma of m is small.
        """
        sharp = self.cause.sigma < MAX_FENCEPOST_SIGMA
        off = normal_p_value((self.cause.amount - self.whole) / self.cause.sigma)
        chance = min(self.p_whole, off)
        return sharp and self.whole != 0 and self.cause.p_without < level <= chance


def fencepost(scales: Array, reference: Array, sigma: Array, samples: Array) -> Fencepost:
    """Compare scale factors by windows of N samples with others of the same axes.

    Parameters
    ----------
    scales, reference : (k,), scale factor errors
    sigma : (k,), of their differences, cut ripple included
    samples : (k,), N, the intended number of intervals
    """
    ratios = (1 + scales) / (1 + reference) - 1
    cause = common_cause(ratios, sigma, 1 / samples)
    whole = round(cause.amount)
    residual = (ratios - whole / samples) / sigma
    return Fencepost(np.asarray(ratios), cause, whole, float(residual @ residual))

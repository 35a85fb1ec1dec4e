"""Noise at rest behind a low pass: what the filter leaves of each frequency, by the noise itself.

    S(f) = |H(f)|² (N² + B²/2πf + K²/(2πf)²) + Q² 4 sin²(πfΔ)/Δ

|H|² is that of a Butterworth filter, 1/(1 + (f/f_c)^2n) (n = 1: of first order), or that of a
moving average over T, sinc²(fT) with f_c = 0.443/T. Quantisation comes after it. Which of them,
and f_c, are where the likelihood of all frequencies is largest, down to where the density is
3 %: farther down every filter is built another way.

A filter leaves next to nothing above its band, and acts in all rests alike. What moves the case
leaves the white noise of the sensor above, or contradicts the other rests. So in the highest octave
there is what the shape leaves, a thousandth where the filter is built another way, and the rounding
of the readings, which comes after it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.estimation.multiresolution import Bins, Lowest
from inertial.estimation.noise_likelihood import Fit, Likelihood
from inertial.estimation.noise_model import STOCHASTIC

AVERAGE = 0  # in place of an order: a moving average
ORDERS = (1, 2, 3, 4, AVERAGE)
HALF_OF_AVERAGE = 0.44295  # f T, where sinc² is a half
FALLEN = 0.03  # of the density at the lowest frequencies, down to which a shape is fitted
FAINT = 0.01  # of the same, that a filter leaves of the highest octave
STOP_BAND = 1e-3  # of the same, that a filter of another shape leaves there
MOST_OF_SHAPE = 2.0  # times what the shape leaves there
CARRIED = 4.0  # times the density of rounding at the highest frequencies, where counts carry over
LOW_BINS = 16  # that tell this density
SMOOTHED = 8  # bins in a mean that shows how far the density has fallen
CORNERS = 16  # of each kind that are tried
REFINED = 3  # times that the best is sought between its neighbours
CERTAIN = 30.0  # of the deviance, less than which a filter is as likely as none
BESIDE = 1.05  # ratio of a corner to the best, by which its sigma is seen
WHITE = STOCHASTIC.index("white_noise")
THROUGH = np.array([name != "quantisation" for name in STOCHASTIC])


@dataclass(frozen=True)
class LowPass:
    """`corner`: Hz, −3 dB; `order`: of a Butterworth filter, or AVERAGE."""

    corner: float
    order: int

    def power(self, frequency: Array) -> Array:
        """|H|² at some frequencies, Hz."""
        share = frequency / self.corner
        if self.order == AVERAGE:
            return np.asarray(np.sinc(HALF_OF_AVERAGE * share) ** 2)
        return np.asarray(1 / (1 + share ** (2 * self.order)))

    @property
    def delay(self) -> float:
        """Of slow changes, s."""
        if self.order == AVERAGE:
            return HALF_OF_AVERAGE / self.corner / 2
        poles = np.sin(np.pi * (2 * np.arange(self.order) + 1) / (2 * self.order))
        return float(poles.sum() / (2 * np.pi * self.corner))

    def of_bins(self, bins: Bins) -> Bins:
        """The bins, what is expected in them behind the filter."""
        power = np.where(THROUGH[:, None], self.power(bins.frequency), 1.0)
        return replace(bins, shapes=bins.shapes * power)

    def of_lowest(self, lowest: Lowest, highest: float) -> Lowest | None:
        """The same of the lowest coefficients, those up to a frequency, Hz; None of none."""
        count = int(min(highest / lowest.spacing, len(lowest.ramp)))
        amplitude = np.sqrt(self.power(lowest.spacing * np.arange(1.0, count + 1)))
        power = np.where(THROUGH[:, None, None], np.outer(amplitude, amplitude), 1.0)
        used = replace(
            lowest,
            shapes=lowest.shapes[:, :count, :count] * power,
            ramp=lowest.ramp[:count],
            sums=lowest.sums[:, :count],
            products=lowest.products[:, :count, :count],
        )
        return used if count else None


@dataclass(frozen=True, eq=False)
class Passed:
    """A low pass, the bins and lowest coefficients behind it, and which bins it describes.

    `spread`: relative sigma of the white noise by that of the corner, and by the kind of filter.
    """

    low_pass: LowPass
    bins: Bins
    lowest: list[Lowest]
    within: Booleans
    spread: float


def likeliest(
    bins: Bins, lowest: Sequence[Lowest], channel: int, lines: Booleans, rounding: float = 0.0
) -> Passed | None:
    """The low pass of a channel; None where the density does not fall to next to nothing.

    `lines`: (b,), bins with oscillations; `rounding`: density of that of the readings.
    """
    within = _passed(bins, channel, lines)
    if within is None:
        return None
    top, least = float(bins.frequency[within].max()), min(each.spacing for each in lowest)
    found: dict[LowPass, Fit] = {}

    def through(low_pass: LowPass) -> tuple[Bins, list[Lowest]]:
        own = [low_pass.of_lowest(each, top) for each in lowest]
        return low_pass.of_bins(bins), [each for each in own if each is not None]

    def deviance(low_pass: LowPass) -> float:
        if low_pass not in found:
            likelihood = Likelihood.of(*through(low_pass), channel, within & ~lines)
            found[low_pass] = likelihood.maximum(range(len(STOCHASTIC)), ramp=False)
        return found[low_pass].deviance

    for order in ORDERS:
        own = np.geomspace(least, top, CORNERS)
        for _ in range(REFINED):
            at = int(np.argmin([deviance(LowPass(float(corner), order)) for corner in own]))
            own = np.geomspace(own[max(at - 1, 0)], own[min(at + 1, len(own) - 1)], 7)
    best = min(found, key=deviance)
    if deviance(LowPass(np.inf, 1)) < deviance(best) + CERTAIN:
        return None  # as well without, by a random walk
    level, highest = _level(bins, channel, lines), _highest(bins, lines)
    left = MOST_OF_SHAPE * float(best.power(bins.frequency[highest]).mean()) + STOP_BAND
    if bins.density[highest, channel].mean() > left * level + CARRIED * rounding:
        return None  # the sensor's own white noise, which no filter lets pass
    beside = [replace(best, corner=best.corner * share) for share in (1 / BESIDE, BESIDE)]
    rise = sum(map(deviance, beside)) - 2 * deviance(best)
    whites = [float(found[each].variances[WHITE]) for each in beside]
    if not all(whites) or rise <= 0:
        return None
    # The deviance rises by the square of the change over its sigma.
    spread = abs(np.log(whites[1] / whites[0])) / 4 * np.sqrt(2 / rise)
    return Passed(best, *through(best), within, float(spread))


def _passed(bins: Bins, channel: int, lines: Booleans) -> Booleans | None:
    """The bins below where the density has fallen, (b,); None where it does not fall so far."""
    density, clear = bins.density[:, channel], np.flatnonzero(~lines)
    level, highest = _level(bins, channel, lines), density[_highest(bins, lines)]
    if len(clear) < LOW_BINS or not len(highest) or highest.mean() > FAINT * level:
        return None
    degrees = np.convolve(bins.degrees[clear], np.ones(SMOOTHED), "valid")
    powers = np.convolve((bins.degrees * density)[clear], np.ones(SMOOTHED), "valid")
    fallen = powers < FALLEN * level * degrees
    within = np.arange(len(density)) < clear[np.argmax(fallen)]
    return within if within.sum() >= LOW_BINS else None


def _level(bins: Bins, channel: int, lines: Booleans) -> float:
    """The density at the lowest frequencies."""
    return float(np.median(bins.density[~lines, channel][:LOW_BINS]))


def _highest(bins: Bins, lines: Booleans) -> Booleans:
    """The bins of the highest octave, (b,)."""
    return np.asarray(~lines & (bins.frequency > bins.frequency.max() / 2))

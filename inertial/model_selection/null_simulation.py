"""Simulated null distributions of the statistics in this campaign, and the power of a search."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dpstrf
from scipy.optimize import brentq
from scipy.special import gammaln

from inertial.arrays import Array
from inertial.estimation.probability import (
    chi2_isf,
    chi2_sf,
    f_isf,
    f_sf,
    ncx2_sf,
)
from inertial.model_selection.evidence import SearchedEffect
from inertial.model_selection.search import Candidates

# ---- The distribution of the statistics under noise alone in this campaign, by simulation.
#
# Where no effect acts, the right-hand side of all candidates is b ~ N(0, F): that is drawn some
# thousand times. This gives the distribution of the largest drop among the values of each scan,
# and that of the smallest p-value among all effects, which sets the level of naming.


DRAWS = 5000
TAIL_SHARE = 0.1  # of the draws, the largest, from which the tail is extrapolated
LEVEL_RATIO = 3.0  # of the level at which the draws are counted to the accepted level
NO_INFORMATION = 1e-9  # of a column, left of it once others are known: rounding


@dataclass(frozen=True)
class Tail:
    """Distribution of the largest of several chi-squared variables of the same degrees.

    sf(x) + v x^((r−1)/2) e^(−x/2), the bound of Davies (1987) for a smooth scan, at most
    n·sf(x) for n values; v from the draws.
    """

    degrees: int
    values: int
    crossings: float

    def __call__(self, x: Array | float) -> Array:
        """Probability of a larger drop, after the search over the values of the scan."""
        alone = chi2_sf(x, self.degrees)
        searched = alone + self.crossings * _density(x, self.degrees)
        return np.asarray(np.minimum(np.minimum(searched, self.values * alone), 1.0))

    def trials(self, x: float) -> float:
        """The number of independent values that would reach such a drop as often as the scan."""
        alone = float(chi2_sf(x, self.degrees))
        return float(self(x)) / alone if alone > 0 else float(self.values)

    def bound(self, chance: float) -> float:
        """The drop that noise exceeds with this probability."""
        low = float(chi2_isf(chance, self.degrees))
        high = float(chi2_isf(chance / self.values, self.degrees))

        def above(x: float) -> float:
            return float(self(x)) - chance

        # Where the values of the scan are independent trials the two agree but for rounding.
        if above(low) <= 0:
            return low
        return high if above(high) >= 0 else float(brentq(above, low, high))


def _density(x: Array | float, degrees: int) -> Array:
    """x^((r−1)/2) e^(−x/2) / (2^(r/2) Γ(r/2))."""
    half = degrees / 2
    safe = np.clip(x, np.finfo(float).tiny, 1e5)  # beyond it is 0
    logarithm = (half - 0.5) * np.log(safe) - safe / 2 - half * np.log(2) - gammaln(half)
    return np.asarray(np.exp(logarithm))


def tail(degrees: int, values: int, largest: Array) -> Tail:
    """The distribution of the largest drop of a scan, from draws of it (n,)."""
    if values == 1 or not degrees:
        return Tail(degrees, 1, 0.0)
    rare = np.sort(largest)[::-1][: max(int(TAIL_SHARE * len(largest)), 1)]
    chance = (np.arange(len(rare)) + 0.5) / len(largest)
    beyond = np.sum(chance - chi2_sf(rare, degrees)) / np.sum(_density(rare, degrees))
    return Tail(degrees, values, max(float(beyond), 0.0))


@dataclass(frozen=True)
class Chance:
    """The null distributions of all effects in a campaign.

    `tails`: one for each effect; `share`: the p-value of an effect, after its own search, that
    the smallest of all falls below in a share `level` of the draws; `smallest`: sorted draws of
    the smallest p-value; `bounds`: the drops whose p-value is `share`.
    """

    tails: tuple[Tail, ...]
    level: float
    share: float
    smallest: Array
    bounds: tuple[float, ...]

    def p_value(
        self, effect: int, drop: float, degrees: int, noise_degrees: float = np.inf
    ) -> float:
        """Probability of a larger drop of an effect, the search over its scan accounted for.

        `degrees`: given others fewer than alone; `noise_degrees`: of the noise estimate.
        """
        law = self.tails[effect]
        if not degrees or not law.degrees:
            return 1.0
        if np.isinf(noise_degrees):
            alone = float(chi2_sf(drop, degrees))
        else:
            alone = float(f_sf(drop / degrees, degrees, noise_degrees))
        return float(law(chi2_isf(alone, law.degrees)))

    def after_search(self, p_value: float) -> float:
        """Probability that any effect of the catalogue reaches such a p-value."""
        if p_value <= self.share:
            return self.level * p_value / self.share
        share = np.searchsorted(self.smallest, p_value, side="right") / len(self.smallest)
        return max(float(share), self.level)

    def threshold(self, effect: int, noise_degrees: float = np.inf) -> float:
        """The drop from which an effect is named."""
        law = self.tails[effect]
        if not law.degrees:
            return np.inf
        bound = self.bounds[effect]
        if np.isinf(noise_degrees):
            return bound
        alone = float(chi2_sf(bound, law.degrees))
        return law.degrees * float(f_isf(alone, law.degrees, noise_degrees))


def chance(
    information: Array,
    effects: Sequence[SearchedEffect],
    level: float,
    draws: int = DRAWS,
    seed: int = 0,
) -> Chance:
    """Simulate campaigns of this plan without any effect.

    Parameters
    ----------
    information : F of all columns, (k, k)
    level : accepted probability of naming any effect where none acts
    """
    candidates = Candidates(effects)
    rng = np.random.default_rng(seed)
    right = noise(information, draws, rng)
    drops, degrees = candidates.drops(information, right)
    tails = []
    smallest = np.ones(draws)
    for number in range(len(effects)):
        own = candidates.effect == number
        max_degrees = int(degrees[own].max(initial=0))
        largest = drops[own].max(axis=0, initial=0.0)
        law = tail(max_degrees, int(np.sum(degrees[own] > 0)), largest)
        tails.append(law)
        if max_degrees:
            np.minimum(smallest, law(largest), out=smallest)
    smallest = np.sort(smallest)
    share = share_of_level(smallest, level)
    bounds = tuple(law.bound(share) if law.degrees else np.inf for law in tails)
    return Chance(tuple(tails), level, share, smallest, bounds)


def share_of_level(smallest: Array, level: float) -> float:
    """The p-value that the smallest of all falls below with probability `level`.

    Extrapolated from a higher level, for the draws of the smallest, sorted, are few: the
    probability is that of m independent effects, 1 − (1 − p)^m, where m hardly changes with p.
    """
    counted = min(LEVEL_RATIO * level, 0.5)
    return float(np.quantile(smallest, counted) * np.log1p(-level) / np.log1p(-counted))


def noise(information: Array, draws: int, rng: np.random.Generator) -> Array:
    """b ~ N(0, F), (k, draws), by as many white numbers as F has rank.

    The values of a scan resemble their neighbours: F of thousands has the rank of some hundreds.
    """
    size = np.sqrt(np.maximum(np.diag(information), 0.0))
    shown = np.flatnonzero(size)
    scaled = information[np.ix_(shown, shown)] / np.outer(size[shown], size[shown])
    # Pivoted Cholesky.
    factor, order, rank, _deficient = dpstrf(scaled, tol=NO_INFORMATION, lower=1)
    columns = shown[order - 1]
    root = size[columns, None] * np.tril(factor)[:, :rank]
    right = np.zeros((len(information), draws))
    right[columns] = root @ rng.standard_normal((rank, draws))
    return right


def power(snr: Array | float, degrees: int, threshold: float) -> Array:
    """Probability that an effect of this size is detected, see `Chance.threshold`."""
    return np.asarray(ncx2_sf(threshold, degrees, np.asarray(snr) ** 2))

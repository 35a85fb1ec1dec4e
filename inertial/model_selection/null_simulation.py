"""What noise alone brings forth in this campaign, by simulation, and the power of a search."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dtrmm
from scipy.optimize import brentq
from scipy.special import gammaln

from inertial.estimation.probability import (
    chi2_isf,
    chi2_sf,
    f_isf,
    f_sf,
    ncx2_sf,
)
from inertial.model_selection.evidence import SearchedEffect
from inertial.model_selection.scan import Candidates

# ---- The distribution of the statistics under noise alone in this campaign, by simulation.
#
# Where no effect acts, what the equations say of all candidates is b ~ N(0, F): that is drawn
# some thousand times. The largest drop among the values of a scan then has its own law, and the
# smallest p-value among all effects has the level at which something is named.

Array = NDArray[np.float64]

DRAWS = 10000
TAIL = 0.1  # the rarest share of the draws, from which what is rarer still is inferred
OFTENER = 3.0  # times the level at which the draws are counted
JITTER = 1e-9  # of the information of a column: columns that are the same are drawn as the same


@dataclass(frozen=True)
class Tail:
    """How often the largest of several chi-squareds of the same degrees exceeds a bound.

    sf(x) + v x^((r−1)/2) e^(−x/2), the bound of Davies (1987) for a smooth scan, at most
    n·sf(x) for n values; v from the draws.
    """

    degrees: int
    values: int
    crossings: float

    def __call__(self, x: Array | float) -> Array:
        """Chance of a larger drop, after the search over the values of the scan."""
        alone = chi2_sf(x, self.degrees)
        searched = alone + self.crossings * _density(x, self.degrees)
        return np.asarray(np.minimum(np.minimum(searched, self.values * alone), 1.0))

    def trials(self, x: float) -> float:
        """How many independent values would bring such a drop as often as the scan does."""
        alone = float(chi2_sf(x, self.degrees))
        return float(self(x)) / alone if alone > 0 else float(self.values)

    def bound(self, chance: float) -> float:
        """The drop that noise exceeds with this chance."""
        low = float(chi2_isf(chance, self.degrees))
        high = float(chi2_isf(chance / self.values, self.degrees))

        def above(x: float) -> float:
            return float(self(x)) - chance

        # Where every value of the scan is its own trial the two meet but for rounding.
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
    """The law of the largest drop of a scan, from draws of it (n,)."""
    if values == 1 or not degrees:
        return Tail(degrees, 1, 0.0)
    rare = np.sort(largest)[::-1][: max(int(TAIL * len(largest)), 1)]
    chance = (np.arange(len(rare)) + 0.5) / len(largest)
    beyond = np.sum(chance - chi2_sf(rare, degrees)) / np.sum(_density(rare, degrees))
    return Tail(degrees, values, max(float(beyond), 0.0))


@dataclass(frozen=True)
class Chance:
    """The laws of all effects in a campaign where none acts.

    `tails`: one for each effect; `share`: the p-value of an effect, after its own search, that
    the smallest of all falls below in a share `level` of the draws; `smallest`: sorted draws of
    the smallest p-value; `bounds`: the drops whose p-value is `share`.
    """

    tails: tuple[Tail, ...]
    level: float
    share: float
    smallest: Array
    bounds: tuple[float, ...]

    def p_value(self, effect: int, drop: float, degrees: int, known_from: float = np.inf) -> float:
        """Chance of a larger drop of an effect, its own search paid for.

        `degrees`: fewer than on its own beside others; `known_from`: degrees of the noise.
        """
        law = self.tails[effect]
        if not degrees or not law.degrees:
            return 1.0
        if np.isinf(known_from):
            alone = float(chi2_sf(drop, degrees))
        else:
            alone = float(f_sf(drop / degrees, degrees, known_from))
        return float(law(chi2_isf(alone, law.degrees)))

    def after_search(self, p_value: float) -> float:
        """Chance that any effect of the catalogue reaches such a p-value."""
        if p_value <= self.share:
            return self.level * p_value / self.share
        often = np.searchsorted(self.smallest, p_value, side="right") / len(self.smallest)
        return max(float(often), self.level)

    def price(self, effect: int, known_from: float = np.inf) -> float:
        """The drop from which on an effect is named."""
        law = self.tails[effect]
        if not law.degrees:
            return np.inf
        bound = self.bounds[effect]
        if np.isinf(known_from):
            return bound
        alone = float(chi2_sf(bound, law.degrees))
        return law.degrees * float(f_isf(alone, law.degrees, known_from))


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
    level : accepted chance of naming anything where nothing acts
    """
    candidates = Candidates(effects)
    rng = np.random.default_rng(seed)
    right = _noise(information, draws, rng)
    drops, degrees = candidates.drops(information, right)
    tails = []
    smallest = np.ones(draws)
    for number in range(len(effects)):
        own = candidates.effect == number
        most = int(degrees[own].max(initial=0))
        largest = drops[own].max(axis=0, initial=0.0)
        law = tail(most, int(np.sum(degrees[own] > 0)), largest)
        tails.append(law)
        if most:
            np.minimum(smallest, law(largest), out=smallest)
    smallest = np.sort(smallest)
    share = _share(smallest, level)
    bounds = tuple(law.bound(share) if law.degrees else np.inf for law in tails)
    return Chance(tuple(tails), level, share, smallest, bounds)


def _share(smallest: Array, level: float) -> float:
    """The p-value that the smallest of all falls below with the chance `level`.

    From a level at which it happens more often, for the draws are few: the chance is that of
    so many independent effects, 1 − (1 − p)^m, whose number hardly changes with p.
    """
    often = min(OFTENER * level, 0.5)
    return float(np.quantile(smallest, often) * np.log1p(-level) / np.log1p(-often))


def _noise(information: Array, draws: int, rng: np.random.Generator) -> Array:
    """b ~ N(0, F), (k, draws)."""
    size = np.sqrt(np.maximum(np.diag(information), 0.0))
    seen = np.flatnonzero(size)
    scaled = information[np.ix_(seen, seen)] / np.outer(size[seen], size[seen])
    root = size[seen, None] * np.linalg.cholesky(scaled + JITTER * np.eye(len(seen)))
    white = rng.standard_normal((len(seen), draws))
    right = np.zeros((len(information), draws))
    # The root is triangular: half of the work of a product, done in place.
    right[seen] = dtrmm(1.0, root, white.T, side=1, lower=1, trans_a=1, overwrite_b=1).T
    return right


# ---- The power that no search of a catalogue can exceed.


def power_limit(
    snr: Array | float, degrees: int, effects: int, level: float, values: float = 1.0
) -> Array:
    """Chance that an effect of this size stands out at the family-wise level.

    The drop of chi-squared is noncentral chi-squared; it must exceed what noise does with
    the share of the level of one effect among `effects` and of one value among the `values` of
    its own scan (the number of independent ones; their count is a lower bound of the power).
    """
    bound = chi2_isf(level / effects / values, degrees)
    return np.asarray(ncx2_sf(bound, degrees, np.asarray(snr) ** 2))


def power(snr: Array | float, degrees: int, price: float) -> Array:
    """The same where the drop from which on the effect is named is known, see `Chance.price`."""
    return np.asarray(ncx2_sf(price, degrees, np.asarray(snr) ** 2))

"""The search of a law among many functions of one state, by evidence.

Every law (a family of functions of one state, in one axis or in all) is as likely beforehand, and
so is every shape of a law; so the mean of their odds is the odds for any law against none, and the
search is paid for. How often noise alone reaches such odds is simulated in this campaign.

The path of a telegraph is no function of a few shapes: with K changes among n times it has
C(n, K) of them. The best is found by exchange, and its odds are divided by that number: a lower
bound of the mean over all, and so noise alone reaches odds of B with a probability of 1/B at most
(Markov's inequality).

Sources: Brunton, Proctor & Kutz 2016 (sparse regression for laws); Kass & Raftery 1995.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.special import gammaln, logsumexp

from inertial.arrays import Array, Integers
from inertial.model_selection.effect_classes import (
    MIN_CAPTURED,
    MIN_CLASS_PROBABILITY,
    fitted,
    log_evidence,
)
from inertial.model_selection.evidence import SearchedEffect
from inertial.model_selection.null_simulation import noise
from inertial.model_selection.search import MIN_EIGENVALUE, Candidates
from inertial.model_selection.walk_odds import LOG_RANGE, Equations

DRAWS = 1000
MAX_CHANGES = 12  # of a telegraph
COARSE = 9  # times of a change, of which one is tried first
JITTER = 1e-6  # of the information of a column
MIN_DRAWN = 10  # draws that reach the odds, for a number


@dataclass(frozen=True)
class LawOdds:
    """The odds of every law against none, logarithms.

    `of_each`: (m,), of each law, all its shapes together; `best`: (m,), the candidate of its best
    shape; `total`: of any law.
    """

    candidates: Candidates
    of_each: Array
    best: Integers
    total: float


def law_odds(equations: Equations, laws: Sequence[SearchedEffect], paths: Array) -> LawOdds:
    """The odds of all laws.

    `paths`: (m,), logarithm of the number of paths that a law was chosen from, 0 but of telegraphs.
    """
    candidates = Candidates(laws)
    drops, degrees = candidates.drops(equations.information, equations.right)
    each = np.where(degrees > 0, log_evidence(drops, degrees) - np.log(LOG_RANGE), -np.inf)
    own = [np.flatnonzero(candidates.effect == number) for number in range(len(laws))]
    of_each = np.array([logsumexp(each[i]) - np.log(len(i)) for i in own]) - paths
    best = np.array([i[np.argmax(each[i])] for i in own], np.int64)
    return LawOdds(candidates, of_each, best, float(logsumexp(of_each) - np.log(len(laws))))


def chance_of(equations: Equations, odds: LawOdds, paths: Array, seed: int = 0) -> float:
    """Probability that noise alone reaches such odds of any law.

    By simulation without the telegraphs, plus the bound of these; where the draws are too few for a
    number, by the bound for all.
    """
    simple = [i for i, number in enumerate(paths) if not number]
    candidates = Candidates([odds.candidates.effects[i] for i in simple])
    # Columns that are nearly the same are a little apart then.
    apart = JITTER * np.diag(np.diag(equations.information))
    right = noise(equations.information + apart, DRAWS, np.random.default_rng(seed))
    drops, degrees = candidates.drops(equations.information, right)
    grid = np.arange(0.0, drops.max() + 1)
    each = np.full(drops.shape, -np.inf)
    for count in np.unique(degrees[degrees > 0]):
        table = log_evidence(grid, np.full(len(grid), count)) - np.log(LOG_RANGE)
        each[degrees == count] = np.interp(drops[degrees == count], grid, table)
    shares = [
        logsumexp(each[own], axis=0) - np.log(np.sum(own))
        for own in (candidates.effect == i for i in range(len(simple)))
    ]
    nulls = logsumexp(shares, axis=0) - np.log(len(paths))
    bound = float(np.exp(-max(odds.total, 0.0)))
    drawn = float(np.mean(nulls >= odds.total))
    if drawn < MIN_DRAWN / DRAWS:
        return bound
    return min(drawn + bound, 1.0) if len(simple) < len(paths) else drawn


# ---- The class of a law: what the data do not distinguish from it.


@dataclass(frozen=True)
class LawClass:
    """Laws that may replace one, the most probable first, and their share of the probability.

    `captured`: how much of the signal of the first each can mimic.
    """

    members: tuple[int, ...]
    weights: tuple[float, ...]
    captured: tuple[float, ...]


def law_class(equations: Equations, odds: LawOdds) -> LawClass:
    """The members have 0.95 of the probability together, or mimic 0.90 of the most probable."""
    first = int(np.argmax(odds.of_each))
    place = int(odds.best[first])
    signal = fitted(equations.information, equations.right, odds.candidates.columns[place])
    shares, _ = odds.candidates.drops(equations.information, signal)
    captured = np.array(
        [float(shares[odds.candidates.effect == i].max()) for i in range(len(odds.of_each))]
    ) / max(float(shares[place]), np.finfo(float).tiny)
    weights = np.exp(odds.of_each - logsumexp(odds.of_each))
    ranked = np.argsort(-weights, kind="stable")
    needed = int(np.searchsorted(np.cumsum(weights[ranked]), MIN_CLASS_PROBABILITY)) + 1
    near = {*ranked[:needed].tolist()}
    # A larger law that contains it is a member only where it is about as likely.
    near |= {
        i
        for i in ranked.tolist()
        if captured[i] >= MIN_CAPTURED and weights[i] > weights[first] / 1000
    }
    members = [int(i) for i in ranked if i in near]
    return LawClass(tuple(members), tuple(weights[members]), tuple(captured[members]))


# ---- The path of a telegraph.

Path = tuple[int, ...]  # at which of the times it changes


def best_paths(equations: Equations, steps: Sequence[int], fewest: int) -> dict[Path, float]:
    """The best paths of `fewest`, … changes of one axis, and their drops.

    `steps`: the columns of a step at each of n times. One change is a jump, an effect of the
    catalogue: a path of one has a meaning beside a jump that is named.
    """
    count = len(steps)
    block = equations.information[np.ix_(steps, steps)]
    right = equations.right[list(steps)]

    def drops(paths: Sequence[Path]) -> Array:
        """Of paths with as many changes each."""
        at = np.array(paths)
        signs = (-1.0) ** np.arange(at.shape[1])
        information = block[at[:, :, None], at[:, None, :]] @ signs @ signs
        known = information > MIN_EIGENVALUE * block.max()
        return np.where(known, (right[at] @ signs) ** 2 / np.where(known, information, 1.0), 0.0)

    coarse = range(0, count, COARSE)
    pairs = list(combinations(coarse, 2))
    found: dict[int, Path] = {0: ()}
    for changes in range(fewest, MAX_CHANGES + 1):
        # Another level for a while, or from then on.
        grown = {_toggled(found.get(changes - 2, ()), pair) for pair in pairs}
        grown |= {_toggled(found.get(changes - 1, ()), (place,)) for place in coarse}
        starts = [path for path in grown if len(path) == changes]
        found[changes] = _moved(starts[int(np.argmax(drops(starts)))], count, drops)
    paths = [found[changes] for changes in range(fewest, MAX_CHANGES + 1)]
    return {path: float(drops([path])[0]) for path in paths}


def _toggled(path: Path, places: Path) -> Path:
    return tuple(sorted({*path} ^ {*places}))


def _moved(path: Path, count: int, drops: Callable[[Sequence[Path]], Array]) -> Path:
    """The path with single changes moved as long as that is better."""
    best = float(drops([path])[0])
    while True:
        tried = {
            _toggled(path, (old, new))
            for old in path
            for new in {*range(0, count, COARSE), *range(max(old - COARSE, 0), old + COARSE + 1)}
            if new not in path and new < count
        }
        moved = list(tried)
        values = drops(moved)
        if values.max() <= best * (1 + 1e-9):
            return path
        path, best = moved[int(np.argmax(values))], float(values.max())


def log_paths(count: int, changes: int) -> float:
    """Logarithm of the number of paths with so many changes, and of the numbers of changes."""
    ways = gammaln(count + 1) - gammaln(changes + 1) - gammaln(count - changes + 1)
    return float(ways + np.log(MAX_CHANGES - 1))

"""Which effects explain the data as well as the one that was found."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln, ive, logsumexp

from inertial.model_selection.scan import Candidates
from inertial.model_selection.search import Set

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

CREDIBLE = 0.95  # posterior probability that the members of a class share
CAPTURED = 0.90  # share of the signal of one effect that another can mimic, from which it is alike
EXCLUDED = 13.8  # by which its chi-squared may be worse: a likelihood of one in a thousand
RIVAL = 6.0  # by which the chi-squared of a rival set may be worse: odds of 20
SMALLEST = 2.0  # signal-to-noise ratio of an effect before the data: uniform in its logarithm
LARGEST = 40.0
STEPS = 77


def log_evidence(drop: Array, degrees: Integers) -> Array:
    """Logarithm of the odds for an effect against none, up to a constant.

    Its direction among its columns is taken as uniform and the logarithm of its
    signal-to-noise ratio s too: ∫ e^(−s²/2) ₀F₁(r/2; s² drop/4) ds/s. So an effect with many
    columns pays for what it could have explained.

    Parameters
    ----------
    drop, degrees : (c,); an effect that is not seen has no odds
    """
    half = degrees / 2
    root = np.sqrt(np.maximum(drop, 1e-6))
    safe = np.maximum(half, 0.5)
    # Laplace's approximation where the drop is large.
    sharp = drop / 2 + gammaln(safe) + (safe - 1) * np.log(2) - 2 * safe * np.log(root)
    ratio = np.linspace(SMALLEST, LARGEST, STEPS)
    z = root[:, None] * ratio
    order = (safe - 1)[:, None]
    bessel = gammaln(order + 1) - order * np.log(z / 2) + np.log(ive(order, z)) + z
    step = np.log(ratio[1] - ratio[0])
    exact = logsumexp(bessel - ratio**2 / 2 - np.log(ratio), axis=1) + step
    return np.where(degrees > 0, np.where(root > 0.7 * LARGEST, sharp, exact), -np.inf)


@dataclass(frozen=True)
class Alike:
    """The effects that may stand in the place of one, beside the others that were named.

    `place`: the candidate of most probable effect; `members`: effects, the most probable
    first; `weights`: posterior probability of every effect, (m,); `captured`: which share of
    the signal each can mimic, (m,); `best`: the best candidate of each, (m,); `drop`,
    `degrees`: of the candidate.
    """

    place: int
    members: tuple[int, ...]
    weights: Array
    captured: Array
    best: tuple[int, ...]
    drop: float
    degrees: int


def alike(
    candidates: Candidates,
    prices: Array,
    information: Array,
    right: Array,
    place: int,
    others: Sequence[int],
) -> Alike:
    """The class of a candidate, beside the other candidates that were named.

    Members share 0.95 of the posterior probability (every effect is as probable beforehand, and
    every value of its scan), or mimic 0.90 of the signal and are not excluded by the data. So an
    effect that contains another (lever arms of each accelerometer, a common one) is a
    member though the one with fewer parameters is more probable.
    """
    beside = candidates.around(others)
    drops, degrees = candidates.drops(information, right, beside)
    possible = (degrees > 0) & ~np.isin(candidates.effect, candidates.effect[list(others)])
    odds = np.where(possible, log_evidence(drops, degrees), -np.inf)
    count = len(candidates.effects)
    owners = [candidates.effect == number for number in range(count)]
    each = np.array([_mean(odds[own & possible]) for own in owners])
    anything = np.array([one.free for one in candidates.effects])
    if not anything[candidates.effect[place]]:  # it contains every effect and is none's rival
        each[anything] = -np.inf
    weights = np.exp(each - logsumexp(each))
    # An effect that would not be named on its own does not replace the one that is.
    own = candidates.effect[place]
    able = np.flatnonzero(possible & (drops >= np.asarray(prices)[candidates.effect]))
    if len(able):
        effect = max({own, *candidates.effect[able]}, key=lambda number: weights[number])
        of_it = np.flatnonzero(possible & (candidates.effect == effect))
        place = int(of_it[np.argmax(odds[of_it])])
        own = effect
    captured = _captured(candidates, information, right, place, beside, possible)
    ranked = np.argsort(-weights, kind="stable")
    needed = int(np.searchsorted(np.cumsum(weights[ranked]), CREDIBLE)) + 1
    near = set(ranked[:needed]) | {own}
    drop = float(drops[place])
    largest = np.array([np.max(drops[o & possible], initial=0.0) for o in owners])
    near |= set(np.flatnonzero((captured >= CAPTURED) & (largest >= drop - EXCLUDED)))
    near = {e for e in near if e == own or not anything[e]}
    members = (own, *(e for e in ranked if e in near and e != own))
    return Alike(
        place,
        tuple(int(e) for e in members),
        weights,
        captured,
        tuple(int(np.argmax(np.where(o, drops, -1.0))) for o in owners),
        drop,
        int(degrees[place]),
    )


def with_rivals(
    candidates: Candidates, classes: Sequence[Alike], best: Set, peers: Sequence[Set]
) -> list[Alike]:
    """The classes with the effects of sets as good as the best, of which several are others.

    A set of the same size that explains the data as well in another way: each of its other
    effects belongs to the class whose signal it mimics best.
    """
    joined = list(classes)
    named = {int(candidates.effect[one.place]): i for i, one in enumerate(joined)}
    for peer in peers:
        effects = {int(e) for e in candidates.effect[list(peer.places)]}
        new, old = effects - set(named), set(named) - effects
        if peer.gain < best.gain - RIVAL or len(new) < 2 or len(new) != len(old):
            continue
        for effect in new:
            if candidates.effects[effect].free:
                continue
            i = named[max(old, key=lambda one: float(joined[named[one]].captured[effect]))]
            if effect not in joined[i].members:
                joined[i] = replace(joined[i], members=(*joined[i].members, effect))
    return joined


def _mean(odds: Array) -> float:
    return float(logsumexp(odds) - np.log(len(odds))) if len(odds) else -np.inf


def _captured(
    candidates: Candidates,
    information: Array,
    right: Array,
    place: int,
    beside: Sequence[int],
    possible: NDArray[np.bool_],
) -> Array:
    """Share of the estimated signal of a candidate that every effect can mimic, (m,)."""
    signal = fitted(information, right, candidates.columns[place], beside)
    shares, _ = candidates.drops(information, signal, beside)
    shares = np.where(possible, shares, 0.0) / max(float(shares[place]), np.finfo(float).tiny)
    return np.array(
        [
            float(shares[candidates.effect == number].max(initial=0.0))
            for number in range(len(candidates.effects))
        ]
    )


def fitted(
    information: Array, right: Array, columns: Sequence[int], beside: Sequence[int] = ()
) -> Array:
    """What the equations would say of all columns if the estimate of some were the truth, (k,)."""
    every = list(dict.fromkeys([*columns, *beside]))
    block = information[np.ix_(every, every)]
    size = np.sqrt(np.maximum(np.diag(block), np.finfo(float).tiny))
    beta = np.linalg.pinv(block / np.outer(size, size), rcond=1e-6, hermitian=True) @ (
        right[every] / size
    )
    beta[len(columns) :] = 0.0
    return information[:, every] @ (beta / size)

"""Classes of effects that explain the data equally well."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import gammaln, ive

from inertial.arrays import Array, Booleans, Integers
from inertial.estimation.effect_information import sizes_of
from inertial.model_selection.search import Candidates, Set

MIN_CLASS_PROBABILITY = 0.95  # posterior, of all members together
MIN_CAPTURED = 0.90  # share of the signal of an effect that a member can mimic
MIN_SHARED = 0.10  # the same of any member: an effect that mimics nothing explains other data
MAX_CHI_SQUARED_EXCESS = 13.8  # of such a member: a likelihood of one in a thousand
MAX_RIVAL_EXCESS = 6.0  # of the chi-squared of a rival set: odds of 20
MIN_PRIOR_SNR = 2.0  # of an effect: its prior is uniform in the logarithm
MAX_PRIOR_SNR = 40.0
PRIOR_STEPS = 77


def log_evidence(drop: Array, degrees: Integers) -> Array:
    """Logarithm of the odds for an effect against none, up to a constant.

    Its direction among its columns is taken as uniform and the logarithm of its
    signal-to-noise ratio s too: ∫ e^(−s²/2) ₀F₁(r/2; s² drop/4) ds/s. So an effect with many
    columns is penalised for what it could have explained.

    Parameters
    ----------
    drop, degrees : (c,); an effect that is not observable has no odds
    """
    root = np.sqrt(np.maximum(drop, 1e-6))
    half = np.maximum(degrees / 2, 0.5)
    # Laplace's approximation where the drop is large.
    log_odds = drop / 2 + gammaln(half) + (half - 1) * np.log(2) - 2 * half * np.log(root)
    exact = (degrees > 0) & (root <= 0.7 * MAX_PRIOR_SNR)
    ratio = np.linspace(MIN_PRIOR_SNR, MAX_PRIOR_SNR, PRIOR_STEPS)
    z = root[exact, None] * ratio
    order = half[exact, None] - 1
    bessel = gammaln(order + 1) - order * np.log(z / 2) + np.log(ive(order, z)) + z
    step = np.log(ratio[1] - ratio[0])
    log_odds[exact] = np.logaddexp.reduce(bessel - ratio**2 / 2 - np.log(ratio), axis=1) + step
    return np.where(degrees > 0, log_odds, -np.inf)


@dataclass(frozen=True)
class EffectClass:
    """The effects that may replace a named one, given the other named ones.

    `place`: the candidate of the most probable effect; `members`: effects, the most probable
    first; `weights`: posterior probability of joint effect, (m,); `captured`: which share of
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


def effect_class(
    candidates: Candidates,
    thresholds: Array,
    information: Array,
    right: Array,
    place: int,
    others: Sequence[int],
) -> EffectClass:
    """The class of a candidate, given the other named candidates.

    Members share 0.95 of the posterior probability (uniform prior over effects, and over the
    values of each scan), or mimic 0.90 of the signal and are not excluded by the data. So an
    effect that contains another (lever arms of each accelerometer, a common one) is a
    member though that with fewer parameters is more probable. One that mimics next to nothing of
    the signal is none, however probable: both may be there.
    """
    given = candidates.around(others)
    drops, degrees = candidates.drops(information, right, given)
    possible = (degrees > 0) & ~np.isin(candidates.effect, candidates.effect[list(others)])
    odds = np.where(possible, log_evidence(drops, degrees), -np.inf)
    count = len(candidates.effects)
    owners = [candidates.effect == number for number in range(count)]
    log_odds = np.array([_mean(odds[own & possible]) for own in owners])
    free = np.array([effect.free for effect in candidates.effects])
    if not free[candidates.effect[place]]:  # a free function contains joint effect and rivals none
        log_odds[free] = -np.inf
    weights = np.exp(log_odds - np.logaddexp.reduce(log_odds))
    # An effect below its own threshold does not replace a named one.
    own = candidates.effect[place]
    significant = np.flatnonzero(possible & (drops >= np.asarray(thresholds)[candidates.effect]))
    if len(significant):
        effect = max({own, *candidates.effect[significant]}, key=lambda number: weights[number])
        values = np.flatnonzero(possible & (candidates.effect == effect))
        place = int(values[np.argmax(odds[values])])
        own = effect
    captured = _captured(candidates, information, right, place, given, possible)
    ranked = np.argsort(-weights, kind="stable")
    needed = int(np.searchsorted(np.cumsum(weights[ranked]), MIN_CLASS_PROBABILITY)) + 1
    near = {effect for effect in ranked[:needed] if captured[effect] >= MIN_SHARED} | {own}
    drop = float(drops[place])
    largest = np.array([np.max(drops[o & possible], initial=0.0) for o in owners])
    near |= set(
        np.flatnonzero((captured >= MIN_CAPTURED) & (largest >= drop - MAX_CHI_SQUARED_EXCESS))
    )
    near = {e for e in near if e == own or not free[e]}
    members = (own, *(e for e in ranked if e in near and e != own))
    return EffectClass(
        place,
        tuple(int(e) for e in members),
        weights,
        captured,
        tuple(int(np.argmax(np.where(o, drops, -1.0))) for o in owners),
        drop,
        int(degrees[place]),
    )


def with_rivals(
    candidates: Candidates, classes: Sequence[EffectClass], best: Set, peers: Sequence[Set]
) -> list[EffectClass]:
    """The classes, with the effects of rival sets added.

    A rival set has the same size, several other effects, and explains the data as well: each of
    its other effects joins the class whose signal it mimics best.
    """
    joined = list(classes)
    named = {int(candidates.effect[group.place]): i for i, group in enumerate(joined)}
    for peer in peers:
        effects = {int(e) for e in candidates.effect[list(peer.places)]}
        new, old = effects - set(named), set(named) - effects
        if peer.gain < best.gain - MAX_RIVAL_EXCESS or len(new) < 2 or len(new) != len(old):
            continue
        for effect in new:
            if candidates.effects[effect].free:
                continue
            i = named[max(old, key=lambda e: float(joined[named[e]].captured[effect]))]
            if effect not in joined[i].members:
                joined[i] = replace(joined[i], members=(*joined[i].members, effect))
    return joined


def _mean(odds: Array) -> float:
    return float(np.logaddexp.reduce(odds) - np.log(len(odds))) if len(odds) else -np.inf


def _captured(
    candidates: Candidates,
    information: Array,
    right: Array,
    place: int,
    given: Sequence[int],
    possible: Booleans,
) -> Array:
    """Share of the estimated signal of a candidate that joint effect can mimic, (m,)."""
    signal = fitted(information, right, candidates.columns[place], given)
    shares, _ = candidates.drops(information, signal, given)
    whole = float(shares[place])  # zero of a value that cannot be negative and is
    shares = np.where(possible & (whole > 0), shares, 0.0) / (whole or 1.0)
    return np.array(
        [
            float(shares[candidates.effect == number].max(initial=0.0))
            for number in range(len(candidates.effects))
        ]
    )


def fitted(
    information: Array, right: Array, columns: Sequence[int], given: Sequence[int] = ()
) -> Array:
    """Right-hand side of all columns if the estimate of some were the truth, (k,)."""
    joint = list(dict.fromkeys([*columns, *given]))
    block = information[np.ix_(joint, joint)]
    size = sizes_of(block)
    beta = np.linalg.pinv(block / np.outer(size, size), rcond=1e-6, hermitian=True) @ (
        right[joint] / size
    )
    beta[len(columns) :] = 0.0
    return information[:, joint] @ (beta / size)

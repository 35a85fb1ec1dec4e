"""What is attainable where the shape is not known: the mean of the posterior of an ideal estimator.

The bound knows which shape each curve has. An estimator that does not has a larger error, however
good it is; the smallest mean square has the one that knows how the curves were drawn (Bayes). Here
it sees the exact information of a plan on one curve, that on all else eliminated, with noise of its
own: the shapes are as probable as they are drawn, the knot is uniform, and so are the logarithm of
the highest coefficient and the sign. It shares no code with the stages.
"""

from dataclasses import dataclass

import numpy as np
from temperature_bound import Bound, Curve, inverse
from temperature_draws import KNOTS, LOWER, RATIOS, Drawn, planned

Array = np.ndarray

GRID = 31  # knots
SIZES = 200  # of the highest coefficient
NORMAL_95 = 1.959964


@dataclass(frozen=True)
class Ideal:
    """Errors and sigmas of a curve at temperatures, (k,) each."""

    error: Array
    sigma: Array


def information(bound: Bound, hidden: Drawn, number: int, columns: Array) -> Array:
    """On a parameter at the middle and some shapes of its curve, (blocks, k); (1 + k, 1 + k).

    The other curves are as the bound has them.
    """
    own, layout = hidden.curves[number], bound.layout
    others = [
        bound.rows_of(curve.parameter, curve.with_knot(bound.temperature, numbers))
        for i, (curve, numbers) in enumerate(zip(hidden.curves, hidden.coefficients, strict=True))
        if i != number
    ]
    rest = np.hstack([np.delete(bound.rows, own.parameter, axis=1), *others])
    known = np.delete(np.nan_to_num(1 / layout.known**2), own.parameter)
    prior = np.append(known, np.zeros(rest.shape[1] - len(known)))
    mine = np.hstack([bound.rows[:, [own.parameter]], bound.rows_of(own.parameter, columns)])
    shared = rest.T @ mine
    return np.asarray(mine.T @ mine - shared.T @ inverse(rest.T @ rest + np.diag(prior)) @ shared)


def ideal(hidden: Drawn, number: int, plan: str, at: Array, random: np.random.Generator) -> Ideal:
    """A curve estimated from the plan's information on it, with noise, at temperatures, K."""
    told, own = planned(plan), hidden.curves[number]
    knots = own.middle + np.linspace(-1, 1, GRID) * own.half * (KNOTS[1] - KNOTS[0])
    trial = [Curve(own.parameter, "3", own.middle, own.half)]
    trial += [Curve(own.parameter, "knee", own.middle, own.half, knot) for knot in knots]
    trial += [own] * (own.shape == "knee")

    def shapes(t: Array) -> Array:
        return np.hstack([trial[0].shapes(t), *(one.shapes(t)[:, 1:] for one in trial[1:])])

    whole = information(told.bound, hidden, number, shapes(told.bound.temperature))
    size = np.sqrt(np.diag(whole))
    whole = whole / np.outer(size, size)
    true = np.zeros(len(whole))
    places = [1, len(whole) - 1] if own.shape == "knee" else [*range(1, 1 + own.count)]
    true[places] = hidden.coefficients[number] * size[places]
    values, vectors = np.linalg.eigh(whole)
    noise = vectors @ (np.sqrt(np.maximum(values, 0.0)) * random.standard_normal(len(whole)))
    right = whole @ true + noise
    design = np.column_stack([np.ones(len(at)), shapes(at)]) / size
    hypotheses = [([0, *range(1, 1 + degree)], 1.0) for degree in (1, 2, 3)]
    hypotheses += [([0, 1, 4 + i], 1 / GRID) for i in range(GRID)]
    parts = [
        _posterior(whole[np.ix_(own, own)], right[own], design[:, own], np.log(share))
        for own, share in hypotheses
    ]
    log_odds = np.concatenate([part[0] for part in parts])
    weights = np.exp(log_odds - log_odds.max())
    weights /= weights.sum()
    curves, variances = (np.concatenate([part[i] for part in parts], axis=1) for i in (1, 2))
    mean = curves @ weights
    variance = (variances + (curves - mean[:, None]) ** 2) @ weights
    return Ideal(mean - design @ true, np.sqrt(variance))


def _posterior(
    whole: Array, right: Array, design: Array, prior: float
) -> tuple[Array, Array, Array]:
    """Of one shape for each size of its highest coefficient, (s,).

    The logarithm of the odds, the curve, (k, s), and its variance, (k, s).
    """
    sigma = np.sqrt(np.diag(inverse(whole)))
    sizes = np.exp(np.linspace(*np.log(RATIOS), SIZES)) * sigma[-1]
    highest = np.append(-sizes, sizes)
    lower = np.zeros(len(whole) - 1)
    lower[1:] = 1 / (LOWER * sigma[1:-1]) ** 2  # the level is not known at all
    rest = whole[:-1, :-1] + np.diag(lower)
    left = right[:-1, None] - whole[:-1, [-1]] * highest
    spread = np.linalg.inv(rest)
    best = spread @ left
    log_odds = prior + (left * best).sum(axis=0) / 2 - np.linalg.slogdet(rest)[1] / 2
    log_odds += np.log(lower[1:]).sum() / 2
    log_odds += right[-1] * highest - whole[-1, -1] * highest**2 / 2
    curves = design[:, :-1] @ best + design[:, [-1]] * highest
    variance = np.einsum("ti,ij,tj->t", design[:, :-1], spread, design[:, :-1])
    return log_odds, curves, np.repeat(variance[:, None], len(highest), axis=1)

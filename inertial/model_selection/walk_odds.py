"""Odds of laws against a random walk of each bias, with the Occam factors of all their parameters.

A random walk from which its mean is fitted has independent components cos(k π t/T), k = 1, 2, …,
of variance 2 K² T/(k π)² (Karhunen & Loève): a prior of the same half waves that a drift without a
law consists of. So both explanations are compared in one set of normal equations. Each has a size
whose logarithm is uniform, in units of what the campaign determines: a signal-to-noise ratio.

A walk may be that of all axes or of one; so may a law with a parameter for each axis. Else a drift
of one gyro would count as a walk of three of which two happen to be silent.

Source: MacKay 1992, Bayesian interpolation (Occam factor); IEEE Std 952-2020, rate random walk.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inertial.arrays import Array
from inertial.model_selection.effect_classes import MAX_PRIOR_SNR, MIN_PRIOR_SNR, log_evidence
from inertial.model_selection.evidence import searched_effect
from inertial.model_selection.search import Candidates

MIN_INFORMATION = 1e-6  # of a column, left of it once others are explained: less is rounding
LARGEST_SNR = 1e3  # of a walk that is tried; beyond MAX_PRIOR_SNR the prior goes on as before
AXES = 3
STEPS = 60  # of the sizes of a walk
MAX_WAYS = 12  # of several effects, the likeliest
LOG_RANGE = float(np.log(MAX_PRIOR_SNR / MIN_PRIOR_SNR))


@dataclass(frozen=True)
class Equations:
    """Normal equations of all columns, what is already explained removed: F (k, k), b (k,)."""

    information: Array
    right: Array

    def of(self, columns: Sequence[int]) -> "Equations":
        """Those of some columns alone, in their order."""
        return Equations(self.information[np.ix_(columns, columns)], self.right[list(columns)])

    def given(self, columns: Sequence[int], variance: Array | None = None) -> "Equations":
        """The same with some columns explained, with prior variances where they have one.

        What these contain is zero: of its rounding any signal to noise ratio would follow.
        """
        if not len(columns):
            return self
        own = list(columns)
        size = np.diag(self.information)[own]
        scale = np.sqrt(np.where(size > 0, size, 1.0))
        block = self.information[np.ix_(own, own)] / np.outer(scale, scale)
        if variance is not None:
            block = block + np.diag(1 / np.maximum(variance * scale**2, np.finfo(float).tiny))
        inverse = np.linalg.pinv(block, rcond=1e-9, hermitian=True) / np.outer(scale, scale)
        across = self.information[:, own] @ inverse
        information = self.information - across @ self.information[own]
        gone = np.diag(information) <= MIN_INFORMATION * np.diag(self.information)
        information[gone] = information[:, gone] = 0.0
        right = self.right - across @ self.right[own]
        return Equations(information, np.where(gone, 0.0, right))


@dataclass(frozen=True)
class WeighedExplanation:
    """Log evidence of an explanation against none.

    `equations`: before it; `columns`: that it explains, `variance`: beforehand, where they have one
    """

    log_evidence: float
    equations: Equations
    columns: Sequence[int] = ()
    variance: Array | None = None

    @cached_property
    def rest(self) -> Equations:
        """The equations with it explained."""
        return self.equations.given(self.columns, self.variance)


def walk(equations: Equations, axes: Sequence[Sequence[int]]) -> WeighedExplanation:
    """A random walk of all biases alike, or of each by itself.

    `axes`: of each axis the columns of its half waves, k = 1, 2, …
    """
    shape = np.arange(1, len(axes[0]) + 1, dtype=np.float64) ** -2.0
    alike = _walk(equations, [i for axis in axes for i in axis], np.tile(shape, len(axes)))

    def alone(rest: Equations, axis: int) -> WeighedExplanation:
        return _walk(rest, axes[axis], shape)

    return _either(alike, _each(equations, alone))


Scanned = tuple[Sequence[Sequence[int]], Array]  # columns of each value, and its share of the prior


def law(
    equations: Equations, values: Sequence[Sequence[int]], weights: Array
) -> WeighedExplanation:
    """An effect, of which each value of its scan has columns and a share of the prior.

    Where it has parameters for each axis, all axes together or any of them; see `_ways`.
    """
    ways = _ways(WeighedExplanation(0.0, equations), (values, weights))
    return replace(max(ways, key=lambda way: way.log_evidence), log_evidence=_sum_of(ways))


def laws(equations: Equations, effects: Sequence[Scanned]) -> float:
    """The log evidence of several effects together.

    All ways of the first count for the next one: an axis of the first that seems silent, because
    the next one hides it, would else be missed. Those with the fewest values come first: of many
    values, such as the times of a jump, the best stand out once what is large is explained.
    """
    effects = sorted(effects, key=lambda effect: len(effect[0]))
    own = sorted({i for values, _weights in effects for columns in values for i in columns})
    place = {column: i for i, column in enumerate(own)}
    ways = [WeighedExplanation(0.0, equations.of(own))]
    for values, weights in effects:
        moved = [[place[i] for i in columns] for columns in values]
        every = [after for way in ways for after in _ways(way, (moved, weights))]
        ways = sorted(every, key=lambda way: way.log_evidence)[-MAX_WAYS:]
    return _sum_of(ways)


def _ways(before: WeighedExplanation, effect: Scanned) -> list[WeighedExplanation]:
    """An effect as a whole, in any of the three axes of the sensor, or one element of its matrix.

    The columns of a matrix are in the order of its rows, of which each axis has one.
    """
    values, weights = effect
    before = WeighedExplanation(before.log_evidence, before.rest)
    count = len(values[0])
    whole = _after(before, values, weights)
    if count % AXES:
        return [whole]
    row = count // AXES
    any_axes = [_less(before, 2**AXES)]
    for first in range(0, count, row):
        own = [columns[first : first + row] for columns in values]
        any_axes += [_after(way, own, weights) for way in any_axes]
    kinds = [[whole], any_axes]
    if row > 1:
        elements = ([columns[k : k + 1] for columns in values] for k in range(count))
        single = [_after(before, own, weights) for own in elements]
        kinds.append([_less(way, count) for way in single])
    return [_less(way, len(kinds)) for ways in kinds for way in ways]


def _less(way: WeighedExplanation, count: int) -> WeighedExplanation:
    """One of so many ways that are as likely beforehand."""
    return replace(way, log_evidence=way.log_evidence - float(np.log(count)))


def _sum_of(ways: Sequence[WeighedExplanation]) -> float:
    return float(np.logaddexp.reduce([way.log_evidence for way in ways]))


def _each(
    equations: Equations, alone: Callable[[Equations, int], WeighedExplanation]
) -> WeighedExplanation:
    """Each axis by itself: it acts or does not, as likely beforehand."""
    total, rest = 0.0, equations
    first = [alone(equations, axis).log_evidence for axis in range(AXES)]
    for axis in np.argsort(first)[::-1]:
        one = alone(rest, int(axis))
        total += float(np.logaddexp(0.0, one.log_evidence) - np.log(2))
        rest = one.rest if one.log_evidence > 0 else rest
    return WeighedExplanation(total, rest)


def _either(one: WeighedExplanation, other: WeighedExplanation) -> WeighedExplanation:
    """Two kinds of the same, as likely beforehand."""
    both = float(np.logaddexp(one.log_evidence, other.log_evidence) - np.log(2))
    return replace(max(one, other, key=lambda each: each.log_evidence), log_evidence=both)


def _walk(equations: Equations, columns: Sequence[int], shape: Array) -> WeighedExplanation:
    """A walk of one size K²; `shape`: variances of its components for K = 1."""
    own = list(columns)
    root = np.sqrt(shape)
    block = equations.information[np.ix_(own, own)] * np.outer(root, root)
    signal = float(np.trace(block))
    if signal <= 0:
        return WeighedExplanation(0.0, equations)
    values, vectors = np.linalg.eigh(block)
    values = np.maximum(values, 0.0)
    along = vectors.T @ (root * equations.right[own])
    sizes = np.geomspace(MIN_PRIOR_SNR, LARGEST_SNR, STEPS)
    variances = sizes[:, None] ** 2 / signal
    gains = variances * along**2 / (1 + variances * values) - np.log1p(variances * values)
    logs = np.sum(gains, axis=1) / 2
    step = float(np.log(sizes[1] / sizes[0]))
    total = float(np.logaddexp.reduce(logs)) + np.log(step) - np.log(LOG_RANGE)
    best = float(variances[int(np.argmax(logs)), 0])
    return WeighedExplanation(float(total), equations, own, best * shape)


def _after(
    before: WeighedExplanation, values: Sequence[Sequence[int]], weights: Array
) -> WeighedExplanation:
    """An effect with all of these columns, after something else is explained."""
    candidates = Candidates([searched_effect("", *values)])
    drops, degrees = candidates.drops(before.rest.information, before.rest.right)
    odds = np.where(degrees > 0, log_evidence(drops, degrees) - np.log(LOG_RANGE), 0.0)
    total = float(np.logaddexp.reduce(odds + np.log(weights / np.sum(weights))))
    columns = values[int(np.argmax(odds))]
    return WeighedExplanation(before.log_evidence + total, before.rest, columns)

"""Which of many possible manoeuvres determine the parameters best in a given time.

The information of manoeuvres in positions of their own adds up. A plan is a number of repetitions
of each candidate, whose times are together within what there is. The criteria, of all variances r
in units of reference variances:

    A      the mean of r
    worst  the 8th power mean of r, near the largest
    D      the determinant of the covariance: its root, a geometric mean of variances

Without the limitation to whole manoeuvres the problem is convex, and the multiplicative algorithm
solves it: the time of each candidate is multiplied by a power of its gain per second (Silvey,
Titterington & Torsney 1978). Its information per second M is that of the best plan. Whole
manoeuvres are chosen one after another so that, with the time left at M, the criterion is least;
then each is taken out and replaced, as long as anything improves (Fedorov 1972; Atkinson, Donev &
Tobias 2007, chapter 12).

By convexity no plan of the same candidates is better than a bound, by which the efficiency of what
is found is known.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from inertial.arrays import Array, Integers

A, D, WORST = "A", "D", "worst"
POWERS = {A: 1, WORST: 8}  # of the mean; D has none
CRITERIA = (A, D, WORST)
STEPS = 3000  # of the multiplicative algorithm
START_SHARES = (0.0, 0.05, 0.1, 0.15)  # of the time, that manoeuvres take at least in a first plan
MIN_GAIN = 1e-3  # relative, by which the criterion can be less than that of the parts at most
EXCHANGES = 200
MAX_OUT = 6  # manoeuvres that are taken out at once


@dataclass(frozen=True)
class Candidates:
    """What may be recorded, any number of times.

    `information`: of each sensor (n, q, q); `known`: that without any, (q, q); `seconds`: (n,);
    `parameters`: how many unknowns of each sensor, the first ones, are wanted; `reference`: their
    sigmas in which variances are counted, all sensors together, inf where one is not.
    """

    information: Sequence[Array]
    known: Sequence[Array]
    seconds: Array
    parameters: int
    reference: Array

    def total(self, counts: Array | Integers) -> list[Array]:
        """The information of a plan, (q, q) of each sensor."""
        return [
            k + np.tensordot(counts, own, 1)
            for k, own in zip(self.known, self.information, strict=True)
        ]

    def sigmas(self, total: Sequence[Array]) -> Array:
        """The sigmas by an information (…, q, q) of each sensor, (…, p)."""
        w = self.parameters
        variances = [np.diagonal(_inverse(j), axis1=-2, axis2=-1)[..., :w] for j in total]
        return np.sqrt(np.concatenate(variances, axis=-1))

    def value(self, criterion: str, total: Sequence[Array]) -> Array:
        """A criterion by an information (…, q, q) of each sensor, (…,)."""
        w = self.parameters
        if criterion == D:
            logs = sum(np.linalg.slogdet(_inverse(j)[..., :w, :w])[1] for j in total)
            return np.asarray(np.exp((logs - self._log_scale) / len(self.reference)))
        power = POWERS[criterion]
        relative = (self.sigmas(total) / self.reference) ** 2
        return np.asarray(np.mean(relative**power, axis=-1) ** (1 / power))

    def gains(self, criterion: str, total: Sequence[Array]) -> tuple[Array, float]:
        """By how much a criterion decreases, relative to it, per second of each candidate, (n,).

        And by how much, at the same slope, without all that is not known beforehand.
        """
        w, first, rates, spent = self.parameters, 0, np.zeros(len(self.seconds)), 0.0
        power = POWERS.get(criterion, 0)
        relative = (self.sigmas(total) / self.reference) ** 2
        weights = relative**power / np.sum(relative**power) / self.sigmas(total) ** 2
        for known, own, now in zip(self.known, self.information, total, strict=True):
            inverse = _inverse(now)
            columns = inverse[:, :w]
            if criterion == D:
                inner = np.linalg.inv(inverse[:w, :w]) / len(self.reference)
            else:
                inner = np.diag(weights[first : first + w])
            first += w
            gradient = columns @ inner @ columns.T
            rates += np.einsum("ij,nij->n", gradient, own) / self.seconds
            spent += float(np.sum(gradient * (now - known)))
        return rates, spent

    @cached_property
    def _log_scale(self) -> float:
        finite = self.reference[np.isfinite(self.reference)]
        return float(2 * len(self.reference) * np.mean(np.log(finite)))


def _inverse(information: Array) -> Array:
    """Of symmetric matrices (…, q, q), in units in which their diagonals are 1."""
    size = np.sqrt(np.diagonal(information, axis1=-2, axis2=-1))
    outer = size[..., :, None] * size[..., None, :]
    return np.asarray(np.linalg.inv(information / outer) / outer)


@dataclass(frozen=True)
class Plan:
    """How often each candidate is recorded, (n,); `value`: of the criterion; `bound`: none is less.

    `efficiency`: bound over value.
    """

    counts: Integers
    value: float
    bound: float

    @property
    def efficiency(self) -> float:
        """The variances of the best possible plan over those of this one, at least."""
        return self.bound / self.value


def best_plan(candidates: Candidates, seconds: float, criterion: str) -> Plan:
    """The best plan within some time, s, that is found; the same at every call."""
    times, bound = relaxed(candidates, seconds, criterion)
    search = _Search(candidates, times, seconds, criterion)
    random, best = np.random.default_rng(0), np.inf
    for share in START_SHARES:
        start = search.filled(np.zeros(len(times), np.int64), share * seconds)
        start = search.filled(start)
        if (reached := search.value(start)) < best:
            counts, best = start, reached
    for _ in range(EXCHANGES if counts.any() else 0):
        chosen = np.repeat(np.arange(len(times)), counts)
        most = int(random.integers(1, MAX_OUT + 1))
        out = random.choice(chosen, min(len(chosen), most), replace=False)
        trial = search.filled(counts - np.bincount(out, minlength=len(times)), without=int(out[0]))
        if (reached := search.value(trial)) < best:
            counts, best = trial, reached
    return Plan(counts, best, bound)


def relaxed(candidates: Candidates, seconds: float, criterion: str) -> tuple[Array, float]:
    """The time of each candidate in the best plan of parts of manoeuvres, (n,), s.

    And the least value of the criterion that any plan of this time can have.
    """
    n = len(candidates.seconds)
    times = np.full(n, seconds / n)
    exponent = 1 / (1 + POWERS.get(criterion, 0))
    for _ in range(STEPS):
        gains, spent = candidates.gains(criterion, candidates.total(times / candidates.seconds))
        if seconds * float(gains.max()) - spent < MIN_GAIN:
            break
        times = times * gains**exponent
        times *= seconds / times.sum()
    total = candidates.total(times / candidates.seconds)
    gains, spent = candidates.gains(criterion, total)
    value = float(candidates.value(criterion, total))
    below = seconds * float(gains.max()) - spent
    # The mean of powers is convex, D only in its logarithm.
    return times, value * float(np.exp(-below) if criterion == D else max(1 - below, 0.0))


class _Search:
    """Plans of whole manoeuvres, the time that is left used as the best plan of parts does."""

    def __init__(
        self, candidates: Candidates, times: Array, seconds: float, criterion: str
    ) -> None:
        self._all, self._seconds, self._criterion = candidates, seconds, criterion
        shares = times / seconds / candidates.seconds
        self._rate = [np.tensordot(shares, own, 1) for own in candidates.information]

    def value(self, counts: Integers) -> float:
        """The criterion of a plan."""
        return float(self._all.value(self._criterion, self._all.total(counts)))

    def filled(self, counts: Integers, least: float = 0.0, without: int | None = None) -> Integers:
        """A plan with more candidates of at least some time, s, as long as one fits."""
        counts = counts.copy()
        seconds = self._all.seconds
        total = self._all.total(counts)
        left = self._seconds - float(counts @ seconds)
        while True:
            some = np.flatnonzero((seconds <= left) & (seconds >= least))
            some = some[some != without] if without is not None else some
            if not len(some):
                return counts
            sums = [
                base + own[some] for base, own in zip(total, self._all.information, strict=True)
            ]
            after = (left - seconds[some])[:, None, None]
            hoped = [own + after * rate for own, rate in zip(sums, self._rate, strict=True)]
            before = [own + left * rate for own, rate in zip(total, self._rate, strict=True)]
            losses = np.log(self._all.value(self._criterion, hoped))
            losses -= np.log(self._all.value(self._criterion, before))
            chosen = int(np.argmin(losses / seconds[some]))
            counts[some[chosen]] += 1
            total = [each[chosen] for each in sums]
            left -= float(seconds[some[chosen]])

"""A bias that differs from stretch to stretch: the equations of scatter and random walk.

    bias of a stretch = bias + d,    d = scatter + mean of K W(t) over the stretch

W is Brownian motion. So over a stretch of T seconds, G seconds after the one before, from p at the
end of that to e at its own end, the mean m and e have the covariance

    cov [m − p, e − p] = K² [[G + T/3, G + T/2], [G + T/2, G + T]].

d and e of every stretch are unknowns, for each axis. The random walk is 0 at the end of the stretch
that is nearest to the middle of the campaign, so the bias is that of this time. Logs without a
common clock have a random walk each, whose start has the variance that all recorded time leads to.

Source: IEEE Std 952-2020, rate random walk.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.elimination import EquationBlock, Name

Array = NDArray[np.float64]

COMMON_CLOCK = ""  # the name of the clock of all logs, where they have one


@dataclass(frozen=True)
class Stretch:
    """A stretch of time with one drift of the bias: a static position, a rate segment.

    `start`, `seconds`: s, NaN where not known; `clock`: of these times; `weight`: of the drift of
    this name in the equations of the stretch.
    """

    name: str
    clock: str = COMMON_CLOCK
    start: float = np.nan
    seconds: float = np.nan
    weight: float = 1.0

    @property
    def end(self) -> float:
        """s."""
        return self.start + self.seconds


def linear_trend(stretches: Sequence[Stretch]) -> Callable[[Stretch], Stretch]:
    """An alternative to a random walk: a drift in proportion to the time from the middle."""
    timed = [stretch for stretch in stretches if np.isfinite(stretch.end)]
    start = min((stretch.start for stretch in timed), default=np.nan)
    span = max((stretch.end for stretch in timed), default=np.nan) - start

    def of(stretch: Stretch) -> Stretch:
        part = (stretch.start + stretch.seconds / 2 - start) / span - 0.5
        return Stretch("trend", weight=part if np.isfinite(part) else 0.0)

    return of


def with_drifts(
    blocks: Sequence[tuple[EquationBlock, Stretch]],
    shared: int,
    bias: int,
    scatter: float,
    walk: float,
) -> tuple[list[EquationBlock], dict[Name, float]]:
    """Equations with the drifts as further errors, ordered so that few errors stay pending.

    Parameters
    ----------
    shared : number of unknowns that all blocks share; `bias`: the first of the three biases in it
    scatter, walk : unit of the readings; the same per √s

    Returns
    -------
    the blocks, and the sigmas of those errors that are observations of zero
    """
    if not (scatter or walk):
        return [block for block, _ in blocks], {}
    own: dict[Stretch, list[EquationBlock]] = {}
    for block, stretch in blocks:
        own.setdefault(stretch, []).append(_with_drift(block, stretch, bias))
    timed = [s for s in own if walk and np.isfinite(s.end)]
    scattered = [s for s in own if not (walk and np.isfinite(s.end))]
    result = [block for stretch in scattered for block in own[stretch]]
    for stretch, relations in _random_walks(timed, shared, scatter, walk):
        result += [*relations, *own[stretch]]
    return result, {name: scatter for stretch in scattered for name in _drifts(stretch)}


def _drifts(stretch: Stretch) -> tuple[Name, ...]:
    return tuple((f"drift {i}", stretch.name) for i in range(3))


def _ends(stretch: Stretch) -> tuple[Name, ...]:
    return tuple((f"drift at end {i}", stretch.name) for i in range(3))


def _with_drift(block: EquationBlock, stretch: Stretch, bias: int) -> EquationBlock:
    """The coefficients of a drift are those of the bias."""
    rows = np.empty((len(block.rows), block.rows.shape[1] + 3))
    rows[:, :-4] = block.rows[:, :-1]
    rows[:, -4:-1] = stretch.weight * block.rows[:, bias : bias + 3]
    rows[:, -1] = block.rows[:, -1]
    return EquationBlock(rows, (*block.own, *_drifts(stretch)), block.count, block.deviance)


def _random_walks(
    stretches: Sequence[Stretch], shared: int, scatter: float, walk: float
) -> Iterator[tuple[Stretch, list[EquationBlock]]]:
    """Every stretch in the order of time, with the relations of its drift to the others."""
    for clock, path, nearest, gaps in _paths(stretches):
        before = tuple((f"drift at end {i}", f"start {clock}") for i in range(3))
        for stretch, gap in zip(path, gaps, strict=True):
            relations = []
            if clock != COMMON_CLOCK and stretch is path[0]:
                recorded = sum(stretch.seconds for stretch in stretches)
                start_sigma = np.array([[walk * np.sqrt(recorded)]])
                relations.append(_relation(np.ones((1, 1)), start_sigma, before, shared))
            mean, mixed, end = (walk**2 * part for part in _increments(stretch, gap))
            lower = np.zeros((2, 2))
            lower[0, 0] = np.sqrt(mean + scatter**2)
            lower[1, 0] = mixed / lower[0, 0]
            lower[1, 1] = np.sqrt(end - lower[1, 0] ** 2)
            own, after = _drifts(stretch), _ends(stretch)
            change = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
            if clock == COMMON_CLOCK and before == _ends(nearest):
                relations.append(_relation(change[:, 1:], lower, (*own, *after), shared))
            elif clock == COMMON_CLOCK and stretch is nearest:
                relations.append(_relation(change[:, :2], lower, (*before, *own), shared))
            else:
                relations.append(_relation(change, lower, (*before, *own, *after), shared))
            yield stretch, relations
            before = after


def _paths(
    stretches: Sequence[Stretch],
) -> Iterator[tuple[str, list[Stretch], Stretch, list[float]]]:
    """By clock the stretches in the order of time, the one where a walk is 0, and the gap before.

    It is 0 at the end of the stretch that is nearest to the middle.
    """
    by_clock: dict[str, list[Stretch]] = {}
    for stretch in stretches:
        by_clock.setdefault(stretch.clock, []).append(stretch)
    for clock, some in by_clock.items():
        path = sorted(some, key=lambda stretch: stretch.start)
        middle = (path[0].start + path[-1].end) / 2
        nearest = min(path, key=lambda stretch: abs(stretch.end - middle))
        ends = [path[0].start, *(stretch.end for stretch in path[:-1])]
        gaps = [max(s.start - end, 0.0) for s, end in zip(path, ends, strict=True)]
        yield clock, path, nearest, gaps


def _increments(stretch: Stretch, gap: float) -> tuple[float, float, float]:
    """Of m − p and e − p per K²: variance of the first, covariance, variance of the second."""
    seconds = stretch.seconds
    return gap + seconds / 3, gap + seconds / 2, gap + seconds


def walk_covariance(stretches: Sequence[Stretch]) -> Array:
    """The covariance of the drifts of the stretches by a random walk of 1 per √s, (n, n)."""
    place = {stretch: i for i, stretch in enumerate(stretches)}
    covariance = np.zeros((len(stretches), len(stretches)))
    recorded = sum(stretch.seconds for stretch in stretches)
    for clock, path, nearest, gaps in _paths(stretches):
        some = np.array([place[stretch] for stretch in path])
        parts = [_increments(stretch, gap) for stretch, gap in zip(path, gaps, strict=True)]
        mean, mixed, end = np.array(parts).T
        # Forward from the end `first` − 1, and backward from it: what two means have in common is
        # all between there and the nearer one.
        first = path.index(nearest) + 1 if clock == COMMON_CLOCK else 0
        start = 0.0 if clock == COMMON_CLOCK else recorded
        after, before = some[first:], some[:first][::-1]
        to_mean = (end - 2 * mixed + mean)[:first][::-1], (end - mixed)[:first][::-1]
        covariance[np.ix_(after, after)] = start + _common(mean[first:], mixed[first:], end[first:])
        covariance[np.ix_(before, before)] = _common(*to_mean, end[:first][::-1])
    return covariance


def _common(mean: Array, mixed: Array, end: Array) -> Array:
    """The covariance of means after each other, from where the walk is 0, (n, n)."""
    passed = np.cumsum(end) - end
    nearer = np.minimum.outer(np.arange(len(end)), np.arange(len(end)))
    covariance = np.asarray((passed + mixed)[nearer])
    np.fill_diagonal(covariance, passed + mean)
    return covariance


def _relation(change: Array, lower: Array, names: tuple[Name, ...], shared: int) -> EquationBlock:
    """Changes of the drift, the same for three axes, with the covariance lower · lowerᵀ."""
    white = change / lower[0, 0]
    if len(lower) > 1:
        white[1] = (change[1] - lower[1, 0] * white[0]) / lower[1, 1]
    count, ends = change.shape
    rows = np.zeros((3 * count, shared + 3 * ends + 1))
    for axis in range(3):
        rows[axis::3, shared + axis : shared + 3 * ends : 3] = white
    deviance = 6 * float(np.sum(np.log(np.diag(lower))))
    return EquationBlock(rows, names, 0, deviance)

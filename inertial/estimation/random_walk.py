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
from scipy.linalg import solve_triangular

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
    start = float(np.nanmin([stretch.start for stretch in stretches]))
    span = float(np.nanmax([stretch.end for stretch in stretches])) - start

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
    rows = block.rows
    more = [rows[:, :-1], stretch.weight * rows[:, bias : bias + 3], rows[:, -1:]]
    return EquationBlock(
        np.hstack(more), (*block.own, *_drifts(stretch)), block.count, block.deviance
    )


def _random_walks(
    stretches: Sequence[Stretch], shared: int, scatter: float, walk: float
) -> Iterator[tuple[Stretch, list[EquationBlock]]]:
    """Every stretch in the order of time, with the relations of its drift to the others."""
    recorded = sum(stretch.seconds for stretch in stretches)
    by_clock: dict[str, list[Stretch]] = {}
    for stretch in stretches:
        by_clock.setdefault(stretch.clock, []).append(stretch)
    for clock, some in by_clock.items():
        path = sorted(some, key=lambda stretch: stretch.start)
        middle = (path[0].start + path[-1].end) / 2
        nearest = min(path, key=lambda stretch: abs(stretch.end - middle))
        before = tuple((f"drift at end {i}", f"start {clock}") for i in range(3))
        end = path[0].start
        for stretch in path:
            relations = []
            if clock != COMMON_CLOCK and stretch is path[0]:
                start_sigma = np.array([[walk * np.sqrt(recorded)]])
                relations.append(_relation(np.ones((1, 1)), start_sigma, before, shared))
            gap, seconds = max(stretch.start - end, 0.0), stretch.seconds
            covariance = np.array([[seconds / 3, seconds / 2], [seconds / 2, seconds]]) + gap
            covariance = walk**2 * covariance + np.diag([scatter**2, 0.0])
            lower: Array = np.linalg.cholesky(covariance).astype(np.float64)
            mean, after = _drifts(stretch), _ends(stretch)
            change = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
            if clock == COMMON_CLOCK and before == _ends(nearest):
                relations.append(_relation(change[:, 1:], lower, (*mean, *after), shared))
            elif clock == COMMON_CLOCK and stretch is nearest:
                relations.append(_relation(change[:, :2], lower, (*before, *mean), shared))
            else:
                relations.append(_relation(change, lower, (*before, *mean, *after), shared))
            yield stretch, relations
            before, end = after, stretch.end


def _relation(change: Array, lower: Array, names: tuple[Name, ...], shared: int) -> EquationBlock:
    """Changes of the drift, the same for three axes, with the covariance lower · lowerᵀ."""
    rows = np.kron(solve_triangular(lower, change, lower=True), np.eye(3))
    zeros = np.zeros((len(rows), shared))
    deviance = 6 * float(np.sum(np.log(np.diag(lower))))
    return EquationBlock(np.hstack([zeros, rows, zeros[:, :1]]), names, 0, deviance)

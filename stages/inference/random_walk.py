"""A bias that differs from stretch to stretch of a campaign: at random, or because it walks.

    bias of a stretch = bias + d,    d = scatter + mean of K W(t) over the stretch

W is Brownian. So over a stretch of T seconds, G seconds after the one before, from p at the end of
that to e at its own, the mean m and e have the covariance

    cov [m − p, e − p] = K² [[G + T/3, G + T/2], [G + T/2, G + T]].

Of every stretch d and e are unknowns, for each axis. The walk is 0 at the end of the stretch that
is nearest to the middle of the campaign, so the bias is that of then. Where logs have no common
clock each has a walk of its own, which comes from as far as that of all recorded time leads.

Source: IEEE Std 952-2020, rate random walk.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from stages.inference.between_stretches import Times
from stages.inference.elimination import Name, Part

Array = NDArray[np.float64]

COMMON = ""  # the clock of all logs, where they have one
FEWEST = 4  # stretches: fewer tell no random walk


@dataclass(frozen=True)
class Stretch:
    """A stretch of time in which the bias counts as one: a rest, a turn.

    `start`, `seconds`: s, NaN where not known; `clock`: by whose time; `weight`: how often it has
    the drift of its name.
    """

    name: str
    clock: str = COMMON
    start: float = np.nan
    seconds: float = np.nan
    weight: float = 1.0

    @property
    def end(self) -> float:
        """When it ends, s."""
        return self.start + self.seconds


def times_of(stretches: Sequence[Stretch], noise: float, largest: float) -> Times | None:
    """What their times can tell of a walk; None where too few stretches have one.

    `noise`: of the mean reading of a stretch; `largest`: walk that is thought of, per √s.
    """
    timed = [stretch for stretch in stretches if np.isfinite(stretch.end)]
    if len(timed) < FEWEST or not noise > 0:
        return None
    span = max(stretch.end for stretch in timed) - min(stretch.start for stretch in timed)
    return Times(noise, span, all(stretch.clock == COMMON for stretch in timed), largest)


def trend(stretches: Sequence[Stretch]) -> Callable[[Stretch], Stretch]:
    """Instead of a walk: a drift in proportion to the time before or after the middle."""
    start = float(np.nanmin([stretch.start for stretch in stretches]))
    span = float(np.nanmax([stretch.end for stretch in stretches])) - start

    def of(stretch: Stretch) -> Stretch:
        part = (stretch.start + stretch.seconds / 2 - start) / span - 0.5
        return Stretch("trend", weight=part if np.isfinite(part) else 0.0)

    return of


def drifting(
    parts: Sequence[tuple[Part, Stretch]],
    shared: int,
    bias: int,
    scatter: float,
    walk: float,
) -> tuple[list[Part], dict[Name, float]]:
    """Equations with the drifts as further errors, in an order in which few of them wait.

    Parameters
    ----------
    shared : how many unknowns all parts share; `bias`: the first of the three biases among them
    scatter, walk : unit of the readings; the same per √s

    Returns
    -------
    the parts, and the sigmas of those errors that are observations of zero
    """
    if not (scatter or walk):
        return [part for part, _ in parts], {}
    own: dict[Stretch, list[Part]] = {}
    for part, stretch in parts:
        own.setdefault(stretch, []).append(_drifted(part, stretch, shared, bias))
    walked = [s for s in own if walk and np.isfinite(s.end)]
    still = [s for s in own if not (walk and np.isfinite(s.end))]
    found = [part for stretch in still for part in own[stretch]]
    for stretch, relations in _paths(walked, shared, scatter, walk):
        found += [*relations, *own[stretch]]
    return found, {name: scatter for stretch in still for name in _drifts(stretch)}


def _drifts(stretch: Stretch) -> tuple[Name, ...]:
    return tuple((f"drift {i}", stretch.name) for i in range(3))


def _reached(stretch: Stretch) -> tuple[Name, ...]:
    return tuple((f"reached {i}", stretch.name) for i in range(3))


def _drifted(part: Part, stretch: Stretch, shared: int, bias: int) -> Part:
    """A drift is seen as the bias is."""
    rows = part.rows
    more = [rows[:, :-1], stretch.weight * rows[:, bias : bias + 3], rows[:, -1:]]
    return Part(np.hstack(more), (*part.own, *_drifts(stretch)), part.count, part.deviance)


def _paths(
    stretches: Sequence[Stretch], shared: int, scatter: float, walk: float
) -> Iterator[tuple[Stretch, list[Part]]]:
    """Every stretch in the order of time, with what its drift has to do with the others."""
    recorded = sum(stretch.seconds for stretch in stretches)
    by_clock: dict[str, list[Stretch]] = {}
    for stretch in stretches:
        by_clock.setdefault(stretch.clock, []).append(stretch)
    for clock, some in by_clock.items():
        path = sorted(some, key=lambda stretch: stretch.start)
        middle = (path[0].start + path[-1].end) / 2
        nearest = min(path, key=lambda stretch: abs(stretch.end - middle))
        before, left = tuple((f"reached {i}", f"start {clock}") for i in range(3)), path[0].start
        for stretch in path:
            relations = []
            if clock != COMMON and stretch is path[0]:
                away = np.array([[walk * np.sqrt(recorded)]])
                relations.append(_relation(np.ones((1, 1)), away, before, shared))
            gap, lasted = max(stretch.start - left, 0.0), stretch.seconds
            spread = np.array([[lasted / 3, lasted / 2], [lasted / 2, lasted]]) + gap
            spread = walk**2 * spread + np.diag([scatter**2, 0.0])
            lower: Array = np.linalg.cholesky(spread).astype(np.float64)
            mean, after = _drifts(stretch), _reached(stretch)
            change = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
            if clock == COMMON and before == _reached(nearest):
                relations.append(_relation(change[:, 1:], lower, (*mean, *after), shared))
            elif clock == COMMON and stretch is nearest:
                relations.append(_relation(change[:, :2], lower, (*before, *mean), shared))
            else:
                relations.append(_relation(change, lower, (*before, *mean, *after), shared))
            yield stretch, relations
            before, left = after, stretch.end


def _relation(change: Array, lower: Array, names: tuple[Name, ...], shared: int) -> Part:
    """Changes of the drift, the same for three axes, whose covariance is lower · lowerᵀ."""
    rows = np.kron(solve_triangular(lower, change, lower=True), np.eye(3))
    nothing = np.zeros((len(rows), shared))
    deviance = 6 * float(np.sum(np.log(np.diag(lower))))
    return Part(np.hstack([nothing, rows, nothing[:, :1]]), names, 0, deviance)

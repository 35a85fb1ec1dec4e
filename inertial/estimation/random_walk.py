"""A bias that differs from stretch to stretch: the equations of scatter and random walk.

    bias of a stretch = bias + d,    d = scatter + mean of K W(t) over the stretch

W is Brownian motion. So over a stretch of T seconds, G seconds after the one before, from p at the
end of that to e at its own end, the mean m and e have the covariance

    cov [m − p, e − p] = K² [[G + T/3, G + T/2], [G + T/2, G + T]].

d and e of every stretch are unknowns, for each axis. The random walk is 0 at the end of the stretch
that is nearest to the middle of the campaign, so the bias is that of this time. Logs without a
common clock have a random walk each, whose start has the variance that all recorded time leads to.

Scatter and random walk are alike on all axes, and estimated from what the stretches differ by. What
the noise within static stretches says of K and of a bias instability B, for each axis, is known
before and comes on top; see `noise_model`. Stretches without time have no such drift.

Source: IEEE Std 952-2020, rate random walk.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from inertial.arrays import Array
from inertial.estimation.elimination import EquationBlock, Name
from inertial.estimation.noise_model import Instability, moments

COMMON_CLOCK = ""  # the name of the clock of all logs, where they have one


@dataclass(frozen=True)
class Stretch:
    """A stretch of time with one drift of the bias: a static position, a rate segment.

    `start`, `seconds`: s, NaN where not known; `clock`: of these times; `weight`: of the drift of
    this name in the equations of the stretch; `switch_on`: since which the sensor has been running.
    """

    name: str
    clock: str = COMMON_CLOCK
    start: float = np.nan
    seconds: float = np.nan
    weight: float = 1.0
    switch_on: int = 0

    @property
    def end(self) -> float:
        """s."""
        return self.start + self.seconds


@dataclass(frozen=True, eq=False)
class MeasuredDrift:
    """What the noise within static stretches says of the drift of each axis, (3,), 0 if nothing.

    `instability`: B, unit of the readings; `walk`: K, the same per √s; `switch_on`: by what the
    bias differs from one switch-on to the next, (3,), unit of the readings, none: not yet known;
    `expected`: it is no more than the data sheet states; `stated`: of B what that states, (3,).
    """

    instability: Array
    walk: Array
    switch_on: Array | None = None
    expected: bool = False
    stated: Array = field(default_factory=lambda: np.zeros(3))

    def __bool__(self) -> bool:
        return bool(self.instability.any() or self.walk.any())

    @property
    def as_stated(self) -> "MeasuredDrift":
        """The same without what the noise within static stretches shows beyond the data sheet."""
        walk = np.zeros_like(self.walk)
        return replace(self, instability=self.stated, walk=walk, expected=True)

    def differs(self, stretches: Sequence[Stretch]) -> bool:
        """Whether the bias differs from one switch-on to the next in some stretches."""
        parts = {stretch.switch_on for stretch in stretches}
        return len(parts) > 1 and self.switch_on is not None and bool(self.switch_on.any())


NO_DRIFT = MeasuredDrift(np.zeros(3), np.zeros(3))


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
    measured: MeasuredDrift = NO_DRIFT,
) -> tuple[list[EquationBlock], dict[Name, float]]:
    """Equations with the drifts as further errors, ordered so that few errors stay pending.

    Parameters
    ----------
    shared : number of unknowns that all blocks share; `bias`: the first of the three biases in it
    scatter, walk : unit of the readings; the same per √s; both beyond what is `measured`

    Returns
    -------
    the blocks, and the sigmas of those errors that are observations of zero
    """
    blocks, switched = _with_switch_ons(blocks, bias, measured)
    if not (scatter or walk or measured):
        return [block for block, _ in blocks], switched
    own: dict[Stretch, list[EquationBlock]] = {}
    for block, stretch in blocks:
        own.setdefault(stretch, []).append(_with_drift(block, stretch, bias))
    timed = [s for s in own if (walk or measured) and np.isfinite(s.end)]
    scattered = [s for s in own if not ((walk or measured) and np.isfinite(s.end))]
    result = [block for stretch in scattered for block in own[stretch]]
    sigma = switched | {name: scatter for stretch in scattered for name in _drifts(stretch)}
    recorded = sum(stretch.seconds for stretch in timed)
    drifts = _drifts_of_axes(timed, scatter, walk, measured)
    for clock, path, nearest, gaps in _paths(timed):
        before = f"start {clock}"
        for drift in drifts:
            sigma |= drift.at_start(before, clock, recorded)
            if not drift.size:
                sigma |= {_drifts(stretch)[drift.axis]: scatter for stretch in path}
        zero = nearest.name if clock == COMMON_CLOCK else ""
        related = [d.relations(before, path, gaps, zero, shared) for d in drifts if d.size]
        for number, stretch in enumerate(path):
            result += [blocks[number] for blocks in related]
            result += own[stretch]
    return result, sigma


def _drifts_of_axes(
    timed: Sequence[Stretch], scatter: float, walk: float, measured: MeasuredDrift
) -> list["_Drift"]:
    unstable = timed and measured.instability.any()
    processes = instability_within(timed) if unstable else None
    slow = measured.instability * (processes.walk if processes else 0.0)
    walks = np.sqrt(walk**2 + measured.walk**2 + slow**2)
    return [
        _Drift(axis, scatter, float(walks[axis]), float(measured.instability[axis]), processes)
        for axis in range(3)
    ]


def _drifts(stretch: Stretch) -> tuple[Name, ...]:
    return tuple((f"drift {i}", stretch.name) for i in range(3))


def _with_switch_ons(
    blocks: Sequence[tuple[EquationBlock, Stretch]], bias: int, measured: MeasuredDrift
) -> tuple[Sequence[tuple[EquationBlock, Stretch]], dict[Name, float]]:
    """The blocks with a bias of each switch-on as further errors, and the sigmas of these."""
    sizes = measured.switch_on
    if sizes is None or not measured.differs([stretch for _, stretch in blocks]):
        return blocks, {}
    result, sigma = [], dict[Name, float]()
    for block, stretch in blocks:
        names = tuple((f"switch-on {i}", str(stretch.switch_on)) for i in range(3))
        sigma |= dict(zip(names, sizes.tolist(), strict=True))
        rows = np.hstack([block.rows[:, :-1], block.rows[:, bias : bias + 3], block.rows[:, -1:]])
        result.append((replace(block, rows=rows, own=(*block.own, *names)), stretch))
    return result, sigma


def _with_drift(block: EquationBlock, stretch: Stretch, bias: int) -> EquationBlock:
    """The coefficients of a drift are those of the bias."""
    rows = np.empty((len(block.rows), block.rows.shape[1] + 3))
    rows[:, :-4] = block.rows[:, :-1]
    rows[:, -4:-1] = stretch.weight * block.rows[:, bias : bias + 3]
    rows[:, -1] = block.rows[:, -1]
    return EquationBlock(rows, (*block.own, *_drifts(stretch)), block.count, block.deviance)


@dataclass(frozen=True)
class _Drift:
    """The drift of one axis. Its states: the random walk, if any, then the processes of B, if any.

    `walk`: K, per √s; `size`: number of states.
    """

    axis: int
    scatter: float
    walk: float
    instability: float
    processes: Instability | None

    @property
    def size(self) -> int:
        """The number of states."""
        return int(self.walk > 0) + len(self._constants)

    @property
    def _constants(self) -> Array:
        used = self.processes is not None and self.instability > 0
        return self.processes.constants if used and self.processes else np.zeros(0)

    @property
    def _variance(self) -> float:
        """Of each process."""
        return self.instability**2 * (self.processes.variance if self.processes else 0.0)

    def _names(self, stretch: str) -> tuple[Name, ...]:
        walk = [(f"drift at end {self.axis}", stretch)] if self.walk else []
        processes = range(len(self._constants))
        return (*walk, *((f"process {i} at end {self.axis}", stretch) for i in processes))

    def at_start(self, start: str, clock: str, recorded: float) -> dict[Name, float]:
        """The sigmas of the states at the start; a walk has none where it is 0 elsewhere."""
        names = self._names(start)
        sigma = dict.fromkeys(names[self.walk > 0 :], float(np.sqrt(self._variance)))
        if self.walk and clock != COMMON_CLOCK:
            sigma[names[0]] = self.walk * float(np.sqrt(recorded))
        return sigma

    def relations(
        self, start: str, path: Sequence[Stretch], gaps: Sequence[float], zero: str, shared: int
    ) -> list[EquationBlock]:
        """Of each mean drift and the states at the end to the states before, in units of sigma.

        `start`: before the first stretch of the path; `zero`: the stretch at whose end the random
        walk is 0, if any.
        """
        mean, kept, covariance = self._steps(np.array([s.seconds for s in path]), np.array(gaps))
        size, states = self.size, np.arange(self.size)
        change = np.zeros((len(path), 1 + size, 2 * size + 1))
        change[:, 0, :size] = -mean
        change[:, 1 + states, states] = -kept
        change[:, :, size:] = np.eye(1 + size)
        lower = np.linalg.cholesky(covariance)
        deviances = 2 * np.log(np.diagonal(lower, axis1=1, axis2=2)).sum(axis=1)
        padded = np.zeros((len(path), 1 + size, shared + 2 * size + 2))
        padded[:, :, shared:-1] = np.linalg.solve(lower, change)
        blocks, before = [], start
        for rows, stretch, deviance in zip(padded, path, deviances.tolist(), strict=True):
            names = (*self._names(before), _drifts(stretch)[self.axis], *self._names(stretch.name))
            if self.walk and zero in (before, stretch.name):
                walk = (before == zero, stretch.name == zero).index(True) * (size + 1)
                rows = np.delete(rows, shared + walk, axis=1)
                names = names[:walk] + names[walk + 1 :]
            blocks.append(EquationBlock(rows, names, 0, deviance))
            before = stretch.name
        return blocks

    def _steps(self, seconds: Array, gaps: Array) -> tuple[Array, Array, Array]:
        """How the mean and the states at the end follow from those before, of n stretches.

        The factors of the mean and of the states, (n, size) each, and the covariance of what is
        added to them, (n, 1 + size, 1 + size).
        """
        own, variance = self._constants, self._variance
        pause = np.exp(-gaps[:, None] / own)
        within, mixed, kept = moments(seconds[:, None], own)
        of_mean = variance * (within - mixed**2 + mixed**2 * (1 - pause**2))
        of_both = variance * (mixed - mixed * kept + mixed * kept * (1 - pause**2))
        of_end = variance * -np.expm1(-2 * (seconds + gaps)[:, None] / own)
        mean, end = mixed * pause, kept * pause
        if self.walk:
            parts = [self.walk**2 * part[:, None] for part in _increments(seconds, gaps)]
            of_mean, of_both, of_end = (
                np.hstack(each) for each in zip(parts, (of_mean, of_both, of_end), strict=True)
            )
            one = np.ones((len(seconds), 1))
            mean, end = np.hstack([one, mean]), np.hstack([one, end])
        covariance = np.zeros((len(seconds), 1 + self.size, 1 + self.size))
        covariance[:, 0, 0] = self.scatter**2 + of_mean.sum(axis=1)
        if self.processes is not None:
            covariance[:, 0, 0] += self.instability**2 * self.processes.white(seconds)
        states = 1 + np.arange(self.size)
        covariance[:, states, states] = of_end
        covariance[:, 0, 1:] = covariance[:, 1:, 0] = of_both
        return mean, end, covariance


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


def _increments(seconds: Array, gaps: Array) -> tuple[Array, Array, Array]:
    """Of m − p and e − p per K²: variance of the first, covariance, variance of the second."""
    return gaps + seconds / 3, gaps + seconds / 2, gaps + seconds


def walk_covariance(stretches: Sequence[Stretch]) -> Array:
    """The covariance of the drifts of the stretches by a random walk of 1 per √s, (n, n)."""
    place = {stretch: i for i, stretch in enumerate(stretches)}
    covariance = np.zeros((len(stretches), len(stretches)))
    recorded = sum(stretch.seconds for stretch in stretches)
    for clock, path, nearest, gaps in _paths(stretches):
        some = np.array([place[stretch] for stretch in path])
        seconds = np.array([stretch.seconds for stretch in path])
        mean, mixed, end = _increments(seconds, np.array(gaps))
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


def instability_within(stretches: Sequence[Stretch]) -> Instability:
    """The processes that change within a campaign: by its span, or by what is recorded of it."""
    seconds = [stretch.seconds for stretch in stretches]
    span = sum(seconds)
    if all(stretch.clock == COMMON_CLOCK for stretch in stretches):
        span = max(s.end for s in stretches) - min(s.start for s in stretches)
    return Instability.between(min(seconds), span)


def measured_covariance(stretches: Sequence[Stretch], measured: MeasuredDrift) -> Array:
    """The covariance of the drifts of each axis by what is measured, (3, n, n); 0 without times."""
    timed = [i for i, stretch in enumerate(stretches) if np.isfinite(stretch.end)]
    covariance = np.zeros((3, len(stretches), len(stretches)))
    if measured.switch_on is not None and measured.differs(stretches):
        parts = np.array([stretch.switch_on for stretch in stretches])
        covariance += np.multiply.outer(measured.switch_on**2, np.equal.outer(parts, parts))
    if not (timed and measured):
        return covariance
    own = list(dict.fromkeys(stretches[i] for i in timed))
    place = {stretch: i for i, stretch in enumerate(own)}
    walk, flicker = walk_covariance(own), np.zeros((len(own), len(own)))
    processes = instability_within(own)
    for _, path, _, _ in _paths(own):
        there = np.ix_(*[[place[stretch] for stretch in path]] * 2)
        flicker[there] = processes.covariance([s.start for s in path], [s.seconds for s in path])
    squares = measured.instability**2
    walks = measured.walk**2 + squares * processes.walk**2
    each = np.multiply.outer(walks, walk) + np.multiply.outer(squares, flicker)
    of = [place[stretches[i]] for i in timed]
    covariance[np.ix_(range(3), timed, timed)] += each[np.ix_(range(3), of, of)]
    return covariance

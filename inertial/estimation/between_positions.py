"""The gyros from the motions between static positions of unknown attitude.

    C v₁ = v₂,    C: from the rates M⁻¹ (reading − bias) − Ω, integrated from one rest to the next
    mean reading at rest = M · Ω + bias + noise

v₁, v₂ are the upward directions by the accelerometers at both rests: two equations for each motion
(Tedaldi, Pretto & Menegatti, ICRA 2014). So M is that of the gyros against the axes of the
accelerometers, those of `free_positions`; its mounting rotation is of one triad against the other.
The readings of the accelerometers are in the equations too, for an error of theirs at one rest is
in the motion before it and in the one after, and one of their parameters in all.

Ω is the earth's rate: its upward component lies along v; its horizontal component, of known size
and unknown direction, is two unknowns for all rests that uninterrupted motions join, for the gyros
propagate it. The noise of a motion rotates all later directions, so its covariance is integrated.

Where samples are timed by stamps of arrival, the rate of the clock of each log is an unknown too:
where it is too slow, all motions of the log have turned by as much more, as with a smaller M.

Rests and motions differ beyond noise by what `scatter_and_random_walk` describes.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Array
from inertial.estimation import multi_position as forces
from inertial.estimation.attitude import IntegratedMotion, Passage, integrate, integrated_motion
from inertial.estimation.elimination import EquationBlock, Name, eliminate, whitened
from inertial.estimation.gyroscope_observations import EARTH_UP, Earth
from inertial.estimation.gyroscopes import PRIOR, PRIOR_SIGMA
from inertial.estimation.least_squares import (
    Estimate,
    System,
    counted,
    in_order,
    remaining,
    solve_stepped,
    with_errors_in_order,
)
from inertial.estimation.multi_position import FreeRest, Upward, upward_of
from inertial.estimation.scatter_and_random_walk import (
    Scatter,
    ScatterFit,
    contradicting,
    likeliest,
)
from inertial.estimation.triad import UNKNOWNS, design_of
from inertial.physics.motion import cross, horizontal

ROUNDS = 2  # of the scatter, about the last result
NONE = Scatter()
SCALES = np.geomspace(0.5, 2.0, 29)  # of the gyros, where the search for M begins: 5 % apart


@dataclass(frozen=True)
class Rows:
    """Coefficients (m, p), residuals (m,) and their covariance (m, m) of a rest or a motion.

    `response`: (m, s, 3), of the residuals to errors of the mean rates in s stretches of it;
    `seconds`: of all of it; `by_rate`, `by_swing`: (m, m), what a scatter of unit variance adds to
    the covariance, of the mean rates, (rad/s)², and of the angle, rad².
    """

    design: Array
    rest: Array
    response: Array
    seconds: float
    noise: Array
    by_rate: Array
    by_swing: Array

    def independent(self, rate: float, swing: float) -> tuple[Array, Array]:
        """Orthogonal combinations of the rows that are independent, (m, m), and their sigma, (m,).

        `rate`: rad/s, `swing`: rad, the sigmas of the scatter.
        """
        covariance = self.noise + rate**2 * self.by_rate + swing**2 * self.by_swing
        variance, axes = np.linalg.eigh(covariance)
        return axes.T, np.sqrt(variance)


@dataclass(frozen=True)
class Stop:
    """A rest of so many seconds: accelerometers, mean rates and their sigma, rad/s, (3,) each."""

    forces: FreeRest
    mean: Array
    sigma: Array
    seconds: float


@dataclass(frozen=True)
class Prior:
    """Prior information: gravity and its sigma, m/s², and the earth's rate.

    `scatter`: m/s², of the accelerometers between rests, beyond noise.
    """

    gravity: float
    gravity_sigma: float
    scatter: float
    earth: Earth


def fit(
    stops: Sequence[Stop], passages: Sequence[Passage], known: Prior, noise_degrees: float = np.inf
) -> tuple[ScatterFit, list[int]]:
    """M by rows and bias of the gyros, in the order of `triad`, all other unknowns, and omissions.

    `stops` in the order of time. With the scatters of largest restricted likelihood; that is of the
    equations linear about the last result. Left out are stops, then passages, by number; of a stop
    the gyros alone.
    """
    stops, places, left_out = list(stops), list(range(len(passages))), list[int]()
    while True:
        data = _data(stops, [passages[i] for i in places], known)
        about = in_order(_solved(data, NONE, data.start), data.names)
        for _ in range(ROUNDS):
            found, scatter = likeliest(
                _Linear.about(data, about).estimate, noise_degrees, tested=False
            )
            if scatter == NONE:
                break
            estimate = _solved(data, scatter, about)
            found, about = replace(found, estimate=estimate), in_order(estimate, data.names)
        parts = dict(rows_of_rates(data, about))
        residuals = [_whitened(parts[i], data, scatter) for i in range(len(parts))]
        firsts = [passages[i].first for i in places]
        worst = contradicting(residuals, range(len(stops)), firsts)
        if not worst:
            usual = data.usual if scatter.sways else None
            return replace(found, scatter_seconds=usual), sorted(left_out)
        for number in worst:
            if number < len(stops):
                stops[number] = replace(stops[number], mean=np.full(3, np.nan))
                left_out.append(number)
            else:
                left_out.append(len(stops) + places[number - len(stops)])
        places = [i for i in places if len(stops) + i not in left_out]


def _whitened(rows: Rows, data: "Unknowns", scatter: Scatter) -> Array:
    turn, sigma = rows.independent(scatter.of_rate(rows.seconds, data.usual), scatter.swing)
    return turn @ rows.rest / sigma


@dataclass(frozen=True)
class Unknowns:
    """The unknowns of the equations, their places, and the data that they belong to.

    These are: the gyros' parameters, those of the accelerometers, two for each direction, two for
    the horizontal rate of each chain of stops, the rate of the clock of each log that has no stamps
    of sampling, gravity, and the earth's upward rate.
    """

    stops: Sequence[Stop]
    passages: Sequence[Passage]
    known: Prior
    up: Upward

    @property
    def start(self) -> Array:
        """First values of the unknowns.

        One scale for all gyros, for with one that is far off a turn ends anywhere: that by which
        the upward directions, carried on, come nearest to those of the accelerometers.
        """
        start = self.prior
        means = np.array([stop.mean for stop in self.stops])
        read = np.isfinite(means).any(axis=0)
        start[UNKNOWNS - 3 : UNKNOWNS][read] = np.nanmedian(means[:, read], axis=0)

        def miss(scale: float) -> float:
            return sum(
                1 - float(self.up.first[p.first + 1] @ whole @ self.up.first[p.first])
                for p in self.passages
                for rates in [(p.rates - start[UNKNOWNS - 3 : UNKNOWNS]) / scale]
                for whole in [integrate(rates, p.seconds).whole]
            )

        if self.passages:
            start[:9] *= min(SCALES.tolist(), key=miss)
        return start

    def integrated(self, around: Array) -> list[IntegratedMotion]:
        """The motions by the gyros with the M and bias of `around`."""
        matrix, bias = around[:9].reshape(3, 3), around[9:UNKNOWNS]
        late = [0.0 if (place := self.clock(p)) is None else around[place] for p in self.passages]
        timed = [
            replace(passage, seconds=passage.seconds / (1 + error))
            for passage, error in zip(self.passages, late, strict=True)
        ]
        return [integrated_motion(passage, matrix, bias) for passage in timed]

    @cached_property
    def usual(self) -> float:
        """The usual length of a rest, s."""
        return float(np.median([stop.seconds for stop in self.stops]))

    @cached_property
    def chains(self) -> list[list[int]]:
        """The stops that uninterrupted motions join."""
        joined = {passage.first for passage in self.passages}
        chains: list[list[int]] = []
        for i in range(len(self.stops)):
            if i - 1 in joined:
                chains[-1].append(i)
            else:
                chains.append([i])
        return chains

    @property
    def parameters(self) -> int:
        return UNKNOWNS + forces.FREE + 2 * len(self.stops)

    @property
    def directions(self) -> slice:
        return slice(UNKNOWNS + forces.FREE, self.parameters)

    @cached_property
    def apart(self) -> NDArray[np.int_]:
        """The places of the directions and of the horizontal rates of chains."""
        return np.arange(UNKNOWNS + forces.FREE, self.parameters + 2 * len(self.chains))

    @cached_property
    def shared(self) -> NDArray[np.int_]:
        """The places of all others."""
        return np.setdiff1d(np.arange(self.size), self.apart)

    def level(self, chain: int) -> slice:
        return slice(self.parameters + 2 * chain, self.parameters + 2 * chain + 2)

    @cached_property
    def clocks(self) -> dict[str, float]:
        """The relative sigma of the rate of each clock that is uncertain."""
        return {p.clock: p.clock_sigma for p in self.passages if p.clock_sigma}

    def clock(self, passage: Passage) -> int | None:
        """The place of the rate of its clock, None where that is certain."""
        if not passage.clock_sigma:
            return None
        return self.size - 2 - len(self.clocks) + [*self.clocks].index(passage.clock)

    @property
    def size(self) -> int:
        return self.parameters + 2 * len(self.chains) + len(self.clocks) + 2

    @property
    def of_forces(self) -> NDArray[np.int_]:
        """The unknowns of `free_positions` among all."""
        return np.append(np.arange(UNKNOWNS, self.parameters), self.size - 2)

    @property
    def prior(self) -> Array:
        middle = np.zeros(2 * len(self.stops) + 2 * len(self.chains) + len(self.clocks))
        ends = [self.known.gravity, self.known.earth.up]
        return np.concatenate([PRIOR, forces.PRIOR, middle, ends])

    @property
    def prior_sigma(self) -> Array:
        directions = np.full(2 * len(self.stops), forces.DIRECTION_SIGMA)
        level = np.full(2 * len(self.chains), self.known.earth.level / np.sqrt(2))
        ends = [self.known.gravity_sigma, self.known.earth.up_sigma]
        clocks = [*self.clocks.values()]
        return np.concatenate([PRIOR_SIGMA, forces.PRIOR_SIGMA, directions, level, clocks, ends])

    @property
    def names(self) -> tuple[tuple[str, str], ...]:
        stops = [stop.forces.name for stop in self.stops]
        return (
            *(("parameter", str(i)) for i in range(UNKNOWNS)),
            *(("accelerometer", name) for name in forces.NAMES),
            *((f"direction {i}", name) for name in stops for i in (0, 1)),
            *((f"level {i}", stops[chain[0]]) for chain in self.chains for i in (0, 1)),
            *(("clock", clock) for clock in self.clocks),
            ("gravity", ""),
            EARTH_UP,
        )


@dataclass(frozen=True)
class _Linear:
    """The equations of all stops and of the motions between them about one point, (p,).

    Directions and the horizontal rate of a chain are in the equations of the stops and motions
    beside them alone, from which they are eliminated one after another: so time grows as n.

    `rest`: of the accelerometers in units of their sigma; `blocks`: those equations; `parts`: of
    each stop and passage by number its rows, and these with the observation, of the shared unknowns
    and its `own`.
    """

    data: Unknowns
    around: Array
    rest: Array
    blocks: Sequence[EquationBlock]
    parts: Mapping[int, tuple[Rows, Array, tuple[Name, ...]]]

    @classmethod
    def about(cls, data: Unknowns, around: Array) -> "_Linear":
        """Linear about these unknowns."""
        away, names, apart = around - data.prior, data.names, data.apart

        def compact(design: Array, rest: Array) -> tuple[Array, tuple[Name, ...]]:
            own = apart[design[:, apart].any(axis=0)]
            rows = np.column_stack([design[:, data.shared], design[:, own], rest + design @ away])
            return rows, tuple(names[i] for i in own.tolist())

        design, rest, sigma = rows_of_forces(data, around)
        blocks = []
        for i in range(0, len(rest), 3):
            rows, own = compact(design[i : i + 3], rest[i : i + 3])
            blocks.append(whitened(rows, sigma[i : i + 3], own))
        parts = {
            number: (rows, *compact(rows.design, rows.rest))
            for number, rows in rows_of_rates(data, around)
        }
        return cls(data, around, rest / sigma, blocks, parts)

    def squares(self, scatter: Scatter) -> float:
        """The sum of squares at this point, in units of their sigma."""
        away = (self.around - self.data.prior) / self.data.prior_sigma
        residuals = [_whitened(rows, self.data, scatter) for rows, *_ in self.parts.values()]
        return float(self.rest @ self.rest + away @ away) + sum(float(r @ r) for r in residuals)

    def system(self, scatter: Scatter) -> System:
        """The equations of the unknowns that all share."""
        data, shared = self.data, self.data.shared
        blocks: list[EquationBlock] = []
        for number, (rows, design, own) in self.parts.items():
            if number < len(data.stops):
                blocks.append(self.blocks[number])
            rate = scatter.of_rate(rows.seconds, data.usual)
            turn, sigma = rows.independent(rate, scatter.swing)
            blocks.append(whitened(turn @ design, sigma, own))
        prior, prior_sigma, names = data.prior, data.prior_sigma, data.names
        known = {names[i]: float(prior_sigma[i]) for i in data.apart.tolist()}
        # What no equation holds, as of a stop whose gyros are left out, keeps its prior.
        held = {name for block in blocks for name in block.own}
        silent = tuple(name for name in known if name not in held)
        blocks.append(EquationBlock(np.zeros((0, len(shared) + len(silent) + 1)), silent, 0, 0.0))
        return remaining(
            *eliminate(blocks, len(shared), known),
            prior[shared],
            prior_sigma[shared],
            UNKNOWNS + forces.FREE,
            tuple(names[i] for i in shared.tolist()),
        )

    def estimate(self, scatter: Scatter) -> Estimate:
        """The estimate of these equations."""
        return _counted(self.data, self.system(scatter).solve())


def _counted(data: Unknowns, estimate: Estimate) -> Estimate:
    """With the degrees of freedom that parameters and directions leave; errors in their order."""
    vague = zip(data.names[: data.parameters], data.prior_sigma.tolist(), strict=False)
    return with_errors_in_order(counted(estimate, dict(vague)), data.names)


def _solved(data: Unknowns, scatter: Scatter, start: Array) -> Estimate:
    """The estimate about which the equations with this scatter are linear."""

    @lru_cache(maxsize=1)
    def at(around: bytes) -> _Linear:
        return _Linear.about(data, np.frombuffer(around))

    estimate = solve_stepped(
        lambda around: (at(around.tobytes()).system(scatter), data.names),
        lambda around: at(around.tobytes()).squares(scatter),
        start,
    )
    return _counted(data, estimate)


def rows_of_forces(data: Unknowns, around: Array) -> tuple[Array, Array, Array]:
    """The accelerometers at every stop: coefficients (m, p), residuals and their sigma (m,)."""
    place = data.of_forces
    rests = [stop.forces for stop in data.stops]
    own, observed, sigma = forces.readings(rests, data.up, data.known.scatter, around[place])
    own = own.reshape(-1, len(place))
    design = np.zeros((len(own), data.size))
    design[:, place] = own
    return design, observed.ravel() - own @ around[place], sigma.ravel()


def rows_of_rates(data: Unknowns, around: Array) -> Iterator[tuple[int, Rows]]:
    """The gyros at every stop, and in the motion to the next."""
    places = around[data.directions].reshape(-1, 2)
    ups, changes = data.up.at(places)
    passages = {passage.first: number for number, passage in enumerate(data.passages)}
    motions = data.integrated(around)
    for number, chain in enumerate(data.chains):
        first = _level(ups[chain[0]], data.up.across[chain[0], 0])
        at_stop = _AtStop(data, around, ups, changes, data.level(number), first)
        for i in chain:
            yield i, at_stop.at_rest(i)
            if i in passages:
                motion = motions[passages[i]]
                turned = motion.relative_to_earth(at_stop.earth(i))
                rows = at_stop.motion(i, motion, turned, data.clock(data.passages[passages[i]]))
                yield len(data.stops) + passages[i], rows
                at_stop = at_stop.at_next(turned)


def _data(stops: Sequence[Stop], passages: Sequence[Passage], known: Prior) -> "Unknowns":
    """About the directions of the readings."""
    return Unknowns(
        stops, passages, known, upward_of(np.array([stop.forces.mean for stop in stops]))
    )


def _level(up: Array, about: Array) -> Array:
    """Two horizontal directions, (2, 3), the first as near as possible to `about`."""
    first = horizontal(about, up)
    return np.array([first, cross(up, first)])


@dataclass(frozen=True)
class _AtStop:
    """The point of linearisation, and the horizontal rate of a chain at one of its stops.

    `ups`: (n, 3); `changes`: (n, 2, 3), of them; `level`: (2, 3), rates per unit of the unknowns
    at `place`.
    """

    data: Unknowns
    around: Array
    ups: Array
    changes: Array
    place: slice
    level: Array

    @property
    def matrix(self) -> Array:
        return self.around[:9].reshape(3, 3)

    @property
    def bias(self) -> Array:
        return self.around[9:UNKNOWNS]

    def earth(self, i: int) -> Array:
        """The earth's rate in body axes at stop i, (3,), rad/s."""
        return np.asarray(self.around[-1] * self.ups[i] + self.around[self.place] @ self.level)

    def at_next(self, turned: Array) -> "_AtStop":
        """The same at the next stop."""
        level = self.level @ turned.T
        there = (self.around, self.ups, self.changes, self.place)
        return _AtStop(self.data, *there, level)

    def at_rest(self, i: int) -> Rows:
        stop, direction = self.data.stops[i], self.data.directions.start + 2 * i
        design = np.zeros((3, self.data.size))
        design[:, :UNKNOWNS] = design_of(self.earth(i))
        design[:, direction : direction + 2] = self.around[-1] * self.matrix @ self.changes[i].T
        design[:, self.place] = self.matrix @ self.level.T
        design[:, -1] = self.matrix @ self.ups[i]
        rest = stop.mean - self.matrix @ self.earth(i) - self.bias
        there = np.isfinite(rest) & np.isfinite(stop.sigma)  # a gyro may be missing
        noise, unit = np.diag(stop.sigma[there] ** 2), np.eye(int(there.sum()))
        response = np.eye(3)[there, None]
        return Rows(design[there], rest[there], response, stop.seconds, noise, unit, 0 * unit)

    def motion(self, i: int, motion: IntegratedMotion, turned: Array, clock: int | None) -> Rows:
        """The next upward direction against this one rotated there, along two horizontal axes.

        `clock`: the place of the rate of its clock among the unknowns, if it is one.
        """
        across = self.data.up.across[i + 1]  # (2, 3)
        rotated = turned @ self.ups[i]
        # A rotation φ of the body takes a direction v to v + v × φ.
        lever = cross(across, rotated)  # across · (v × φ) = (across × v) · φ
        direction = self.data.directions.start + 2 * i
        design = np.zeros((2, self.data.size))
        design[:, :UNKNOWNS] = -lever @ motion.slope
        design[:, direction : direction + 2] = -across @ turned @ self.changes[i].T
        design[:, direction + 2 : direction + 4] = across @ self.changes[i + 1].T
        design[:, self.place] = motion.seconds * lever @ turned @ self.level.T
        design[:, -1] = motion.seconds * lever @ turned @ self.ups[i]
        if clock is not None:  # where time is too long, M is too large by the same share
            design[:, clock] = design[:, :9] @ self.matrix.ravel() / (1 + self.around[clock])
        rest = across @ (rotated - self.ups[i + 1])
        noise, swing = lever @ motion.white @ lever.T, lever @ lever.T
        response = np.einsum("mi,sij->msj", lever, motion.response)
        seconds = motion.seconds
        return Rows(design, rest, response, seconds, noise, seconds**2 * swing, swing)

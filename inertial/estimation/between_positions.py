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

Rests and motions differ beyond noise by what `scatter_by_hand` describes.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from inertial.estimation import multi_position as forces
from inertial.estimation.attitude import integrate
from inertial.estimation.carried_attitude import IntegratedMotion, Passage, integrated_motion
from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.elimination import whitened
from inertial.estimation.gyroscope_observations import Earth
from inertial.estimation.gyroscopes import PRIOR, PRIOR_SIGMA
from inertial.estimation.least_squares import Estimate, System, solve_iterated
from inertial.estimation.multi_position import FreeRest, Upward, upward_of
from inertial.estimation.random_walk import Stretch
from inertial.estimation.scatter_by_hand import Scatter, contradicting, likeliest
from inertial.estimation.sensitivities import Sensitivities
from inertial.estimation.triad import UNKNOWNS, design_of
from inertial.estimation.variance_components import ScatterFit
from inertial.physics.motion import cross

Array = NDArray[np.float64]

ROUNDS = 2  # of the scatter, about the last result
NONE = Scatter()
SCALES = np.geomspace(0.5, 2.0, 29)  # of the gyros, where the search for M begins: 5 % apart


@dataclass(frozen=True)
class Rows:
    """Coefficients (m, p), residuals (m,) and their sigma (m,) of a rest or a motion.

    `response`: (m, s, 3), of the residuals to errors of the mean rates in s stretches of it.
    """

    design: Array
    rest: Array
    sigma: Array
    response: Array


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


def between_rests(
    stops: Sequence[Stop],
    passages: Sequence[Passage],
    known: Prior,
    scatter: Scatter = NONE,
) -> Estimate:
    """M by rows and bias of the gyros, in the order of `triad`, and all other unknowns.

    `stops` in the order of time.
    """
    data = replace(_data(stops, passages, known), scatter=scatter)
    return solve_iterated(partial(equations, data), data.start)


def fit(
    stops: Sequence[Stop], passages: Sequence[Passage], known: Prior, noise_degrees: float = np.inf
) -> tuple[ScatterFit, list[int]]:
    """The same with the scatters of largest restricted likelihood, and what is left out.

    The likelihood is that of the equations linear about the last result. Left out are stops, then
    passages, by number; of a stop the gyros alone.
    """
    stops, places, left_out = list(stops), list(range(len(passages))), list[int]()
    while True:
        data = _data(stops, [passages[i] for i in places], known)
        about = solve_iterated(partial(equations, data), data.start).values
        for _ in range(ROUNDS):
            found, scatter = likeliest(partial(_linear, data, about), noise_degrees)
            if scatter == NONE:
                break
            best = replace(data, scatter=scatter)
            found = replace(found, estimate=solve_iterated(partial(equations, best), about))
            about = found.estimate.values
        parts = dict(_of_rates(replace(data, scatter=scatter), about))
        residuals = [_whitened(parts[i]) for i in range(len(parts))]
        worst = contradicting(residuals, len(stops))
        if worst is None:
            return found, sorted(left_out)
        if worst < len(stops):
            stops[worst] = replace(stops[worst], mean=np.full(3, np.nan))
            left_out.append(worst)
        else:
            left_out.append(len(stops) + places.pop(worst - len(stops)))


def _whitened(rows: Rows) -> Array:
    there = np.isfinite(rows.rest) & np.isfinite(rows.sigma)
    return rows.rest[there] / rows.sigma[there]


def _linear(data: "_Data", about: Array, scatter: Scatter) -> Estimate:
    return equations(replace(data, scatter=scatter), about).solve()


@dataclass(frozen=True)
class _Data:
    """The data of the equations, and the places of their unknowns.

    These are: the gyros' parameters, those of the accelerometers, two for each direction, two for
    the horizontal rate of each chain of stops, gravity, and the earth's upward rate.
    """

    stops: Sequence[Stop]
    passages: Sequence[Passage]
    known: Prior
    up: Upward
    scatter: Scatter = NONE
    _integrated: dict[bytes, list[IntegratedMotion]] = field(default_factory=dict, repr=False)

    @property
    def start(self) -> Array:
        """First values of the unknowns.

        One scale for all gyros, for with one that is far off a turn ends anywhere: that by which
        the upward directions, carried on, come nearest to those of the accelerometers.
        """
        start = self.prior
        start[UNKNOWNS - 3 : UNKNOWNS] = np.nanmedian([stop.mean for stop in self.stops], axis=0)

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
        """The motions by the gyros with the M and bias of `around`; those of the last are kept."""
        key = around[:UNKNOWNS].tobytes()
        if key not in self._integrated:
            self._integrated.clear()
            matrix, bias = around[:9].reshape(3, 3), around[9:UNKNOWNS]
            self._integrated[key] = [integrated_motion(p, matrix, bias) for p in self.passages]
        return self._integrated[key]

    def between(self, seconds: float) -> float:
        """Scatter of the mean rates of a rest or a motion of so many seconds, rad/s."""
        if not self.scatter.sways:
            return self.scatter.rate
        usual = float(np.median([stop.seconds for stop in self.stops]))
        return self.scatter.rate * usual / seconds

    @property
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

    def level(self, chain: int) -> slice:
        return slice(self.parameters + 2 * chain, self.parameters + 2 * chain + 2)

    @property
    def size(self) -> int:
        return self.parameters + 2 * len(self.chains) + 2

    @property
    def of_forces(self) -> NDArray[np.int_]:
        """The unknowns of `free_positions` among all."""
        return np.append(np.arange(UNKNOWNS, self.parameters), self.size - 2)

    @property
    def prior(self) -> Array:
        middle = np.zeros(2 * len(self.stops) + 2 * len(self.chains))
        ends = [self.known.gravity, self.known.earth.up]
        return np.concatenate([PRIOR, forces.PRIOR, middle, ends])

    @property
    def prior_sigma(self) -> Array:
        directions = np.full(2 * len(self.stops), forces.DIRECTION_SIGMA)
        level = np.full(2 * len(self.chains), self.known.earth.level / np.sqrt(2))
        ends = [self.known.gravity_sigma, self.known.earth.up_sigma]
        return np.concatenate([PRIOR_SIGMA, forces.PRIOR_SIGMA, directions, level, ends])

    @property
    def names(self) -> tuple[tuple[str, str], ...]:
        stops = [stop.forces.name for stop in self.stops]
        return (
            *(("parameter", str(i)) for i in range(UNKNOWNS)),
            *(("accelerometer", name) for name in forces.NAMES),
            *((f"direction {i}", name) for name in stops for i in (0, 1)),
            *((f"level {i}", stops[chain[0]]) for chain in self.chains for i in (0, 1)),
            ("gravity", ""),
            ("earth", "up"),
        )


def equations(data: _Data, around: Array) -> System:
    """The equations of all stops and of the motions between them, linear about `around`."""
    parts = [rows for _, rows in _parts(data, around)]
    design, rest, sigma = (
        np.concatenate([getattr(rows, name) for rows in parts])
        for name in ("design", "rest", "sigma")
    )
    finite = np.isfinite(rest) & np.isfinite(sigma)  # a gyro may be missing
    design = design[finite]
    return System(
        design,
        rest[finite] + design @ around,
        sigma[finite],
        data.prior,
        data.prior_sigma,
        data.parameters,
        data.names,
    )


@dataclass(frozen=True)
class Carried:
    """What effects do to each stop and to the motion after it, and when these were.

    `at_stops`: (3, k) of each stop; `moving`: (s, 3, k) of each passage in its stretches;
    `stretches`: of time, of the stops, then of the passages.
    """

    at_stops: Sequence[Sensitivities]
    moving: Sequence[Sensitivities]
    stretches: Sequence[Stretch]


def drifting(
    stops: Sequence[Stop],
    passages: Sequence[Passage],
    known: Prior,
    about: tuple[Array, Array, Array, Array],
    carried: Carried,
    effect_sigma: Mapping[str, float],
    scatter: Scatter,
    used: Sequence[bool],
) -> DriftingEquations:
    """The equations with parameters of effects as further unknowns, in blocks.

    `about`: M and bias of the gyros, then P and bias of the accelerometers, about which they are
    linear; `used`: of each stop, then of each passage, whether its gyros are.
    """
    matrix, bias, symmetric, force_bias = about
    means = np.array([stop.forces.mean for stop in stops])
    up = upward_of((means - force_bias) @ np.linalg.inv(symmetric).T)
    data = _Data(stops, passages, known, up, scatter)
    around = data.prior
    pairs = [symmetric[i, j] for i, j in forces.PAIRS]
    around[: UNKNOWNS + forces.FREE] = [*matrix.ravel(), *bias, *pairs, *force_bias]
    shared, effects = data.size + len(effect_sigma), list(effect_sigma)
    prior = np.append(data.prior, np.zeros(len(effects)))
    answers = [each.of(effects)[None] for each in carried.at_stops]
    answers += [each.of(effects) for each in carried.moving]
    stretches = [Stretch("forces"), *carried.stretches]
    blocks = []
    for number, rows in _parts(data, around):
        if number is not None and not used[number]:
            continue
        stacked = np.zeros((len(rows.rest), shared + 1))
        stacked[:, : data.size] = rows.design
        if number is not None:
            stacked[:, data.size : -1] = np.einsum("msi,sik->mk", rows.response, answers[number])
        stacked[:, -1] = rows.rest + rows.design @ (around - data.prior)
        stretch = stretches[0 if number is None else number + 1]
        blocks.append((whitened(stacked, rows.sigma, ()), stretch))
    return DriftingEquations(
        blocks,
        [stretch.name for _, stretch in blocks],
        {},
        prior,
        np.append(data.prior_sigma, list(effect_sigma.values())),
        (*data.names, *(("effect", name) for name in effects)),
        UNKNOWNS - 3,
        data.parameters,
    )


def _parts(data: _Data, around: Array) -> Iterator[tuple[int | None, Rows]]:
    """The equations in parts: those of the forces, None; of each stop; of each passage after."""
    yield None, _of_forces(data, around)
    yield from _of_rates(data, around)


def _of_forces(data: _Data, around: Array) -> Rows:
    """The accelerometers at every stop."""
    place = data.of_forces
    rests = [stop.forces for stop in data.stops]
    own, observed, sigma = forces.readings(rests, data.up, data.known.scatter, around[place])
    own = own.reshape(-1, len(place))
    design = np.zeros((len(own), data.size))
    design[:, place] = own
    rest = observed.ravel() - own @ around[place]
    return Rows(design, rest, sigma.ravel(), np.zeros((len(own), 0, 3)))


def _of_rates(data: _Data, around: Array) -> Iterator[tuple[int, Rows]]:
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
                yield len(data.stops) + passages[i], at_stop.motion(i, motion, turned)
                at_stop = at_stop.at_next(turned)


def _data(stops: Sequence[Stop], passages: Sequence[Passage], known: Prior) -> "_Data":
    """About the directions of the readings."""
    return _Data(stops, passages, known, upward_of(np.array([stop.forces.mean for stop in stops])))


def _level(up: Array, about: Array) -> Array:
    """Two horizontal directions, (2, 3), the first as near as possible to `about`."""
    first = about - (about @ up) * up
    first = first / np.linalg.norm(first)
    return np.array([first, cross(up, first)])


@dataclass(frozen=True)
class _AtStop:
    """The point of linearisation, and the horizontal rate of a chain at one of its stops.

    `ups`: (n, 3); `changes`: (n, 2, 3), of them; `level`: (2, 3), rates per unit of the unknowns
    at `place`.
    """

    data: _Data
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
        sigma = np.hypot(stop.sigma, self.data.between(stop.seconds))
        return Rows(design, rest, sigma, np.eye(3)[:, None])

    def motion(self, i: int, motion: IntegratedMotion, turned: Array) -> Rows:
        """The next upward direction against this one rotated there, along two horizontal axes."""
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
        rest = across @ (rotated - self.ups[i + 1])
        angle = self.data.between(motion.seconds) * motion.seconds
        spread = motion.white + (angle**2 + self.data.scatter.swing**2) * np.eye(3)
        variance, axes = np.linalg.eigh(lever @ spread @ lever.T)
        response = np.einsum("mi,sij->msj", axes.T @ lever, motion.response)
        return Rows(axes.T @ design, axes.T @ rest, np.sqrt(variance), response)

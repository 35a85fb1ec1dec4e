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

Differences between rests beyond noise may be a rate, such as the g-sensitivity of a gyro; or, by
hand, an angle: the IMU sways, so its mean rate is the smaller the longer it rests, and a motion
does not begin and end exactly where the accelerometers determined the directions.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from inertial.estimation import multi_position as forces
from inertial.estimation.attitude import integrate
from inertial.estimation.gyroscope_observations import Earth
from inertial.estimation.gyroscopes import PRIOR, PRIOR_SIGMA
from inertial.estimation.least_squares import Estimate, System, solve_iterated
from inertial.estimation.multi_position import FreeRest, Upward, upward_of
from inertial.estimation.triad import UNKNOWNS, design_of
from inertial.physics.motion import cross

Array = NDArray[np.float64]
Rows = tuple[Array, Array, Array]  # coefficients (m, p), residuals (m,), their sigma (m,)


@dataclass(frozen=True)
class Stop:
    """A rest of so many seconds: accelerometers, mean rates and their sigma, rad/s, (3,) each."""

    forces: FreeRest
    mean: Array
    sigma: Array
    seconds: float


@dataclass(frozen=True)
class Passage:
    """The readings of the gyros from stop `first` to the next.

    `rates`: (k, 3), rad/s, means of short stretches; `seconds`: (k,); `density`: (3,), rad/√s.
    """

    first: int
    rates: Array
    seconds: Array
    density: Array


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
    scatter: float = 0.0,
    *,
    sways: bool = False,
) -> Estimate:
    """M by rows and bias of the gyros, in the order of `triad`, and all other unknowns.

    `stops` in the order of time. `scatter`, rad/s: between rests and between motions, beyond noise.
    Where the IMU `sways`, it is so for a rest of the usual length T only: all rotate by an angle of
    scatter · T.
    """
    up = upward_of(np.array([stop.forces.mean for stop in stops]))
    data = _Data(stops, passages, known, scatter, sways, up)
    start = data.prior
    start[UNKNOWNS - 3 : UNKNOWNS] = np.nanmedian([stop.mean for stop in stops], axis=0)
    return solve_iterated(partial(equations, data), start)


@dataclass(frozen=True)
class _Data:
    """The data of the equations, and the places of their unknowns.

    These are: the gyros' parameters, those of the accelerometers, two for each direction, two for
    the horizontal rate of each chain of stops, gravity, and the earth's upward rate.
    """

    stops: Sequence[Stop]
    passages: Sequence[Passage]
    known: Prior
    scatter: float
    sways: bool
    up: Upward

    @property
    def swayed(self) -> float:
        """The angle by which the IMU sways at every rest, rad."""
        usual = float(np.median([stop.seconds for stop in self.stops]))
        return self.scatter * usual if self.sways else 0.0

    def between(self, stop: Stop) -> float:
        """Scatter of the mean rates of a rest, rad/s."""
        return self.swayed / stop.seconds if self.sways else self.scatter

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
    parts = [_of_forces(data, around), *_of_rates(data, around)]
    design, rest, sigma = (np.concatenate(column) for column in zip(*parts, strict=True))
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


def _of_forces(data: _Data, around: Array) -> Rows:
    """The accelerometers at every stop."""
    place = data.of_forces
    rests = [stop.forces for stop in data.stops]
    own, observed, sigma = forces.readings(rests, data.up, data.known.scatter, around[place])
    own = own.reshape(-1, len(place))
    design = np.zeros((len(own), data.size))
    design[:, place] = own
    return design, observed.ravel() - own @ around[place], sigma.ravel()


def _of_rates(data: _Data, around: Array) -> Iterator[Rows]:
    """The gyros at every stop, and in the motion to the next."""
    places = around[data.directions].reshape(-1, 2)
    ups, changes = data.up.at(places)
    passages = {passage.first: passage for passage in data.passages}
    for number, chain in enumerate(data.chains):
        first = _level(ups[chain[0]], data.up.across[chain[0], 0])
        at_stop = _AtStop(data, around, ups, changes, data.level(number), first)
        for i in chain:
            yield at_stop.at_rest(i)
            if i in passages:
                rate = 0.0 if data.sways else data.scatter
                motion = integrated_motion(
                    passages[i], at_stop.matrix, at_stop.bias, (rate, data.swayed)
                )
                turned = motion.relative_to_earth(at_stop.earth(i))
                yield at_stop.motion(i, motion, turned)
                at_stop = at_stop.at_next(turned)


def _level(up: Array, about: Array) -> Array:
    """Two horizontal directions, (2, 3), the first as near as possible to `about`."""
    first = about - (about @ up) * up
    first = first / np.linalg.norm(first)
    return np.array([first, cross(up, first)])


@dataclass(frozen=True)
class IntegratedMotion:
    """A motion by the gyros, before correction for the earth's rate.

    `whole`: (3, 3), from body axes at its start to those at its end; `slope`: (3, 12), the rotation
    per unit of each unknown of the gyros, rad, in axes at the end; `covariance`: (3, 3), of that
    rotation, rad².
    """

    whole: Array
    slope: Array
    covariance: Array
    seconds: float

    def relative_to_earth(self, earth: Array) -> Array:
        """The same for directions fixed to the earth; its rate at the start, (3,)."""
        turned = self.seconds * (self.whole @ earth)
        return np.asarray(Rotation.from_rotvec(turned).as_matrix() @ self.whole)


def integrated_motion(
    passage: Passage, matrix: Array, bias: Array, scatter: tuple[float, float]
) -> IntegratedMotion:
    """Integrate the attitude over a motion, with its dependence on M, bias and noise.

    `scatter`: beyond noise, of the readings, rad/s, and of the attitude at the end, rad.
    """
    inverse = np.linalg.inv(matrix)
    rates = (passage.rates - bias) @ inverse.T
    attitude = integrate(rates, passage.seconds)
    weighted = (attitude.to_end @ inverse) * passage.seconds[:, None, None]
    by_matrix = -np.einsum("kir,kc->irc", weighted, rates).reshape(3, 9)
    by_bias = -weighted.sum(axis=0)
    noise = weighted * passage.density / np.sqrt(passage.seconds)[:, None, None]
    covariance = np.einsum("kir,kjr->ij", noise, noise)
    covariance = covariance + scatter[0] ** 2 * by_bias @ by_bias.T + scatter[1] ** 2 * np.eye(3)
    slope = np.hstack([by_matrix, by_bias])
    return IntegratedMotion(attitude.whole, slope, covariance, float(passage.seconds.sum()))


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
        return design, rest, np.hypot(stop.sigma, self.data.between(stop))

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
        variance, axes = np.linalg.eigh(lever @ motion.covariance @ lever.T)
        return axes.T @ design, axes.T @ rest, np.sqrt(variance)

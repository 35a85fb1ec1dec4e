"""The gyros from what happens between rests of unknown attitude.

    C v₁ = v₂,    C: from the rates M⁻¹ (reading − bias) − Ω, carried from the one rest to the next
    mean reading at rest = M · Ω + bias + noise

v₁, v₂ are the upward directions that the accelerometers tell at both rests: two equations for each
motion (Tedaldi, Pretto & Menegatti, ICRA 2014). So M is that of the gyros against the axes of the
accelerometers, those of `free_positions`; its mounting rotation is of one triad against the other.
The readings of the accelerometers are in the equations too, for an error of theirs at one rest is
in the motion before it and in the one after, and one of their parameters in all.

Ω is the earth's rate: its upward part lies along v; its level part, of known size and unknown
direction, is two unknowns for all rests that unbroken motions join, for the gyros carry it along.
Noise turns all that comes after it, so its covariance is summed on the way.

What rests differ by beyond noise may be a rate, such as what acceleration does to a gyro; or, in
the hand, an angle: the IMU sways, so its mean rate is the smaller the longer it rests, and where a
motion begins and ends is not quite where the accelerometers saw it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from inertial.estimation import multi_position as forces
from inertial.estimation.attitude import carried
from inertial.estimation.gyroscope_observations import Earth
from inertial.estimation.gyroscopes import PRIOR, PRIOR_SIGMA
from inertial.estimation.least_squares import Estimate, System, solve_iterated
from inertial.estimation.multi_position import FreeRest, Upward, upward_of
from inertial.estimation.triad import UNKNOWNS, design_of
from inertial.physics.vectors import cross

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
    """What the gyros read all the way from stop `first` to the next.

    `rates`: (k, 3), rad/s, means of short stretches; `seconds`: (k,); `density`: (3,), rad/√s.
    """

    first: int
    rates: Array
    seconds: Array
    density: Array


@dataclass(frozen=True)
class Given:
    """What is known beforehand: gravity and its sigma, m/s², and the earth's rate.

    `between`: m/s², by what the accelerometers differ from rest to rest beyond noise.
    """

    gravity: float
    gravity_sigma: float
    between: float
    earth: Earth


def between_rests(
    stops: Sequence[Stop],
    passages: Sequence[Passage],
    given: Given,
    scatter: float = 0.0,
    *,
    sways: bool = False,
) -> Estimate:
    """M by rows and bias of the gyros, in the order of `triad`, with all that is unknown beside.

    `stops` in the order of time. `scatter`, rad/s, is by what the readings differ from rest to rest
    and from motion to motion beyond noise. Where the IMU `sways`, it is so for a rest of the usual
    length T only: all turn by an angle of scatter · T.
    """
    up = upward_of(np.array([stop.forces.mean for stop in stops]))
    recorded = _Recorded(stops, passages, given, scatter, sways, up)
    start = recorded.prior
    start[UNKNOWNS - 3 : UNKNOWNS] = np.nanmedian([stop.mean for stop in stops], axis=0)
    return solve_iterated(partial(equations, recorded), start)


@dataclass(frozen=True)
class _Recorded:
    """What is given to the equations, and where their unknowns stand.

    These are: the gyros' parameters, those of the accelerometers, two for each direction, two for
    the level rate of each chain of stops, gravity, and the earth's upward rate.
    """

    stops: Sequence[Stop]
    passages: Sequence[Passage]
    given: Given
    scatter: float
    sways: bool
    up: Upward

    @property
    def swayed(self) -> float:
        """The angle that the IMU turns by at every rest, rad."""
        usual = float(np.median([stop.seconds for stop in self.stops]))
        return self.scatter * usual if self.sways else 0.0

    def between(self, stop: Stop) -> float:
        """By what the mean rates of a rest differ from others beyond noise, rad/s."""
        return self.swayed / stop.seconds if self.sways else self.scatter

    @property
    def chains(self) -> list[list[int]]:
        """The stops that unbroken motions join."""
        joined = {passage.first for passage in self.passages}
        found: list[list[int]] = []
        for i in range(len(self.stops)):
            if i - 1 in joined:
                found[-1].append(i)
            else:
                found.append([i])
        return found

    @property
    def sought(self) -> int:
        return UNKNOWNS + forces.FREE + 2 * len(self.stops)

    @property
    def directions(self) -> slice:
        return slice(UNKNOWNS + forces.FREE, self.sought)

    def level(self, chain: int) -> slice:
        return slice(self.sought + 2 * chain, self.sought + 2 * chain + 2)

    @property
    def size(self) -> int:
        return self.sought + 2 * len(self.chains) + 2

    @property
    def of_forces(self) -> NDArray[np.int_]:
        """The unknowns of `free_positions` among all."""
        return np.append(np.arange(UNKNOWNS, self.sought), self.size - 2)

    @property
    def prior(self) -> Array:
        middle = np.zeros(2 * len(self.stops) + 2 * len(self.chains))
        ends = [self.given.gravity, self.given.earth.up]
        return np.concatenate([PRIOR, forces.PRIOR, middle, ends])

    @property
    def prior_sigma(self) -> Array:
        directions = np.full(2 * len(self.stops), forces.ANY)
        level = np.full(2 * len(self.chains), self.given.earth.level / np.sqrt(2))
        ends = [self.given.gravity_sigma, self.given.earth.up_sigma]
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


def equations(recorded: _Recorded, around: Array) -> System:
    """The equations of all stops and of the motions between them, linear about `around`."""
    parts = [_of_forces(recorded, around), *_of_rates(recorded, around)]
    design, rest, sigma = (np.concatenate(column) for column in zip(*parts, strict=True))
    there = np.isfinite(rest) & np.isfinite(sigma)  # a gyro may not be recorded
    design = design[there]
    return System(
        design,
        rest[there] + design @ around,
        sigma[there],
        recorded.prior,
        recorded.prior_sigma,
        recorded.sought,
        recorded.names,
    )


def _of_forces(recorded: _Recorded, around: Array) -> Rows:
    """The accelerometers at every stop."""
    place = recorded.of_forces
    rests = [stop.forces for stop in recorded.stops]
    own, observed, sigma = forces.readings(
        rests, recorded.up, recorded.given.between, around[place]
    )
    own = own.reshape(-1, len(place))
    design = np.zeros((len(own), recorded.size))
    design[:, place] = own
    return design, observed.ravel() - own @ around[place], sigma.ravel()


def _of_rates(recorded: _Recorded, around: Array) -> Iterator[Rows]:
    """The gyros at every stop, and on the way from it to the next."""
    places = around[recorded.directions].reshape(-1, 2)
    ups, changes = recorded.up.at(places)
    passages = {passage.first: passage for passage in recorded.passages}
    for number, chain in enumerate(recorded.chains):
        first = _level(ups[chain[0]], recorded.up.across[chain[0], 0])
        here = _Here(recorded, around, ups, changes, recorded.level(number), first)
        for i in chain:
            yield here.at_rest(i)
            if i in passages:
                rate = 0.0 if recorded.sways else recorded.scatter
                moved = moving(passages[i], here.matrix, here.bias, (rate, recorded.swayed))
                turned = moved.seen_from_earth(here.earth(i))
                yield here.moved(i, moved, turned)
                here = here.carried_on(turned)


def _level(up: Array, about: Array) -> Array:
    """Two level directions, (2, 3), the first as near as can be to `about`."""
    first = about - (about @ up) * up
    first = first / np.linalg.norm(first)
    return np.array([first, cross(up, first)])


@dataclass(frozen=True)
class Moved:
    """A motion as the gyros tell it, before the earth's rate is taken off.

    `whole`: (3, 3), from body axes at its start to those at its end; `slope`: (3, 12), what each
    unknown of the gyros adds to the rotation, rad, in axes at the end; `spread`: (3, 3), covariance
    of that rotation, rad².
    """

    whole: Array
    slope: Array
    spread: Array
    seconds: float

    def seen_from_earth(self, earth: Array) -> Array:
        """The same for directions that stand still on the earth; its rate at the start, (3,)."""
        turned = self.seconds * (self.whole @ earth)
        return np.asarray(Rotation.from_rotvec(turned).as_matrix() @ self.whole)


def moving(passage: Passage, matrix: Array, bias: Array, scatter: tuple[float, float]) -> Moved:
    """Carry an attitude through a motion, with what M, bias and noise do to it.

    `scatter`: beyond noise, of the readings, rad/s, and of the attitude at the end, rad.
    """
    inverse = np.linalg.inv(matrix)
    rates = (passage.rates - bias) @ inverse.T
    way = carried(rates, passage.seconds)
    weighted = (way.to_the_end @ inverse) * passage.seconds[:, None, None]
    by_matrix = -np.einsum("kir,kc->irc", weighted, rates).reshape(3, 9)
    by_bias = -weighted.sum(axis=0)
    noise = weighted * passage.density / np.sqrt(passage.seconds)[:, None, None]
    spread = np.einsum("kir,kjr->ij", noise, noise)
    spread = spread + scatter[0] ** 2 * by_bias @ by_bias.T + scatter[1] ** 2 * np.eye(3)
    slope = np.hstack([by_matrix, by_bias])
    return Moved(way.whole, slope, spread, float(passage.seconds.sum()))


@dataclass(frozen=True)
class _Here:
    """The unknowns as they are, and what the level rate of a chain of stops is at one of them.

    `ups`: (n, 3); `changes`: (n, 2, 3), of them; `level`: (2, 3), rates per unit of the unknowns
    at `place`.
    """

    recorded: _Recorded
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

    def carried_on(self, turned: Array) -> "_Here":
        """The same at the next stop."""
        level = self.level @ turned.T
        there = (self.around, self.ups, self.changes, self.place)
        return _Here(self.recorded, *there, level)

    def at_rest(self, i: int) -> Rows:
        stop, direction = self.recorded.stops[i], self.recorded.directions.start + 2 * i
        design = np.zeros((3, self.recorded.size))
        design[:, :UNKNOWNS] = design_of(self.earth(i))
        design[:, direction : direction + 2] = self.around[-1] * self.matrix @ self.changes[i].T
        design[:, self.place] = self.matrix @ self.level.T
        design[:, -1] = self.matrix @ self.ups[i]
        rest = stop.mean - self.matrix @ self.earth(i) - self.bias
        return design, rest, np.hypot(stop.sigma, self.recorded.between(stop))

    def moved(self, i: int, moved: Moved, turned: Array) -> Rows:
        """The next upward direction against this one carried there, along two level directions."""
        across = self.recorded.up.across[i + 1]  # (2, 3)
        arrived = turned @ self.ups[i]
        # A rotation φ of the body takes a direction v to v + v × φ.
        lean = cross(across, arrived)  # across · (v × φ) = (across × v) · φ
        direction = self.recorded.directions.start + 2 * i
        design = np.zeros((2, self.recorded.size))
        design[:, :UNKNOWNS] = -lean @ moved.slope
        design[:, direction : direction + 2] = -across @ turned @ self.changes[i].T
        design[:, direction + 2 : direction + 4] = across @ self.changes[i + 1].T
        design[:, self.place] = moved.seconds * lean @ turned @ self.level.T
        design[:, -1] = moved.seconds * lean @ turned @ self.ups[i]
        rest = across @ (arrived - self.ups[i + 1])
        variance, axes = np.linalg.eigh(lean @ moved.spread @ lean.T)
        return axes.T @ design, axes.T @ rest, np.sqrt(variance)

"""The equations of the gyros in static positions and in rate segments."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.attitude import all_turned
from inertial.estimation.elimination import EquationBlock, Name, compressed
from inertial.estimation.random_walk import Stretch
from inertial.estimation.sensitivities import NONE, Traces
from inertial.estimation.triad import UNKNOWNS, design_of
from inertial.physics.motion import all_level_axes, level_axes, turned_all
from inertial.physics.vectors import cross

# ---- Rests and turns of a campaign as the equations of the gyros take them.

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Earth:
    """The earth's rate at the site, rad/s: upward part, its sigma, size of the level part."""

    up: float
    up_sigma: float
    level: float


@dataclass(frozen=True)
class Position:
    """A set position: where up is, and what is known of north, in body axes.

    `north` where mark and heading are given; `mark` where only the mark is; else
    the azimuth is an unknown of this position.
    """

    name: str
    up: Array
    mark: Array | None = None
    north: Array | None = None


@dataclass(frozen=True)
class Still:
    """A rest: mean rates (3,), rad/s, and their sigma; `angle` turned since the start, rad."""

    position: Position
    mean: Array
    sigma: Array
    about: Array
    angle: float = 0.0
    traces: Traces = NONE
    stretch: Stretch | None = None


@dataclass(frozen=True)
class Bridge:
    """A missing stretch of a turn, before the block `before`.

    The table turned in it by the sum of `shares` (k,) times the angles of the blocks;
    `seconds`: how long it is.
    """

    before: int
    seconds: float
    shares: Array


@dataclass(frozen=True)
class Turn:
    """A whole turn from rest to rest, in blocks.

    `sums`: (k, 3), rad; `seconds`: (k,); `angle`, `angle_sigma`: rad; `density` and
    `quiet_density`: (3,), rad/√s, white noise while turning and at rest. `by_hand`: the
    axis sways on the way, so only the sums over the whole turn are used. `bridges`: what is
    missing between the blocks; `bridged_sigma`: rad, of the angle that the table turned there.
    `unsteady`: blocks in which the case rings ever more, or less, where it rings.
    """

    position: Position
    about: Array
    angle: float
    angle_sigma: float
    sums: Array
    seconds: Array
    density: Array
    quiet_density: Array
    by_hand: bool = False
    bridges: Sequence[Bridge] = ()
    bridged_sigma: float = 0.0
    unsteady: Sequence[int] = ()
    traces: Traces = NONE
    stretch: Stretch | None = None

    @property
    def weights(self) -> Array:
        """How often each block counts in the turn as a whole, (k,)."""
        return np.ones(len(self.seconds)) + sum((b.shares for b in self.bridges), np.zeros(1))

    @property
    def alone(self) -> NDArray[np.bool_]:
        """Which blocks count by themselves too, (k,): those that no missing stretch cuts short.

        In a full block a steady oscillation of the case averages out; beside a gap it may not.
        """
        cut = [b.before - side for b in self.bridges for side in (0, 1)] + list(self.unsteady)
        return ~np.isin(np.arange(len(self.seconds)), cut) | self.by_hand

    @property
    def elapsed(self) -> Array:
        """The middle of each block since the first began, (k,), s."""
        return self._past(self.seconds, [b.seconds for b in self.bridges])

    def turned(self, angle: Array) -> Array:
        """The angle of the table at the middle of each block, (k,), from those of the blocks."""
        return self._past(angle, [float(b.shares @ angle) for b in self.bridges])

    def _past(self, own: Array, missing: Sequence[float]) -> Array:
        """What has passed at the middle of each block: of the blocks, and of what is missing."""
        past = np.cumsum(own) - own / 2
        for bridge, passed in zip(self.bridges, missing, strict=True):
            past[bridge.before :] += passed
        return np.asarray(past)


@dataclass(frozen=True)
class Steady:
    """A stretch of a turn at a known rate: mean rates (3,), rad/s, sigma, rate and its sigma.

    `seconds`, `elapsed`: (k,), of its blocks, how long each is and when its middle is, s.
    """

    position: Position
    about: Array
    rate: float
    rate_sigma: float
    seconds: Array
    elapsed: Array
    mean: Array
    sigma: Array
    traces: Traces = NONE
    stretch: Stretch | None = None


# ---- The equations of the gyros at rest, and in a stretch of a turn at a known rate.


def level_names(position: Position) -> tuple[Name, ...]:
    """The unknown parts of the level earth rate of a position; none where north is known."""
    if position.north is not None:
        return ()
    name = "the table" if position.mark is not None else position.name
    return tuple((f"level {i}", name) for i in (0, 1))


def level_of(position: Position) -> Array:
    """The directions of the unknown parts of the level earth rate, (2, 3)."""
    if position.mark is not None:
        return np.array([position.mark, cross(position.up, position.mark)])
    return np.array(level_axes(position.up))


def of_rests(
    stills: Sequence[Still],
    matrix: Array,
    earth: Earth,
    prior: Array,
    effects: Sequence[str],
    sigma: dict[Name, float],
) -> list[tuple[str, EquationBlock, Stretch]]:
    """Position, equations and stretch of every rest.

    Parameters
    ----------
    matrix : M that the equations are linear about; `prior`: (s,), of the shared unknowns
    effects : names of the last shared unknowns
    sigma : of the errors, to which those of the rests are added
    """
    if not stills:
        return []
    n, s = len(stills), len(prior)
    positions = [still.position for still in stills]
    abouts = np.array([still.about for still in stills])
    angles = np.array([still.angle for still in stills])
    ups = all_turned(np.array([p.up for p in positions]), abouts, angles)
    norths = np.array([np.zeros(3) if p.north is None else p.north for p in positions])
    known = all_turned(earth.level * norths, abouts, angles)
    levels = all_level_axes(np.array([p.up for p in positions]))
    for i, position in enumerate(positions):
        if position.mark is not None:
            levels[i] = level_of(position)
    # The product M · earth is linear about the present M; the earth is small, so is the error.
    rows = np.zeros((n, 3, s + 3))
    for row in range(3):
        rows[:, row, 3 * row : 3 * row + 3] = known + earth.up * ups
        rows[:, row, 9 + row] = 1.0
    rows[:, :, UNKNOWNS] = ups @ matrix.T
    rows[:, :, UNKNOWNS + 1 : s] = [still.traces.of(effects) for still in stills]
    for i in (0, 1):
        rows[:, :, s + i] = all_turned(levels[:, i], abouts, angles) @ matrix.T
    rows[:, :, -1] = np.array([still.mean for still in stills]) + rows[:, :, UNKNOWNS] * earth.up
    rows[:, :, -1] -= rows[:, :, :s] @ prior
    noise = np.array([still.sigma for still in stills])
    found = []
    for i, still in enumerate(stills):
        names = level_names(still.position)
        sigma |= dict.fromkeys(names, earth.level / np.sqrt(2))
        columns = slice(None) if names else np.r_[:s, s + 2]
        part = whitened(rows[i][:, columns], noise[i], names)
        found.append((still.position.name, part, still.stretch or Stretch(f"rest {i}")))
    return found


def whitened(rows: Array, sigma: Array, own: tuple[Name, ...]) -> EquationBlock:
    """Equations in units of their sigma, without channels that are not recorded."""
    there = np.isfinite(rows[:, -1]) & np.isfinite(sigma)
    deviance = 2 * float(np.sum(np.log(sigma[there])))
    return EquationBlock(rows[there] / sigma[there, None], own, int(there.sum()), deviance)


def of_steady(
    steady: Steady,
    name: str,
    matrix: Array,
    earth: Earth,
    position_sigma: float,
    prior: Array,
    effects: Sequence[str],
    sigma: dict[Name, float],
) -> EquationBlock:
    """The equations of a stretch at a known rate; arguments as in `of_rests`."""
    names = level_names(steady.position)
    angles, shares = steady.rate * steady.elapsed, steady.seconds / steady.seconds.sum()
    known = np.zeros(3)
    if steady.position.north is not None:
        north = earth.level * steady.position.north
        known = shares @ turned_all(north, steady.about, angles)
    up = matrix @ steady.position.up
    truth = steady.rate * steady.about + known + earth.up * steady.position.up
    columns = [design_of(truth), up[:, None], steady.traces.of(effects)]
    sigma |= dict.fromkeys(names, earth.level / np.sqrt(2))
    if names:
        level = [shares @ turned_all(a, steady.about, angles) for a in level_of(steady.position)]
        columns.append(matrix @ np.column_stack(level))
    for i, axis in enumerate(level_axes(steady.about)):
        tilt = (f"tilt {i}", steady.position.name)
        sigma[tilt], names = position_sigma, (*names, tilt)
        columns.append((steady.rate * (matrix @ cross(axis, steady.about)))[:, None])
    rate = ("rate", name)
    sigma[rate], names = steady.rate_sigma, (*names, rate)
    columns.append((matrix @ steady.about)[:, None])
    design = np.hstack(columns)
    observed = steady.mean + up * earth.up - design[:, : len(prior)] @ prior
    return whitened(np.column_stack([design, observed]), steady.sigma, names)


# ---- The equations of the gyros in a whole turn of a known angle, as `whole_turns` has them.

AT_ONCE = 4000  # blocks, so that the memory does not grow with the length of a turn


@dataclass(frozen=True)
class Around:
    """What the equations are linear about: M, bias, and the level earth rates of positions.

    `azimuths`: the positions whose azimuth is so well known that the size of the level rate,
    which is known exactly, can be said of its two parts.
    """

    matrix: Array
    bias: Array
    levels: Mapping[Name, float]  # by kind and name of the unknowns
    azimuths: Collection[str] = ()


def of_turn(
    turn: Turn,
    name: str,
    around: Around,
    earth: Earth,
    position_sigma: float,
    prior: Array,
    effects: Sequence[str],
    sigma: dict[Name, float],
) -> EquationBlock | None:
    """The equations of a turn in few rows; None where no recorded gyro feels it.

    Parameters
    ----------
    name : of the turn, for its own errors; `position_sigma`: rad
    prior : (s,), of the shared unknowns, of which `effects` are the last
    sigma : of the errors, to which those of the turn are added
    """
    recorded = np.isfinite(turn.sums).all(axis=0) & np.isfinite(turn.density)
    weight = np.where(recorded, 1 / np.where(recorded, turn.density, 1.0), 0.0)
    along = weight * (around.matrix @ turn.about)
    if not np.any(along):
        return None
    own = {name: earth.level / np.sqrt(2) for name in level_names(turn.position)}
    own |= {(f"tilt {i}", turn.position.name): position_sigma for i in (0, 1)}
    own[("angle", name)] = turn.angle_sigma
    if turn.bridges:
        own[("bridged", name)] = turn.bridged_sigma
    sigma |= own
    sums = np.where(recorded, turn.sums, 0.0)
    angle, middle = _angles(turn, sums, weight, around, earth)

    # Two combinations of every block that do not see its angle.
    across = np.zeros((int(recorded.sum()) - 1, 3))
    across[:, recorded] = np.linalg.svd(along[None, recorded] / np.linalg.norm(along))[2][1:]
    across *= weight
    every = _Blocks(turn, around, earth, prior, effects, list(own), sums, angle, middle)
    whole = np.zeros((3, len(prior) + len(own) + 1))
    plain, rows, count = whole.copy(), [whole[:0]], 1
    for start in range(0, len(sums), AT_ONCE):
        some = slice(start, start + AT_ONCE)
        seen = every.seen(some)
        whole += np.einsum("k,krc->rc", turn.weights[some], seen)
        if turn.by_hand:
            plain += seen.sum(axis=0)
            continue
        alone = turn.alone[some]
        noise = np.sqrt(turn.seconds[some][alone])
        pairs = np.einsum("dr,krc->kdc", across, seen[alone]) / noise[:, None, None]
        rows.append(compressed(pairs.reshape(-1, pairs.shape[-1])))
        count += len(across) * int(alone.sum())
    if turn.by_hand:
        rows.append(across @ plain / np.sqrt(turn.seconds.sum()))
        count += len(across)
    rows.append(_whole(turn, around.matrix, whole, recorded, float(turn.weights @ angle), own))
    stacked = np.vstack(rows)
    if not np.isfinite(stacked[-1]).all():
        stacked, count = stacked[:-1], count - 1
    return EquationBlock(compressed(stacked), tuple(own), count, 0.0)


def _angles(
    turn: Turn, sums: Array, weight: Array, around: Around, earth: Earth
) -> tuple[Array, Array]:
    """The angle of each block from the channels along the axis, and that so far at its middle."""
    matrix, position = around.matrix, turn.position
    along = weight * (matrix @ turn.about)
    level = np.zeros(3) if position.north is None else earth.level * position.north
    for key, axis in zip(level_names(position), level_of(position), strict=False):
        level = level + around.levels.get(key, 0.0) * axis
    angle = np.zeros(len(sums))
    for _ in range(2):
        middle = turn.turned(angle)
        earthly = earth.up * position.up + turned_all(level, turn.about, middle)
        rest = sums - earthly * turn.seconds[:, None] @ matrix.T
        rest -= np.outer(turn.seconds, around.bias)
        angle = (rest * weight) @ along / (along @ along)
    return angle, turn.turned(angle)


@dataclass(frozen=True)
class _Blocks:
    """What blocks of a turn see of every unknown."""

    turn: Turn
    around: Around
    earth: Earth
    prior: Array
    effects: Sequence[str]
    own: Sequence[Name]
    sums: Array  # (k, 3), rad
    angle: Array  # (k,), rad
    middle: Array  # (k,), rad

    def seen(self, some: slice) -> Array:
        """Coefficients of shared unknowns, of own errors, and the observed, (blocks, 3, n)."""
        turn, matrix, earth, s = self.turn, self.around.matrix, self.earth, len(self.prior)
        seconds, angle, middle = turn.seconds[some], self.angle[some], self.middle[some]
        seen = np.zeros((len(seconds), 3, s + len(self.own) + 1))
        earthly = np.full((len(seconds), 3), earth.up * turn.position.up)
        if turn.position.north is not None:
            earthly += turned_all(earth.level * turn.position.north, turn.about, middle)
        truth = angle[:, None] * turn.about + earthly * seconds[:, None]
        for row in range(3):
            seen[:, row, 3 * row : 3 * row + 3] = truth
            seen[:, row, 9 + row] = seconds
        seen[:, :, UNKNOWNS] = np.outer(seconds, matrix @ turn.position.up)
        if turn.traces.names:
            traces = turn.traces.of(self.effects)[some]
            seen[:, :, UNKNOWNS + 1 : s] = traces * seconds[:, None, None]
        column = s
        if turn.position.north is None:
            for axis in level_of(turn.position):
                level = turned_all(axis, turn.about, middle) @ matrix.T
                seen[:, :, column] = level * seconds[:, None]
                column += 1
        for axis in level_axes(turn.about):
            seen[:, :, column] = np.outer(angle, matrix @ cross(axis, turn.about))
            column += 1
        observed = self.sums[some] + seen[:, :, UNKNOWNS] * earth.up
        seen[:, :, -1] = observed - seen[:, :, :s] @ self.prior
        return seen


def _whole(
    turn: Turn,
    matrix: Array,
    whole: Array,  # (3, columns), the blocks, each as often as it counts
    recorded: NDArray[np.bool_],  # (3,)
    angle: float,  # rad, of these blocks
    own: Mapping[Name, float],
) -> Array:
    """The turn as a whole, along its axis; what the table does on the way is no noise here."""
    quiet = np.where(recorded, 1 / np.where(recorded, turn.quiet_density, 1.0), 0.0)
    along = quiet * (matrix @ turn.about)
    spread = float(np.linalg.norm(along)) * np.sqrt(turn.weights**2 @ turn.seconds)
    along = quiet * along / spread
    row = along @ whole
    # M stands before the whole angle, of which the blocks as the gyros see them lack a little.
    short = np.kron(along, (turn.angle - angle) * turn.about)
    row[:9] += short
    row[-1] -= short @ np.eye(3).ravel()
    of_angle = sum(kind in ("angle", "bridged") for kind, _ in own)
    row[-1 - of_angle : -1] = along @ (matrix @ turn.about)
    return row[None]

"""The gyros from turns of a known angle and from rests, all three by all three.

    sum over a block = M · (u Δθ + E) + bias · τ + noise

u is the axis of the turn in body axes, tilted by δ; Δθ the angle that the table
turns during the block; E the earth's rate in body axes, summed. The table keeps
no exact rate, so Δθ of every block is an unknown that only its own three
readings tell; what is known is the whole angle from rest to rest. So a block
gives the two combinations of its channels that do not see Δθ, and the turn as a
whole the third.

A stretch that is missing in a turn is bridged by the blocks about it: the table turned in it as
at their rate, which is known to a sigma only, an unknown of its own. So in the turn as a whole
every block counts for itself and for its share of what is missing,

    sum of w · (sum over a block) = M · (u α + sum of w · E) + bias · sum of w · τ,   w ≥ 1,

and noise, earth and bias are those of what was recorded, w times. In a steady part the
share is the same for all, T_missing/T_steady; by the sums S of one gyro that is a recorded angle
of α / (1 + S_steady/S · T_missing/T_steady), in which its scale factor cancels.

The earth's rate has an upward part, known from the latitude, and a level part of
known size whose direction is known only with `mark` and the table's heading. Else
it is an unknown of each position, with the size as its sigma.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from stages.inference.least_squares import Estimate, System, solve
from stages.inference.triad import UNKNOWNS, design_of
from stages.model.motion import level_axes, turned, turned_all

Array = NDArray[np.float64]
# How the rates change per unit of the parameters of effects, by name: (3,), or (k, 3) for blocks.
Traces = Mapping[str, Array]

# Vague priors: M within 0.1 of the unit matrix, the bias within 1 rad/s. Without turns only the
# earth's rate shows M, and a wider prior would let an absurd M explain an unknown azimuth.
PRIOR = np.append(np.eye(3).ravel(), np.zeros(3))
PRIOR_SIGMA = np.append(np.full(9, 0.1), np.full(3, 1.0))


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
    traces: Traces = field(default_factory=dict)


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
    traces: Traces = field(default_factory=dict)

    @property
    def weights(self) -> Array:
        """How often each block counts in the turn as a whole, (k,)."""
        return np.ones(len(self.seconds)) + sum((b.shares for b in self.bridges), np.zeros(1))

    @property
    def alone(self) -> NDArray[np.bool_]:
        """Which blocks count by themselves too, (k,): those that no missing stretch cuts short.

        In a full block an oscillation of the case averages out, beside a gap it may not.
        """
        cut = [b.before - side for b in self.bridges for side in (0, 1)]
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
    traces: Traces = field(default_factory=dict)


class _Unknowns:
    """The columns of the design: twelve parameters, then every error and effect with its sigma."""

    def __init__(self, earth: Earth, wide: Mapping[str, float]) -> None:
        self.prior = [*PRIOR, earth.up]
        self.sigma = [*PRIOR_SIGMA, earth.up_sigma]
        self.names = {("parameter", str(i)): i for i in range(UNKNOWNS)}
        self.names["earth", "up"] = UNKNOWNS
        self.effects = {name: self.column("effect", name, width) for name, width in wide.items()}

    def column(self, kind: str, name: str, sigma: float) -> int:
        """Where the unknown `kind` of `name` stands, made where it is new."""
        if (kind, name) not in self.names:
            self.names[(kind, name)] = len(self.prior)
            self.prior.append(0.0)
            self.sigma.append(sigma)
        return self.names[(kind, name)]


@dataclass(frozen=True)
class _Rows:
    """Equations in the making: coefficients by column, observed values, sigmas."""

    design: list[dict[int, Array]]
    observed: list[Array]
    sigma: list[Array]


@dataclass(frozen=True)
class Around:
    """What the equations are linear about: M, bias, and the level earth rates of positions."""

    matrix: Array
    bias: Array
    levels: Mapping[tuple[str, str], float]  # kind and name, as the unknowns have them


def joint(
    stills: Sequence[Still],
    turns: Sequence[Turn],
    steadies: Sequence[Steady],
    earth: Earth,
    position_sigma: float,
    scatter: float = 0.0,
    start: Estimate | None = None,
) -> Estimate:
    """Bias and M of the gyros from all rests and turns at once.

    `scatter`, rad/s, is by what the readings differ from manoeuvre to manoeuvre beyond noise.

    The equations hold products of M with the errors, so they are solved four times,
    each time about the last result; or once about `start`, the estimate from rests at the
    same positions and the same turns.
    """
    around = Around(np.eye(3), _first_bias(stills), {})
    if start is not None:
        around = _around(start)
    for _ in range(1 if start is not None else 4):
        parts = (stills, turns, steadies)
        estimate = equations(*parts, earth, (position_sigma, scatter), around).solve()
        around = _around(estimate)
    return estimate


def _around(estimate: Estimate) -> Around:
    values = estimate.values
    levels = dict(zip(estimate.names, values.tolist(), strict=True))
    return Around(values[:9].reshape(3, 3), values[9:12], levels)


def equations(
    stills: Sequence[Still],
    turns: Sequence[Turn],
    steadies: Sequence[Steady],
    earth: Earth,
    sigmas: tuple[float, float],
    around: Around,
    wide: Mapping[str, float] | None = None,
) -> System:
    """The equations of all rests and turns, linear about `around`.

    `sigmas`: of the positions, rad, and the scatter between manoeuvres, rad/s. Unknowns: M by
    rows, bias, the earth's upward rate, the effects in `wide` with their sigmas, the errors.
    """
    unknowns = _Unknowns(earth, wide or {})
    rows = _Rows([], [], [])
    for still in stills:
        _add_still(rows, unknowns, still, around.matrix, earth, sigmas[1])
    for number, turn in enumerate(turns):
        _add_turn(rows, unknowns, turn, number, around, earth, sigmas)
    for number, steady in enumerate(steadies):
        _add_steady(rows, unknowns, steady, number, around.matrix, earth, sigmas)
    design = np.zeros((sum(len(o) for o in rows.observed), len(unknowns.prior)))
    row = 0
    for coefficients, observed in zip(rows.design, rows.observed, strict=True):
        for column, values in coefficients.items():
            width = 1 if values.ndim == 1 else values.shape[1]
            block = values.reshape(len(observed), width)
            design[row : row + len(observed), column : column + width] = block
        row += len(observed)
    observed_all, sigma_all = np.concatenate(rows.observed), np.concatenate(rows.sigma)
    there = np.isfinite(observed_all) & np.isfinite(sigma_all)
    return System(
        design[there],
        observed_all[there],
        sigma_all[there],
        np.array(unknowns.prior),
        np.array(unknowns.sigma),
        UNKNOWNS,
        tuple(unknowns.names),
    )


def _first_bias(stills: Sequence[Still]) -> Array:
    if not stills:
        return np.zeros(3)
    return np.asarray(np.nan_to_num(np.nanmedian([s.mean for s in stills], axis=0)))


def _earth_columns(
    unknowns: _Unknowns, position: Position, earth: Earth
) -> tuple[Array, list[tuple[int, Array]]]:
    """The level earth rate of a position: its known part, and its unknown directions."""
    if position.north is not None:
        return earth.level * position.north, []
    sigma = earth.level / np.sqrt(2)
    if position.mark is not None:
        axes, name = (position.mark, np.cross(position.up, position.mark)), "the table"
    else:
        axes, name = level_axes(position.up), position.name
    columns = [unknowns.column(f"level {i}", name, sigma) for i in (0, 1)]
    return np.zeros(3), list(zip(columns, axes, strict=True))


def _add_still(
    rows: _Rows,
    unknowns: _Unknowns,
    still: Still,
    matrix: Array,
    earth: Earth,
    scatter: float,
) -> None:
    known, level = _earth_columns(unknowns, still.position, earth)
    known = turned(known, still.about, still.angle)
    up = turned(still.position.up, still.about, still.angle)
    # The product M · earth is linear about the present M; the earth is small, so is the error.
    coefficients = {0: design_of(known + earth.up * up), UNKNOWNS: matrix @ up}
    constant = -(matrix @ up) * earth.up
    for column, axis in level:
        coefficients[column] = matrix @ turned(axis, still.about, still.angle)
    for name, column in unknowns.effects.items():
        coefficients[column] = still.traces.get(name, np.zeros(3))
    rows.design.append(coefficients)
    rows.observed.append(still.mean - constant)
    rows.sigma.append(np.hypot(still.sigma, scatter))


def _add_turn(
    rows: _Rows,
    unknowns: _Unknowns,
    turn: Turn,
    number: int,
    around: Around,
    earth: Earth,
    sigmas: tuple[float, float],  # of the position and between manoeuvres
) -> None:
    matrix, bias = around.matrix, around.bias
    known, level = _earth_columns(unknowns, turn.position, earth)
    levels = {c: around.levels.get(key, 0.0) for key, c in unknowns.names.items()}
    recorded = np.isfinite(turn.sums).all(axis=0) & np.isfinite(turn.density)
    weight = np.where(recorded, 1 / np.where(recorded, turn.density, 1.0), 0.0)
    sums = np.where(recorded, turn.sums, 0.0)
    k = len(sums)

    # The angle of each block, from the channels along the axis.
    along = weight * (matrix @ turn.about)
    along_length = float(np.linalg.norm(along))
    if along_length == 0:
        return
    along = along / along_length
    present = known + sum((levels[c] * axis for c, axis in level), np.zeros(3))
    angle = np.zeros(k)
    for _ in range(2):
        middle = turn.turned(angle)
        earthly = earth.up * turn.position.up + turned_all(present, turn.about, middle)
        rest = sums - (earthly * turn.seconds[:, None]) @ matrix.T - np.outer(turn.seconds, bias)
        angle = (rest * weight) @ along / along_length
    middle = turn.turned(angle)

    # What a block sees of each unknown, all three channels: (k, 3, columns).
    truth = (
        angle[:, None] * turn.about
        + (earth.up * turn.position.up + turned_all(known, turn.about, middle))
        * turn.seconds[:, None]
    )
    first = np.einsum("rc,kj->krcj", np.eye(3), truth).reshape(k, 3, 9)
    own = np.concatenate([first, turn.seconds[:, None, None] * np.eye(3)], axis=2)
    up = matrix @ turn.position.up
    parts: dict[int, Array] = {0: own, UNKNOWNS: turn.seconds[:, None, None] * up[None, :, None]}
    for column, axis in level:
        parts[column] = (turned_all(axis, turn.about, middle) @ matrix.T * turn.seconds[:, None])[
            :, :, None
        ]
    for i, axis in enumerate(level_axes(turn.about)):
        column = unknowns.column(f"tilt {i}", turn.position.name, sigmas[0])
        parts[column] = (np.outer(angle, matrix @ np.cross(axis, turn.about)))[:, :, None]
    if sigmas[1]:
        for i in range(3):
            column = unknowns.column(f"offset {i}", f"{turn.position.name} {number}", sigmas[1])
            parts[column] = turn.seconds[:, None, None] * np.eye(3)[None, :, [i]]
    for name, column in unknowns.effects.items():
        trace = turn.traces.get(name, np.zeros((k, 3)))
        parts[column] = (trace * turn.seconds[:, None])[:, :, None]
    observed = sums + np.outer(turn.seconds, up) * earth.up

    # Two combinations of every block that do not see its angle.
    across = np.zeros((int(recorded.sum()) - 1, 3))
    across[:, recorded] = np.linalg.svd(along[None, recorded])[2][1:]
    starts = [0] if turn.by_hand else range(k)
    noise = np.sqrt(np.add.reduceat(turn.seconds, starts))
    alone = turn.alone[starts]
    for direction in across:
        whitened = {
            c: np.add.reduceat(np.einsum("r,krc->kc", direction * weight, part), starts, axis=0)
            / noise[:, None]
            for c, part in parts.items()
        }
        seen = np.add.reduceat(observed @ (direction * weight), starts) / noise
        rows.design.append({c: part[alone] for c, part in whitened.items()})
        rows.observed.append(seen[alone])
        rows.sigma.append(np.ones(int(alone.sum())))

    _add_whole(rows, unknowns, turn, number, matrix, parts, observed, angle)


def _add_whole(
    rows: _Rows,
    unknowns: _Unknowns,
    turn: Turn,
    number: int,
    matrix: Array,
    parts: Mapping[int, Array],  # (k, 3, columns), what a block sees of each unknown
    observed: Array,  # (k, 3)
    angle: Array,  # (k,), rad, of the blocks
) -> None:
    """The turn as a whole, along its axis; what the table does on the way is no noise here."""
    recorded = np.isfinite(turn.sums).all(axis=0) & np.isfinite(turn.density)
    quiet = np.where(recorded, 1 / np.where(recorded, turn.quiet_density, 1.0), 0.0)
    along = quiet * (matrix @ turn.about)
    times = turn.weights
    spread = float(np.linalg.norm(along)) * np.sqrt(times**2 @ turn.seconds)
    along = quiet * along / spread
    whole = {c: (along @ np.einsum("k,krc->rc", times, part))[None, :] for c, part in parts.items()}
    shortfall = turn.angle - float(times @ angle)
    whole[0] = (
        whole[0]
        + (along @ np.hstack([np.kron(np.eye(3), shortfall * turn.about), np.zeros((3, 3))]))[
            None, :
        ]
    )
    errors = {"angle": turn.angle_sigma}
    if turn.bridges:
        errors["bridged"] = turn.bridged_sigma
    for kind, sigma in errors.items():
        column = unknowns.column(kind, f"{turn.position.name} {number}", sigma)
        whole[column] = np.array([[along @ (matrix @ turn.about)]])
    rows.design.append(whole)
    rows.observed.append(np.array([along @ (times @ observed)]))
    rows.sigma.append(np.ones(1))


def _add_steady(
    rows: _Rows,
    unknowns: _Unknowns,
    steady: Steady,
    number: int,
    matrix: Array,
    earth: Earth,
    sigmas: tuple[float, float],  # of the position and between manoeuvres
) -> None:
    known, level = _earth_columns(unknowns, steady.position, earth)
    angles, shares = steady.rate * steady.elapsed, steady.seconds / steady.seconds.sum()
    known = shares @ turned_all(known, steady.about, angles)
    up = matrix @ steady.position.up
    truth = steady.rate * steady.about + known + earth.up * steady.position.up
    coefficients = {0: design_of(truth), UNKNOWNS: up}
    for column, axis in level:
        coefficients[column] = matrix @ (shares @ turned_all(axis, steady.about, angles))
    for i, axis in enumerate(level_axes(steady.about)):
        column = unknowns.column(f"tilt {i}", steady.position.name, sigmas[0])
        coefficients[column] = steady.rate * (matrix @ np.cross(axis, steady.about))
    column = unknowns.column("rate", f"{steady.position.name} {number}", steady.rate_sigma)
    coefficients[column] = matrix @ steady.about
    for name, column in unknowns.effects.items():
        coefficients[column] = steady.traces.get(name, np.zeros(3))
    rows.design.append(coefficients)
    rows.observed.append(steady.mean + up * earth.up)
    rows.sigma.append(np.hypot(steady.sigma, sigmas[1]))


@dataclass(frozen=True)
class Angle:
    """One whole turn as its own axis saw it: summed angle of that gyro, α, duration, up or down."""

    summed: float  # rad
    angle: float  # rad, along the axis
    angle_sigma: float
    seconds: float
    up: float  # +1 where the axis points up, −1 where it points down
    density: float  # rad/√s


def known_angle(turns: Sequence[Angle], earth: Earth, scatter: float = 0.0) -> Estimate:
    """Bias and scale factor error of one gyro from turns about it, forward and backward.

    α̃ = b t + (1 + s) α + ω_e sinφ t for each turn; for one forward and one backward turn over
    equal times this is S0 (3-9), (3-10): b = (α̃₁+α̃₂)/(2t) − ω_e sinφ, s = (α̃₁−α̃₂)/(2α) − 1.
    Unknowns: b, s, the upward earth rate. `scatter` as in `joint`.
    """
    seconds = np.array([turn.seconds for turn in turns])
    angles = np.array([turn.angle for turn in turns])
    up = np.array([turn.up for turn in turns])
    summed = np.array([turn.summed for turn in turns])
    variance = [turn.density**2 * turn.seconds + turn.angle_sigma**2 for turn in turns]
    sigma = np.sqrt(variance + (scatter * seconds) ** 2)
    design = np.column_stack([seconds, angles, up * seconds])
    prior, prior_sigma = np.array([0.0, 0.0, earth.up]), np.array([1.0, 1.0, earth.up_sigma])
    return solve(design, summed - angles, sigma, prior, prior_sigma, 2)

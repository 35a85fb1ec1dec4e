"""The equations of the gyros in a whole turn of a known angle, as `whole_turns` has them."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.inference.elimination import Name, Part, shorter
from stages.inference.rest_rows import level_names, level_of
from stages.inference.rests_and_turns import Earth, Turn
from stages.inference.triad import UNKNOWNS
from stages.model.motion import level_axes, turned_all
from stages.model.vectors import cross

Array = NDArray[np.float64]

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
) -> Part | None:
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
        rows.append(shorter(pairs.reshape(-1, pairs.shape[-1])))
        count += len(across) * int(alone.sum())
    if turn.by_hand:
        rows.append(across @ plain / np.sqrt(turn.seconds.sum()))
        count += len(across)
    rows.append(_whole(turn, around.matrix, whole, recorded, float(turn.weights @ angle), own))
    stacked = np.vstack(rows)
    if not np.isfinite(stacked[-1]).all():
        stacked, count = stacked[:-1], count - 1
    return Part(shorter(stacked), tuple(own), count, 0.0)


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

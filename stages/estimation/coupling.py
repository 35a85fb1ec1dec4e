"""What the other axes of the case see of an oscillation about one of them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.contracts.tables import AXES
from stages.estimation.steady_turns import SteadyTurn
from stages.inference.lines import phasor
from stages.model.vectors import cross

Array = NDArray[np.float64]

TABLE = "table"  # the axis that the table turns about
CLEAR = 5.0  # sigmas from which an axis has more than coupling
TERM = 1e-4  # rad, 20″: what a cross term may be off


@dataclass(frozen=True)
class Coupled:
    """An oscillation in the gyro of another axis; rad/s, rms over the turns of the amplitudes.

    read : as the gyro reads it; expected : by its cross term; left : with M undone, and what noise
    would leave of it;
    tipping : what the rate of the table brings, into which the case tips as it oscillates; more :
    whether there is more than the cross term brings
    """

    axis: str
    read: float
    expected: float
    left: float
    left_sigma: float
    tipping: float
    more: bool


def direction(turn: SteadyTurn, axis: str) -> Array:
    """The unit vector of an axis of the case, or of the table's, (3,)."""
    return turn.about if axis == TABLE else np.eye(3)[AXES.index(axis)]


def coupled(
    turns: Sequence[SteadyTurn], axis: str, frequencies: Mapping[str, float]
) -> list[Coupled]:
    """The other axes; of an oscillation about the table's axis none, for it differs by turn."""
    heard = [turn for turn in turns if turn.name in frequencies]
    if axis == TABLE or not heard:
        return []
    source = AXES.index(axis)
    truth = np.array([_phasors(turn, frequencies[turn.name]) for turn in heard])
    matrix = heard[0].matrix
    read = _rms(truth @ matrix.T)
    size = _rms(truth)
    noise = np.array([[_sigma(turn, i) for i in range(len(AXES))] for turn in heard])
    # What noise leaves of the mean square of k amplitudes scatters by 2 σ²/√k.
    sigma = np.sqrt(2 * np.mean(noise**2, axis=0) / np.sqrt(len(heard)))
    found = []
    for i, name in enumerate(AXES):
        if i == source:
            continue
        tips = [
            _tipping(turn, truth[k, source], frequencies[turn.name], source, i)
            for k, turn in enumerate(heard)
        ]
        left = float(np.sqrt(max(size[i] ** 2 - 2 * np.mean(noise[:, i] ** 2), 0.0)))
        found.append(
            Coupled(
                name,
                float(read[i]),
                float(abs(matrix[i, source]) * size[source]),
                left,
                float(sigma[i]),
                float(_rms(np.array(tips))),
                bool(left > max(np.sqrt(CLEAR) * sigma[i], TERM * size[source])),
            )
        )
    return found


def _phasors(turn: SteadyTurn, frequency: float) -> NDArray[np.complex128]:
    share = float(np.sinc(frequency * turn.step)) if turn.averaged else 1.0
    parts = [phasor(record, 1 / turn.step, frequency) / share for record in turn.truth.T]
    return np.array(parts, dtype=np.complex128)


def _sigma(turn: SteadyTurn, i: int) -> float:
    """Standard deviation of either part of an amplitude, rad/s."""
    return turn.sigma(np.eye(3)[i]) * float(np.sqrt(2 / len(turn.truth)))


def _tipping(turn: SteadyTurn, size: complex, frequency: float, source: int, i: int) -> float:
    """The case tips by size/(2πf), and so has a share of the table's rate about a third axis."""
    across = cross(np.eye(3)[source], turn.about)[i]
    rate = 0.0 if np.isnan(turn.rate) else turn.rate
    return float(abs(size) / (2 * np.pi * frequency) * abs(rate * across))


def _rms(values: NDArray[np.complex128] | Array) -> Array:
    """Root mean square over the turns."""
    return np.asarray(np.sqrt(np.mean(np.abs(values) ** 2, axis=0)))

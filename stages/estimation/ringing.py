"""Oscillations of the case while the table turns, in the full-rate residuals of the gyros."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.contracts.tables import AXES
from stages.estimation.steady_turns import SteadyTurn
from stages.inference.lines import Line, Taken, strongest

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Ringing:
    """A line of one axis of the case in one turn; amplitude in rad/s of true rate.

    `drop`: of chi-squared by it.
    """

    manoeuvre: str
    axis: str
    line: Line
    drop: float


def ringing(turn: SteadyTurn, lowest: float, taken: Sequence[Taken] = ()) -> list[Ringing]:
    """The strongest line about each axis of the case; nothing below `lowest`, Hz."""
    found = []
    for i, axis in enumerate(AXES):
        if not turn.tells(np.eye(3)[i]):
            continue
        line = strongest(turn.truth[:, i], 1 / turn.step, lowest, taken)
        if line is not None:
            drop = (line.amplitude / line.sigma_amplitude) ** 2
            found.append(Ringing(turn.name, axis, turn.whole(line), drop))
    return found


@dataclass(frozen=True)
class Oscillating:
    """One oscillation over all turns that show it: axis, frequency, amplitude, with sigmas."""

    axis: str
    manoeuvres: tuple[str, ...]
    frequency: float
    frequency_sigma: float
    amplitude: float
    amplitude_sigma: float


def together(same: Sequence[Ringing]) -> Oscillating:
    """Turns that ring about one axis at one frequency are one oscillation."""
    frequency = _weighted([(o.line.frequency, o.line.sigma_frequency) for o in same])
    amplitude = _weighted([(o.line.amplitude, o.line.sigma_amplitude) for o in same])
    names = tuple(one.manoeuvre for one in same)
    return Oscillating(same[0].axis, names, *frequency, *amplitude)


def _weighted(values: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Mean of several values, each with its sigma, and the sigma of the mean."""
    numbers, sigmas = np.array(values).T
    weights = sigmas**-2
    return float(np.average(numbers, weights=weights)), float(weights.sum() ** -0.5)

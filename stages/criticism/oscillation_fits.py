"""Oscillations in the residuals of the rate segments, fitted in time and in angle."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.periodic_in_angle import Orders, log_chance
from inertial.estimation.periodic_in_time import Line, Taken, pooled, strongest
from inertial.tables import AXES

# ---- What stands out of the noise of the turns, before it is known what it is.


@dataclass(frozen=True)
class Stands:
    """An order against the table's angle, or else a frequency in time."""

    drop: float  # of chi-squared
    p_value: float  # the search paid for
    order: float | None
    frequency: float  # Hz, in the turn
    turn: SteadyTurn


# ---- Oscillations of the case while the table turns, in the full-rate residuals of the gyros.

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


# ---- What stands out against time: in one axis of one turn, and in one axis of all turns.


def in_turns(rings: Sequence[Ringing], turns: Sequence[SteadyTurn]) -> list[Stands]:
    """The strongest line of each axis in each turn, the search over all of them paid for."""
    place = {turn.name: turn for turn in turns}
    return [
        Stands(
            ring.drop,
            min(ring.line.p_value * len(rings), 1.0),
            None,
            ring.line.frequency,
            place[ring.manoeuvre],
        )
        for ring in rings
    ]


def in_all(
    turns: Sequence[SteadyTurn], taken: Mapping[str, Sequence[Taken]], lowest: float
) -> list[Stands]:
    """The frequency that stands out most of each axis in all turns; one turn is no more than it.

    What may be left of a line that was taken out of any turn is none.
    """
    found = []
    for i in range(len(AXES)):
        told = [turn for turn in turns if turn.tells(np.eye(3)[i])]
        if len(told) < 2:
            continue
        frequency, drop, chance = pooled(
            [turn.truth[:, i] for turn in told], [1 / turn.step for turn in told], lowest
        )
        if not len(frequency):
            continue
        for turn in told:
            noise = turn.sigma(np.eye(3)[i]) * np.sqrt(2 / len(turn.truth))
            for one in taken[turn.name]:
                leaks = one.leaks(frequency, turn.seconds) / noise
                chance = np.where(drop > len(told) * leaks**2, chance, 0.0)
        best = int(np.argmin(chance))
        trials = len(AXES) * len(frequency)
        p_value = float(np.exp(min(chance[best] + np.log(trials), 0.0)))
        found.append(Stands(float(drop[best]), p_value, None, float(frequency[best]), told[0]))
    return found


# ---- What stands out in the turns against the table's angle.

ECCENTRIC = 1.0  # the order of an encoder off its axis


def best_orders(
    turns: Sequence[SteadyTurn], said: Orders, taken: Mapping[str, Sequence[Taken]]
) -> list[Stands]:
    """The order 1, and the best of all others: two searches."""
    chance = log_chance(said, shortest(turns))
    # What may be left of a line that was taken out of any turn is no ripple.
    amplitude = np.sqrt(said.drop) * np.where(said.turns > 0, said.sigma, 0.0)
    for turn in turns:
        for one in taken[turn.name]:
            leaks = one.leaks(turn.hertz(1.0) * said.order, turn.seconds)
            stands = amplitude * said.order * abs(turn.rate) > leaks
            chance = np.where(stands, chance, 0.0)
    found = []
    others = np.where(said.order > ECCENTRIC, chance, 0.0)
    for i, trials in ((0, 1.0), (int(np.argmin(others)), float(len(others)))):
        p_value = float(np.exp(min(chance[i] + np.log(trials), 0.0)))
        order, turn = float(said.order[i]), turns[0]
        found.append(Stands(float(said.drop[i]), p_value, order, turn.hertz(order), turn))
    return found


def shortest(turns: Sequence[SteadyTurn]) -> float:
    """How many whole turns the shortest of the steady parts is long."""
    return min(turn.seconds * turn.hertz(1.0) for turn in turns)

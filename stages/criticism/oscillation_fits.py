"""Oscillations in the residuals of the rate segments, fitted in time and in angle."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Array
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.consistency import weighted_mean
from inertial.estimation.periodic_in_angle import Orders, log_chance, log_chance_of_own
from inertial.estimation.periodic_in_time import Line, Taken, phasor, pooled, strongest
from inertial.physics.motion import cross
from inertial.tables import AXES

# ---- A detection, before its cause is known.


@dataclass(frozen=True)
class Detection:
    """An order against the table's angle, or else a frequency in time."""

    drop: float  # of chi-squared
    p_value: float  # the search accounted for
    order: float | None
    frequency: float  # Hz, in the turn
    turn: SteadyTurn


# ---- Oscillations of the case while the table turns, in the full-rate residuals of the gyros.


@dataclass(frozen=True)
class TurnLine:
    """A line of one axis of the case in one turn; amplitude in rad/s of true rate.

    `drop`: of chi-squared by it.
    """

    manoeuvre: str
    axis: str
    line: Line
    drop: float


def strongest_lines(turn: SteadyTurn, lowest: float, taken: Sequence[Taken] = ()) -> list[TurnLine]:
    """The strongest line about each axis of the case; none below `lowest`, Hz."""
    lines = []
    for i, axis in enumerate(AXES):
        if not turn.observes(np.eye(3)[i]):
            continue
        line = strongest(turn.truth[:, i], 1 / turn.step, lowest, taken, turn.shapes[i])
        if line is not None:
            drop = (line.amplitude / line.sigma_amplitude) ** 2
            lines.append(TurnLine(turn.name, axis, turn.whole(line), drop))
    return lines


@dataclass(frozen=True)
class MeanLine:
    """An oscillation over all turns that show it: axis, frequency, amplitude, with sigmas."""

    axis: str
    manoeuvres: tuple[str, ...]
    frequency: float
    frequency_sigma: float
    amplitude: float
    amplitude_sigma: float


def combined(same: Sequence[TurnLine]) -> MeanLine:
    """The mean of lines of several turns about the same axis at the same frequency."""
    lines = [one.line for one in same]
    frequencies = np.array([(line.frequency, line.sigma_frequency) for line in lines]).T
    amplitudes = np.array([(line.amplitude, line.sigma_amplitude) for line in lines]).T
    frequency, amplitude = weighted_mean(*frequencies)[:2], weighted_mean(*amplitudes)[:2]
    names = tuple(one.manoeuvre for one in same)
    return MeanLine(same[0].axis, names, *frequency, *amplitude)


# ---- Detection in time: in one axis of one turn, and in one axis of all turns.


def in_turns(lines: Sequence[TurnLine], turns: Sequence[SteadyTurn]) -> list[Detection]:
    """The strongest line of each axis in each turn, the search over all accounted for."""
    by_name = {turn.name: turn for turn in turns}
    return [
        Detection(
            line.drop,
            min(line.line.p_value * len(lines), 1.0),
            None,
            line.line.frequency,
            by_name[line.manoeuvre],
        )
        for line in lines
    ]


def in_all(
    turns: Sequence[SteadyTurn], taken: Mapping[str, Sequence[Taken]], lowest: float
) -> list[Detection]:
    """The most significant frequency of each axis in all turns, at least two.

    What may remain of a line that was removed from any turn is not counted.
    """
    detections = []
    for i in range(len(AXES)):
        visible = [turn for turn in turns if turn.observes(np.eye(3)[i])]
        if len(visible) < 2:
            continue
        frequency, drop, log_p = pooled(
            [turn.truth[:, i] for turn in visible],
            [1 / turn.step for turn in visible],
            lowest,
            visible[0].shapes[i],
        )
        if not len(frequency):
            continue
        for turn in visible:
            noise = turn.sigma(np.eye(3)[i], frequency) * np.sqrt(2 / len(turn.truth))
            for removed in taken[turn.name]:
                leakage = removed.leaks(frequency, turn.seconds) / noise
                log_p = np.where(drop > len(visible) * leakage**2, log_p, 0.0)
        best = _least_likely(log_p, drop)
        trials = len(AXES) * len(frequency)
        p_value = float(np.exp(min(log_p[best] + np.log(trials), 0.0)))
        detections.append(
            Detection(float(drop[best]), p_value, None, float(frequency[best]), visible[0])
        )
    return detections


def _least_likely(log_p: Array, drop: Array) -> int:
    """The place of the smallest p-value; of those that are too small for a number, by the drop."""
    return int(np.argmax(np.where(log_p == log_p.min(), drop, -1.0)))


# ---- Detection against the table's angle.

ECCENTRICITY_ORDER = 1.0  # of an encoder off its axis


def best_orders(
    turns: Sequence[SteadyTurn], orders: Orders, taken: Mapping[str, Sequence[Taken]]
) -> list[Detection]:
    """The order 1, the best of all others, and the best with amplitudes of each turn: searches."""
    log_p = log_chance(orders, shortest(turns))
    leaked = np.zeros_like(orders.own)
    # What may remain of a line that was removed from any turn is no ripple.
    amplitude = np.sqrt(orders.drop) * np.where(orders.turns > 0, orders.sigma, 0.0)
    for i, turn in enumerate(turns):
        noise = turn.sigma(turn.about, orders.hertz[i]) * np.sqrt(2 / len(turn.truth))
        for removed in taken[turn.name]:
            leakage = removed.leaks(orders.hertz[i], turn.seconds)
            leaked[i] += (leakage / noise) ** 2
            exceeds = amplitude * orders.order * abs(turn.rate) > leakage
            log_p = np.where(exceeds, log_p, 0.0)
    own_drop, own_log_p = log_chance_of_own(orders, leaked, shortest(turns))
    others = np.where(orders.order > ECCENTRICITY_ORDER, log_p, 0.0)
    first, best, best_own = 0, int(np.argmin(others)), _least_likely(own_log_p, own_drop)
    many = float(len(others))
    detections = []
    for i, drop, log_chance_at, trials in (
        (first, orders.drop[first], log_p[first], 1.0),
        (best, orders.drop[best], log_p[best], many),
        (best_own, own_drop[best_own], own_log_p[best_own], many),
    ):
        p_value = float(np.exp(min(log_chance_at + np.log(trials), 0.0)))
        order, turn = float(orders.order[i]), turns[0]
        detections.append(Detection(float(drop), p_value, order, turn.hertz(order), turn))
    return detections


def shortest(turns: Sequence[SteadyTurn]) -> float:
    """Length of the shortest steady part, in revolutions."""
    return min(turn.seconds * turn.hertz(1.0) for turn in turns)


# ---- Coupling of an oscillation about one axis of the case into the others.

TABLE = "table"  # the axis that the table turns about
MIN_EXCESS_SIGMA = 5.0  # from which an axis has more than its cross term explains
MAX_CROSS_TERM_ERROR = 1e-4  # rad, 20″


@dataclass(frozen=True)
class Coupled:
    """An oscillation in the gyro of another axis; rad/s, rms over the turns of the amplitudes.

    read : as the gyro reads it; expected : by its cross term; residual : after correction by M,
    with its sigma by noise; tipping : the component of the table's rate about this axis as the
    oscillating case tips; exceeds : whether the residual exceeds the cross term's error
    """

    axis: str
    read: float
    expected: float
    residual: float
    residual_sigma: float
    tipping: float
    exceeds: bool


def direction(turn: SteadyTurn, axis: str) -> Array:
    """The unit vector of an axis of the case, or of the table's, (3,)."""
    return turn.about if axis == TABLE else np.eye(3)[AXES.index(axis)]


def coupled(
    turns: Sequence[SteadyTurn], axis: str, frequencies: Mapping[str, float]
) -> list[Coupled]:
    """The other axes; none for an oscillation about the table's axis, which differs by turn."""
    known = [turn for turn in turns if turn.name in frequencies]
    if axis == TABLE or not known:
        return []
    source = AXES.index(axis)
    truth = np.array([_phasors(turn, frequencies[turn.name]) for turn in known])
    matrix = known[0].matrix
    read = _rms(truth @ matrix.T)
    size = _rms(truth)
    noise = np.array(
        [[_sigma(turn, i, frequencies[turn.name]) for i in range(len(AXES))] for turn in known]
    )
    # What noise leaves of the mean square of k amplitudes scatters by 2 σ²/√k.
    sigma = np.sqrt(2 * np.mean(noise**2, axis=0) / np.sqrt(len(known)))
    axes = []
    for i, name in enumerate(AXES):
        if i == source:
            continue
        tips = [
            _tipping(turn, truth[k, source], frequencies[turn.name], source, i)
            for k, turn in enumerate(known)
        ]
        residual = float(np.sqrt(max(size[i] ** 2 - 2 * np.mean(noise[:, i] ** 2), 0.0)))
        axes.append(
            Coupled(
                name,
                float(read[i]),
                float(abs(matrix[i, source]) * size[source]),
                residual,
                float(sigma[i]),
                float(_rms(np.array(tips))),
                bool(
                    residual
                    > max(np.sqrt(MIN_EXCESS_SIGMA) * sigma[i], MAX_CROSS_TERM_ERROR * size[source])
                ),
            )
        )
    return axes


def _phasors(turn: SteadyTurn, frequency: float) -> NDArray[np.complex128]:
    share = float(np.sinc(frequency * turn.step)) if turn.averaged else 1.0
    parts = [phasor(record, 1 / turn.step, frequency) / share for record in turn.truth.T]
    return np.array(parts, dtype=np.complex128)


def _sigma(turn: SteadyTurn, i: int, frequency: float) -> float:
    """Standard deviation of either part of an amplitude at a frequency, Hz, in rad/s."""
    return float(turn.sigma(np.eye(3)[i], frequency) * np.sqrt(2 / len(turn.truth)))


def _tipping(turn: SteadyTurn, size: complex, frequency: float, source: int, i: int) -> float:
    """The case tips by size/(2πf), so a third axis has a component of the table's rate."""
    across = cross(np.eye(3)[source], turn.about)[i]
    rate = 0.0 if np.isnan(turn.rate) else turn.rate
    return float(abs(size) / (2 * np.pi * frequency) * abs(rate * across))


def _rms(values: NDArray[np.complex128] | Array) -> Array:
    """Root mean square over the turns."""
    return np.asarray(np.sqrt(np.mean(np.abs(values) ** 2, axis=0)))

"""The search for oscillations: in which channels, periodic in time or in angle."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.periodic_in_angle import (
    Orders,
    Ripple,
    detection_limit,
    fitted,
    grid,
    search,
)
from inertial.estimation.periodic_in_time import (
    MIN_LOG_ODDS,
    Taken,
    energy,
    in_angle,
    in_time,
    line_at,
    near,
    phasor,
    without_line,
)
from inertial.tables import AXES, GYRO
from stages.criticism.oscillation_fits import (
    ECCENTRICITY_ORDER,
    TABLE,
    Coupled,
    Detection,
    MeanLine,
    TurnLine,
    best_orders,
    combined,
    coupled,
    direction,
    in_all,
    in_turns,
    shortest,
    strongest_lines,
)

Array = NDArray[np.float64]

# ---- Whether an oscillation is periodic in time or in angle, and about which axis it arises.

MAX_START_ERROR = 1e-5  # rad, 2″, of the angle at which the table starts a turn
MAX_ORDER_SHIFT = 0.5  # bins between an order in the search and refined
MIN_FREE_ORDER_DROP = 9.0  # of chi-squared, by an order other than 1
MIN_REFINED_DROP = 30.0  # of chi-squared, from which a turn has a frequency of its own
MIN_PERIODS = 3.0  # in a turn, for a frequency of its own
TIME, ANGLE = "time", "angle"


@dataclass(frozen=True)
class Oscillation:
    """An oscillation over all turns.

    periodic_in : time or angle, whichever is likelier; axis : x, y or z of the case, or the
    table's, about which it arises; log_odds : natural logarithm of its odds against the other
    frequencies : Hz, in each turn; mean : over the turns, as one in time; ripple : as one against
    the angle, None where no angle is known; lines : its line in each turn; coupled : the other
    axes of the case; eccentric : whether of the order 1
    """

    periodic_in: str
    axis: str
    log_odds: float
    p_value: float
    frequencies: Mapping[str, float]
    mean: MeanLine
    ripple: Ripple | None
    lines: Sequence[TurnLine]
    coupled: Sequence[Coupled]

    @property
    def decided(self) -> bool:
        """Whether the data distinguish time from angle."""
        return self.log_odds >= MIN_LOG_ODDS


def explanation_of(
    detection: Detection, turns: Sequence[SteadyTurn], lowest: float, level: float
) -> Oscillation:
    """The more likely explanation of a detection, and its odds against the other."""
    angle_score, axis_of_ripple, ripple = _in_angle(detection, turns)
    time_score, axis, lines = _in_time(detection, turns, lowest)
    rates = [turn for turn in turns if np.isfinite(turn.rate)]
    periodic_in, frequencies = TIME, {line.manoeuvre: line.line.frequency for line in lines}
    if ripple is not None and angle_score > time_score:
        periodic_in, axis = ANGLE, axis_of_ripple
        frequencies = {turn.name: turn.hertz(ripple.order) for turn in rates}
        lines = _lines(turns, axis, frequencies, lowest, fixed=True)
    clear = _clear(lines, turns, level)
    mean = combined(clear)
    if periodic_in == TIME:
        own = {line.manoeuvre: line.line.frequency for line in clear}
        frequencies = {turn.name: own.get(turn.name, mean.frequency) for turn in turns}
    names = [line.manoeuvre for line in clear]
    return Oscillation(
        periodic_in,
        axis,
        abs(angle_score - time_score),
        detection.p_value,
        frequencies,
        mean,
        ripple,
        lines if periodic_in == ANGLE else clear,
        coupled([turn for turn in turns if turn.name in names], axis, frequencies),
    )


def _in_angle(
    detection: Detection, turns: Sequence[SteadyTurn]
) -> tuple[float, str, Ripple | None]:
    """The best score of an order about any axis, the axis, and the ripple."""
    known = [turn for turn in turns if np.isfinite(turn.rate)]
    order = detection.order
    if order is None and np.isfinite(detection.turn.rate):
        order = detection.frequency / detection.turn.hertz(1.0)
    best: tuple[float, str, Ripple | None] = (-np.inf, TABLE, None)
    if order is None:
        return best
    for axis in (TABLE, *AXES):
        courses = [turn.course(direction(turn, axis)) for turn in known]
        width = MAX_ORDER_SHIFT / max(course.turned for course in courses)
        ripple = fitted(courses, order, width)
        trials = float(len(grid(courses)) * (1 + len(AXES)))
        if axis == TABLE and abs(ripple.order - ECCENTRICITY_ORDER) < 2 * width:
            eccentric = fitted(courses, ECCENTRICITY_ORDER, 0.0)
            if ripple.drop - eccentric.drop < MIN_FREE_ORDER_DROP:
                ripple, trials = eccentric, 1.0
        drop = ripple.drop + ripple.apart - ripple.beyond(MAX_START_ERROR)
        score = in_angle(max(drop, ripple.drop), trials)
        if score > best[0]:
            best = (score, axis, ripple)
    return best


def _in_time(
    detection: Detection, turns: Sequence[SteadyTurn], lowest: float
) -> tuple[float, str, list[TurnLine]]:
    """The best score of a frequency about any axis, the axis, and its line in each turn."""
    tried = {detection.frequency}
    if detection.order is not None:
        tried = {round(turn.hertz(detection.order), 6) for turn in turns if np.isfinite(turn.rate)}
    best: tuple[float, str, list[TurnLine]] = (-np.inf, TABLE, [])
    bins = max(turn.seconds / turn.step for turn in turns)
    for frequency in sorted(tried):
        frequencies = {turn.name: frequency for turn in turns}
        for axis in (*AXES, TABLE):
            lines = _lines(turns, axis, frequencies, lowest)
            if not lines:
                continue
            known = [line for line in lines if line.drop > MIN_REFINED_DROP]
            mean = combined(known).frequency if known else frequency
            same = _lines(turns, axis, dict.fromkeys(frequencies, mean), lowest, fixed=True)
            score = in_time(
                np.array([line.drop for line in lines]),
                np.array([line.line.amplitude for line in same]),
                np.array([line.drop for line in same]),
                bins * (1 + len(AXES)),
            )
            if score > best[0]:
                best = (score, axis, lines)
    return best


def _lines(
    turns: Sequence[SteadyTurn],
    axis: str,
    frequencies: Mapping[str, float],
    lowest: float,
    fixed: bool = False,
) -> list[TurnLine]:
    """The line of each turn at or near its frequency; none from half the sample rate on."""
    lines = []
    for turn in turns:
        frequency, rate = frequencies.get(turn.name, np.inf), 1 / turn.step
        along = direction(turn, axis)
        if frequency >= rate / 2 or not turn.observes(along):
            continue
        record, sigma = turn.along(along), turn.sigma(along)
        drop = energy(record, rate, frequency) / sigma**2
        line = line_at(record, rate, lowest, frequency, 1.0)
        if drop > MIN_REFINED_DROP and not fixed and frequency * turn.seconds > MIN_PERIODS:
            line = near(record, rate, lowest, frequency, 1.0)
            drop = energy(record, rate, line.frequency) / sigma**2
        searched = min(len(record) * float(np.exp(-min(drop / 2, 700.0))), 1.0)
        lines.append(TurnLine(turn.name, axis, turn.whole(replace(line, p_value=searched)), drop))
    return lines


def _clear(
    lines: Sequence[TurnLine], turns: Sequence[SteadyTurn], level: float
) -> Sequence[TurnLine]:
    """The turns that show a line by themselves; all where none does."""
    trials = len(turns) * len(AXES)
    return [line for line in lines if line.line.p_value * trials < level] or lines


# ---- The oscillations of all turns of one mount, one after another.

MAX_OSCILLATIONS = 6  # that are searched for one after another
SEARCHES = 4  # in each turn, in all turns, of orders, of the order 1: equal shares of the level


@dataclass(frozen=True)
class SearchResult:
    """The oscillations of the turns of one mount.

    oscillations : in the order of their detection
    strongest : the strongest line in time of each axis and turn before any was removed
    orders : those of the last search; None without a turn whose angle is known
    remaining : of the last search, the most significant in time, the order 1, and the best other
    sigmas : (m,), multiples of sigma from which an order is detected
    truncated : whether the last search detected another beyond the largest number
    """

    turns: Sequence[SteadyTurn]
    oscillations: Sequence[Oscillation]
    strongest: Sequence[TurnLine]
    orders: Orders | None
    remaining: Sequence[Detection]
    sigmas: Array
    truncated: bool


def find_oscillations(turns: Sequence[SteadyTurn], level: float, lowest: float) -> SearchResult:
    """Find the most significant oscillation, remove it, and search again.

    level : accepted probability of a false detection; lowest : Hz, of lines in time
    """
    share = level / SEARCHES
    remaining, taken = list(turns), {turn.name: list[Taken]() for turn in turns}
    oscillations: list[Oscillation] = []
    first: list[TurnLine] = []
    while True:
        lines = [
            line for turn in remaining for line in strongest_lines(turn, lowest, taken[turn.name])
        ]
        first = first if oscillations else lines
        turning = [turn for turn in remaining if np.isfinite(turn.rate)]
        orders = search([turn.course(turn.about) for turn in turning]) if turning else None
        against = [] if orders is None else best_orders(turning, orders, taken)
        every = [*in_turns(lines, remaining), *in_all(remaining, taken, lowest), *against]
        significant = [detection for detection in every if detection.p_value < share]
        if not significant or len(oscillations) == MAX_OSCILLATIONS:
            break
        largest = max(significant, key=lambda detection: detection.drop)
        oscillations.append(explanation_of(largest, remaining, lowest, share))
        remaining = [_without(turn, oscillations[-1], taken[turn.name]) for turn in remaining]
    sigmas = np.zeros(0) if orders is None else detection_limit(orders, shortest(turning), share)
    return SearchResult(turns, oscillations, first, orders, every, sigmas, bool(significant))


def _without(turn: SteadyTurn, oscillation: Oscillation, taken: list[Taken]) -> SteadyTurn:
    """A turn without an oscillation, of which amplitude and phase are fitted about each axis."""
    frequency = oscillation.frequencies.get(turn.name)
    if frequency is None:
        return turn
    parts = [without_line(record, 1 / turn.step, frequency) for record in turn.truth.T]
    taken.append(Taken(frequency, max(part.amplitude for part in parts)))
    residuals = [
        record - part.amplitude * part.shape
        for record, part in zip(turn.truth.T, parts, strict=True)
    ]
    return replace(turn, truth=np.column_stack(residuals))


# ---- Removal of the oscillations from the blocks of turns.
#
# Where a block holds no whole number of periods the mean of an oscillation over it is not zero,
# and beats over many blocks: it would be taken for effects that depend on time or angle.


def without_lines(
    blocks: pd.DataFrame, turns: Sequence[SteadyTurn], lines: Sequence[Oscillation]
) -> pd.DataFrame:
    """The same blocks, each line removed from the steady ones with its own phase in each turn.

    The angle of a turn is unchanged: from rest to rest an oscillation adds none, nor does a ripple
    of integer order. What it adds in the steady part is removed while the table accelerates and
    decelerates.
    """
    if not lines:
        return blocks
    quiet = blocks.copy()
    for turn in turns:
        own = (blocks["manoeuvre"] == turn.name) & (blocks["phase"] == "steady")
        if own.any() and np.isfinite(turn.start):
            rates = _mean_rates(turn, lines, blocks[own])
            rates -= np.average(rates, axis=0, weights=blocks.loc[own, "seconds"])
            quiet.loc[own, GYRO] -= rates @ turn.matrix.T
    return quiet


def _mean_rates(turn: SteadyTurn, lines: Sequence[Oscillation], blocks: pd.DataFrame) -> Array:
    """The mean rates of all lines in blocks of a turn, (k, 3), rad/s, about the case's axes."""
    rates = turn.truth.copy()
    time = turn.step * np.arange(len(rates))
    since = blocks["time"].to_numpy(np.float64) - turn.start
    count = blocks["count"].to_numpy(np.float64)
    means = np.zeros((len(blocks), 3))
    for line in lines:
        frequency = line.frequencies.get(turn.name)
        if frequency is None:
            continue
        half = np.pi * frequency * turn.step
        share = np.sin(count * half) / (count * np.sin(half))  # of a sum of `count` samples
        for axis in range(3):
            amplitude = phasor(rates[:, axis], 1 / turn.step, frequency)
            rates[:, axis] -= np.real(amplitude * np.exp(2j * np.pi * frequency * time))
            means[:, axis] += share * np.real(amplitude * np.exp(2j * np.pi * frequency * since))
    return means

"""To what an oscillation is bound: time or the table's angle; and about which axis it arises."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from stages.contracts.tables import AXES
from stages.estimation.against_angle import ECCENTRIC
from stages.estimation.coupling import TABLE, Coupled, coupled, direction
from stages.estimation.ringing import Oscillating, Ringing, together
from stages.estimation.standing_out import Stands
from stages.estimation.steady_turns import SteadyTurn
from stages.inference.binding import TELLS, in_angle, in_time
from stages.inference.fitted_order import Ripple, fitted
from stages.inference.lines import energy, line_at, near
from stages.inference.orders import grid

TOLERANCE = 1e-5  # rad, 2″: at what angle a table starts a turn
WIDTH = 0.5  # bins by which an order may be off where it was seen first
FREER = 9.0  # drop of chi-squared that an order other than 1 must bring beside 1
REFINED = 30.0  # drop of chi-squared from which a turn tells its frequency itself
PERIODS = 3.0  # in a turn, without which it does not
TIME, ANGLE = "time", "angle"


@dataclass(frozen=True)
class Bound:
    """An oscillation over all turns.

    bound : to time or to the angle, whichever is likelier; axis : x, y or z of the case, or the
    table's, about which it arises; log_odds : natural logarithm of its odds against the other
    frequencies : Hz, in each turn; oscillating : as one in time; ripple : as one against the angle,
    None where no angle is known; shown : its line in each turn; through : the other axes of the
    case; eccentric : whether of the order 1
    """

    bound: str
    axis: str
    log_odds: float
    p_value: float
    frequencies: Mapping[str, float]
    oscillating: Oscillating
    ripple: Ripple | None
    shown: Sequence[Ringing]
    through: Sequence[Coupled]

    @property
    def told(self) -> bool:
        """Whether the data tell time from angle."""
        return self.log_odds >= TELLS


def explained(seed: Stands, turns: Sequence[SteadyTurn], lowest: float, level: float) -> Bound:
    """Both explanations of what stands out, and the better one."""
    angle_score, axis_of_ripple, ripple = _in_angle(seed, turns)
    time_score, axis, lines = _in_time(seed, turns, lowest)
    rates = [turn for turn in turns if np.isfinite(turn.rate)]
    bound, frequencies = TIME, {one.manoeuvre: one.line.frequency for one in lines}
    if ripple is not None and angle_score > time_score:
        bound, axis = ANGLE, axis_of_ripple
        frequencies = {turn.name: turn.hertz(ripple.order) for turn in rates}
        lines = _lines(turns, axis, frequencies, lowest, fixed=True)
    clear = _clear(lines, turns, level)
    oscillating = together(clear)
    if bound == TIME:
        own = {one.manoeuvre: one.line.frequency for one in clear}
        frequencies = {turn.name: own.get(turn.name, oscillating.frequency) for turn in turns}
    names = [one.manoeuvre for one in clear]
    return Bound(
        bound,
        axis,
        abs(angle_score - time_score),
        seed.p_value,
        frequencies,
        oscillating,
        ripple,
        lines if bound == ANGLE else clear,
        coupled([turn for turn in turns if turn.name in names], axis, frequencies),
    )


def _in_angle(seed: Stands, turns: Sequence[SteadyTurn]) -> tuple[float, str, Ripple | None]:
    """The best score of one order about any axis, the axis, and the ripple."""
    known = [turn for turn in turns if np.isfinite(turn.rate)]
    order = seed.order
    if order is None and np.isfinite(seed.turn.rate):
        order = seed.frequency / seed.turn.hertz(1.0)
    best: tuple[float, str, Ripple | None] = (-np.inf, TABLE, None)
    if order is None:
        return best
    for axis in (TABLE, *AXES):
        courses = [turn.course(direction(turn, axis)) for turn in known]
        width = WIDTH / max(one.turned for one in courses)
        ripple = fitted(courses, order, width)
        trials = float(len(grid(courses)) * (1 + len(AXES)))
        if axis == TABLE and abs(ripple.order - ECCENTRIC) < 2 * width:
            eccentric = fitted(courses, ECCENTRIC, 0.0)
            if ripple.drop - eccentric.drop < FREER:
                ripple, trials = eccentric, 1.0
        drop = ripple.drop + ripple.apart - ripple.beyond(TOLERANCE)
        score = in_angle(max(drop, ripple.drop), trials)
        if score > best[0]:
            best = (score, axis, ripple)
    return best


def _in_time(
    seed: Stands, turns: Sequence[SteadyTurn], lowest: float
) -> tuple[float, str, list[Ringing]]:
    """The best score of one frequency about any axis, the axis, and its line in each turn."""
    tried = {seed.frequency}
    if seed.order is not None:
        tried = {round(turn.hertz(seed.order), 6) for turn in turns if np.isfinite(turn.rate)}
    best: tuple[float, str, list[Ringing]] = (-np.inf, TABLE, [])
    bins = max(turn.seconds / turn.step for turn in turns)
    for frequency in sorted(tried):
        everywhere = {turn.name: frequency for turn in turns}
        for axis in (*AXES, TABLE):
            lines = _lines(turns, axis, everywhere, lowest)
            if not lines:
                continue
            known = [one for one in lines if one.drop > REFINED]
            one = together(known).frequency if known else frequency
            same = _lines(turns, axis, dict.fromkeys(everywhere, one), lowest, fixed=True)
            score = in_time(
                np.array([ring.drop for ring in lines]),
                np.array([ring.line.amplitude for ring in same]),
                np.array([ring.drop for ring in same]),
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
) -> list[Ringing]:
    """The line of each turn at its frequency, or near it; nothing from half the sample rate on."""
    found = []
    for turn in turns:
        frequency, rate = frequencies.get(turn.name, np.inf), 1 / turn.step
        along = direction(turn, axis)
        if frequency >= rate / 2 or not turn.tells(along):
            continue
        record, sigma = turn.along(along), turn.sigma(along)
        drop = energy(record, rate, frequency) / sigma**2
        line = line_at(record, rate, lowest, frequency, 1.0)
        if drop > REFINED and not fixed and frequency * turn.seconds > PERIODS:
            line = near(record, rate, lowest, frequency, 1.0)
            drop = energy(record, rate, line.frequency) / sigma**2
        searched = min(len(record) * float(np.exp(-min(drop / 2, 700.0))), 1.0)
        found.append(Ringing(turn.name, axis, turn.whole(replace(line, p_value=searched)), drop))
    return found


def _clear(
    lines: Sequence[Ringing], turns: Sequence[SteadyTurn], level: float
) -> Sequence[Ringing]:
    """The turns that show a line by themselves; all where none does."""
    trials = len(turns) * len(AXES)
    return [one for one in lines if one.line.p_value * trials < level] or lines

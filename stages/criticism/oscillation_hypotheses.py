"""Whether a line of the turns is bound to time or to the table's angle: the frequency decides.

Bound to time it has one frequency f in all turns, bound to the angle one order n, so the frequency
n θ'/2π in a turn at the rate θ'. Amplitude and phase are free in each turn under either hypothesis:
how an amplitude depends on the rate, and at which tooth of a gear a turn starts, is unknown
beforehand. What turns with the table does so about its axis in every turn; what vibrates in the
case, about one axis of the case. Where all turns that show it have one rate, the frequency does not
distinguish them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from inertial.arrays import Array
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.periodic_in_angle import (
    MAX_ORDER_SHIFT,
    MIN_REMAINING_SHARE,
    STEPS_PER_PERIOD,
    Ripple,
    fitted,
    ripple_of,
)
from inertial.estimation.periodic_in_time import score, score_of_own_frequency
from inertial.tables import AXES
from stages.criticism.oscillation_fits import ECCENTRICITY_ORDER, TABLE, Detection, direction

TIME, ANGLE = "time", "angle"
IN_TIME, RIPPLE, ECCENTRICITY = "oscillation", "table_ripple", "table_eccentricity"
TRIED = (*AXES, TABLE)  # axes about which a line may arise

MIN_LOG_ODDS = 3.0  # of one of two hypotheses to be accepted alone: 20 to 1
MIN_PERIODS = 3.0  # in a turn, of what is bound to time; slower it is not distinguished from drift
MIN_PERIODS_REMOVED = 0.5  # in a turn; an alias slower than that is bias and slope
MIN_REFINED_DROP = 30.0  # of chi-squared, from which a turn has a frequency of its own
MIN_FREE_ORDER_DROP = 9.0  # of chi-squared, by an order other than 1
FAVOURED_SHARE = 0.5  # of the best score, from which a favoured hypothesis comes first
MIN_RATE_RATIO = 1.001  # of two rates of the table that are not the same


def folded(frequency: float, step: float) -> float:
    """The frequency, Hz, at which samples at intervals of `step`, s, show one, or its alias."""
    return abs(frequency - round(frequency * step) / step)


class Probe:
    """A turn of which the drop of chi-squared by lines is wanted, bias and slope fitted too.

    Where gravity rotates in the case its harmonics are fitted too.
    """

    def __init__(self, turn: SteadyTurn) -> None:
        self.turn = turn
        n = len(turn.truth)
        self.time = turn.step * (np.arange(n) - (n - 1) / 2)
        if np.isfinite(turn.rate):
            self.slow = turn.course(turn.about).slow
        else:
            self.slow = np.linalg.qr(np.column_stack([np.ones(n), self.time]))[0]
        self.rest = turn.truth - self.slow @ (self.slow.T @ turn.truth)
        self.directions = np.array([direction(turn, axis) for axis in TRIED])
        self.seen = np.array([turn.observes(along) for along in self.directions])

    def drops(self, frequency: float) -> Array:
        """By a line at a frequency, Hz, or its alias, about each axis of `TRIED`, (4,)."""
        seen_at = folded(frequency, self.turn.step)
        phase = 2 * np.pi * seen_at * self.time
        shapes = np.column_stack([np.sin(phase), np.cos(phase)])
        within = self.slow.T @ shapes
        information = shapes.T @ shapes - within.T @ within
        if np.linalg.det(information) <= (MIN_REMAINING_SHARE * len(phase)) ** 2:
            return np.zeros(len(TRIED))
        sigmas = [self.turn.sigma(along, seen_at) for along in self.directions]
        parts = (shapes.T @ self.rest) @ self.directions.T / np.where(self.seen, sigmas, np.inf)
        return np.asarray(np.sum(parts * np.linalg.solve(information, parts), axis=0))

    def own_frequency(self, frequency: float) -> float:
        """The frequency within a bin of one, Hz, at which the turn has most of it."""
        best = minimize_scalar(
            lambda tried: -float(self.drops(tried).max()),
            bounds=(frequency - 1 / self.turn.seconds, frequency + 1 / self.turn.seconds),
            method="bounded",
            options={"xatol": 1e-4 / self.turn.seconds},
        )
        return float(best.x)


@dataclass(frozen=True)
class Hypothesis:
    """A line bound to time, `value` its frequency in Hz, or to the angle, its order.

    axis : x, y or z of the case, or the table's; score : as in `periodic_in_time.score`, of all
    turns; frequencies : Hz, in each turn, to within a bin; ripple : the order against the angle
    """

    bound_to: str
    axis: str
    value: float
    score: float
    frequencies: Mapping[str, float]
    ripple: Ripple | None = None

    @property
    def effect(self) -> str:
        """The effect of the catalogue."""
        if self.bound_to == TIME or self.axis != TABLE:
            return IN_TIME
        return ECCENTRICITY if self.ripple and self.ripple.order_sigma == 0 else RIPPLE


def hypotheses_of(detection: Detection, turns: Sequence[SteadyTurn]) -> list[Hypothesis]:
    """The likeliest hypothesis of each effect, the likeliest of all first.

    None where no turn has half a period of it, so that it can be removed from none.
    """
    every = [Probe(turn) for turn in turns]
    known = [probe for probe in every if np.isfinite(probe.turn.rate)]
    paces = _different([probe.turn.hertz(1.0) for probe in known])
    in_time = {detection.frequency: 0.0}
    # An alias of a line has to be the better of the two.
    unfolded = {1 / detection.turn.step - detection.frequency: -MIN_LOG_ODDS, **in_time}
    orders = {
        frequency / pace: handicap for frequency, handicap in unfolded.items() for pace in paces
    }
    if detection.order is not None:
        orders = {detection.order: 0.0}
        in_time = {folded(detection.order * pace, turns[0].step): 0.0 for pace in paces}
        longest = max(turn.seconds for turn in turns)
        in_time = {f: handicap for f, handicap in in_time.items() if f * longest >= MIN_PERIODS}
    found = _best(every, TIME, in_time)
    if eccentric := _eccentric(detection, known):
        found.append(eccentric)
    else:
        # What arises about an axis of the case is bound to the angle only if that is likelier.
        at_least = max((one.score for one in found), default=-np.inf) + MIN_LOG_ODDS
        in_angle = _best(known, ANGLE, orders)
        found += [one for one in in_angle if one.axis == TABLE or one.score > at_least]
    found = sorted((one for one in found if one.frequencies), key=lambda one: one.score)
    of_effect = {one.effect: one for one in found}
    likeliest = [one for one in reversed(found) if of_effect[one.effect] is one]
    # As likely in time as against the angle, one phase against the angle in all turns comes first.
    if len(likeliest) > 1 and abs(likeliest[0].score - likeliest[1].score) < MIN_LOG_ODDS:
        likeliest.sort(key=lambda one: bool(one.ripple and one.ripple.common), reverse=True)
    return likeliest


def favouring(hypotheses: Sequence[Hypothesis], favoured: str) -> list[Hypothesis]:
    """What is bound to time, or to the angle, first if it explains half as much as the best."""
    enough = FAVOURED_SHARE * max(one.score for one in hypotheses)
    return sorted(
        hypotheses,
        key=lambda one: one.bound_to == favoured and one.score >= enough,
        reverse=True,
    )


def _different(paces: Sequence[float]) -> list[float]:
    """Revolutions per second, those that are the same once."""
    kept: list[float] = []
    for pace in sorted(paces):
        if not kept or pace > MIN_RATE_RATIO * kept[-1]:
            kept.append(pace)
    return kept


def _eccentric(detection: Detection, known: Sequence[Probe]) -> Hypothesis | None:
    """An order 1, the same in all turns; none where another order near it fits better.

    It is the only one that is looked for there: any other line is one among as many as are tried.
    """
    if detection.order is None:
        return None
    courses = [probe.turn.course(probe.turn.about) for probe in known]
    width = MAX_ORDER_SHIFT / max(course.turned for course in courses)
    if abs(detection.order - ECCENTRICITY_ORDER) >= 4 * width:
        return None
    ripple = fitted(courses, detection.order, width)
    eccentric = fitted(courses, ECCENTRICITY_ORDER, 0.0)
    if (
        abs(ripple.order - ECCENTRICITY_ORDER) >= 2 * width
        or ripple.drop - eccentric.drop >= MIN_FREE_ORDER_DROP
    ):
        return None
    frequencies = {probe.turn.name: probe.turn.hertz(ECCENTRICITY_ORDER) for probe in known}
    tried = max(len(probe.time) for probe in known)
    likely = float(score(np.array(eccentric.drop)) + np.log(tried))
    return Hypothesis(ANGLE, TABLE, ECCENTRICITY_ORDER, likely, frequencies, eccentric)


def _best(
    probes: Sequence[Probe], bound_to: str, starts: Mapping[float, float]
) -> list[Hypothesis]:
    """The best frequency, or order, near one of the starts, each with a handicap of its score.

    Bound to time about the likeliest axis; bound to the angle about the table's, and about one of
    the case where that is likelier.
    """
    if not starts or not probes:
        return []
    per_unit = np.array([p.turn.hertz(1.0) if bound_to == ANGLE else 1.0 for p in probes])
    lengths = per_unit * [probe.turn.seconds for probe in probes]

    def scores(value: float) -> Array:
        drops = [p.drops(value * pace) for p, pace in zip(probes, per_unit, strict=True)]
        return np.asarray(score(np.array(drops)).sum(axis=0))

    start = max(starts, key=lambda value: float(scores(value).max()) + starts[value])
    axis = int(np.argmax(scores(start)))
    apart = 1 / (STEPS_PER_PERIOD * float(lengths.max()))
    reach = int(np.ceil(1 / float(lengths.min()) / apart))
    tried = start + apart * np.arange(-reach, reach + 1)
    tried = tried[tried > start / 2]
    near = float(tried[np.argmax([scores(float(value))[axis] for value in tried])])
    value = float(
        minimize_scalar(
            lambda value: -float(scores(value)[axis]),
            bounds=(near - apart, near + apart),
            method="bounded",
            options={"xatol": 1e-4 * apart},
        ).x
    )
    total, frequencies = np.zeros(len(TRIED)), {}
    for probe, pace in zip(probes, per_unit, strict=True):
        name, frequency = probe.turn.name, folded(value * float(pace), probe.turn.step)
        drops = probe.drops(frequency)
        own = score(drops)
        if drops.max() > MIN_REFINED_DROP and frequency * probe.turn.seconds > MIN_PERIODS:
            near_it = probe.own_frequency(frequency)
            own = np.maximum(own, score_of_own_frequency(probe.drops(near_it)))
            frequency = near_it
        total += own
        if frequency * probe.turn.seconds > MIN_PERIODS_REMOVED:
            frequencies[name] = frequency
    best = int(np.argmax(total[: len(AXES)]))
    of_case, of_table = float(total[best]), float(total[-1])
    if bound_to == TIME:
        named, likely = (TRIED[best], of_case) if of_case >= of_table else (TABLE, of_table)
        return [Hypothesis(TIME, named, value, likely, frequencies)]
    courses = {
        a: [p.turn.course(direction(p.turn, a)) for p in probes] for a in (TRIED[best], TABLE)
    }
    axes = [(TABLE, of_table)]
    if of_case - of_table >= MIN_LOG_ODDS:
        axes.append((TRIED[best], of_case))
    return [
        Hypothesis(ANGLE, named, value, likely, frequencies, ripple_of(courses[named], value))
        for named, likely in axes
    ]

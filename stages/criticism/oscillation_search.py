"""Oscillations in the turns of one mount: search, removal from the blocks, shifts of parameters."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inertial.arrays import Array
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.periodic_in_angle import Orders, Ripple, detection_limit, search
from inertial.estimation.periodic_in_time import Taken, line_at, without_line
from inertial.tables import AXES
from stages.criticism.angle_steps import (
    MIN_ORDERS,
    StepInTurn,
    StepPerTurn,
    step_per_turn,
    without_steps,
)
from stages.criticism.oscillation_fits import (
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
from stages.criticism.oscillation_hypotheses import (
    ANGLE,
    ECCENTRICITY,
    IN_TIME,
    MIN_LOG_ODDS,
    RIPPLE,
    TIME,
    Hypothesis,
    favouring,
    folded,
    hypotheses_of,
)

MAX_MULTIPLE = 10  # of a frequency or an order, that is still the same cause
MAX_ALIAS_MULTIPLE = 3  # the same beyond half the sample rate
MULTIPLE_SIGMAS = 4.0  # within which a line is a multiple of another
MAX_MULTIPLE_SHARE = 0.02  # of a frequency or an order: less certain, a multiple is not informative
# By which the order of a line of a step may be off from a whole number: in turns of about one
# revolution its other lines, that are not found yet, draw it along by more than its sigma.
MAX_FROM_WHOLE = 0.1
UNRESOLVED_BINS = 2.0  # between two lines, that are one whose frequency wanders


@dataclass(frozen=True)
class Oscillation:
    """An oscillation over all turns.

    hypotheses : the likeliest of each effect that it may be, the likeliest first
    p_value : of its detection; mean : over the turns that show it, as a line in time
    lines : its line in each turn; coupled : the other axes of the case
    multiples : further lines of the same cause, at multiples of its frequency or order
    at_rest : whether it goes on while the table rests
    step : of the table's angle in each turn, that explains it and its multiples
    """

    hypotheses: Sequence[Hypothesis]
    p_value: float
    mean: MeanLine
    lines: Sequence[TurnLine]
    coupled: Sequence[Coupled]
    multiples: Sequence["Oscillation"] = ()
    at_rest: bool = False
    step: StepPerTurn | None = None

    @property
    def likeliest(self) -> Hypothesis:
        """The likeliest hypothesis."""
        return self.hypotheses[0]

    @property
    def log_odds(self) -> float:
        """Logarithm of the odds of the likeliest against the other, its multiples included."""
        if len(self.hypotheses) < 2:
            return np.inf
        return sum(_lead(part.hypotheses, self.likeliest.effect) for part in self.parts)

    @property
    def effects(self) -> Sequence[str]:
        """The effects that it may be, the likeliest first."""
        decided = self.log_odds >= MIN_LOG_ODDS
        return [one.effect for one in (self.hypotheses[:1] if decided else self.hypotheses)]

    @property
    def ripple(self) -> Ripple | None:
        """Its order against the angle, where it has one."""
        return next((one.ripple for one in self.hypotheses if one.ripple), None)

    @property
    def order(self) -> int | None:
        """The whole number near its order against the table's angle, the same in all turns."""
        ripple = self.likeliest.ripple
        if self.likeliest.effect == IN_TIME or ripple is None or not ripple.common:
            return None
        off = abs(ripple.order - round(ripple.order))
        return round(ripple.order) if off <= MAX_FROM_WHOLE else None

    @property
    def parts(self) -> Sequence["Oscillation"]:
        """It and its multiples."""
        return (self, *self.multiples)

    def axis(self, effect: str) -> str | None:
        """The axis about which an effect that it may be has it."""
        own = (one.axis for one in self.hypotheses if one.effect == effect)
        return next(own, None) if effect in self.effects else None

    def number(self, effect: str) -> tuple[float, float] | None:
        """Frequency, Hz, or order as which an effect has it, with its sigma."""
        if effect == IN_TIME:
            return self.mean.frequency, self.mean.frequency_sigma
        if effect == RIPPLE and self.ripple:
            return self.ripple.order, self.ripple.order_sigma
        return None


def _lead(hypotheses: Sequence[Hypothesis], effect: str) -> float:
    """By how much the logarithm of the likelihood of an effect exceeds that of the other."""
    score = {one.effect: one.score for one in hypotheses}
    own = score.pop(effect, 0.0)
    return own - max(score.values(), default=0.0)


def oscillation_of(
    hypotheses: Sequence[Hypothesis],
    p_value: float,
    turns: Sequence[SteadyTurn],
    lowest: float,
    level: float,
) -> Oscillation | None:
    """What a detection with its p-value is, by its hypotheses, the likeliest first.

    None where no turn has a line at its frequency, as of readings that are nearly always equal.
    """
    likeliest = hypotheses[0]
    lines = _lines(turns, likeliest, lowest)
    clear = _clear(lines, turns, level)
    if not clear:
        return None
    names = [line.manoeuvre for line in clear]
    showing = [turn for turn in turns if turn.name in names]
    return Oscillation(
        hypotheses,
        p_value,
        combined(clear),
        clear if likeliest.effect == IN_TIME else lines,
        coupled(showing, likeliest.axis, likeliest.frequencies),
    )


def _lines(turns: Sequence[SteadyTurn], likeliest: Hypothesis, lowest: float) -> list[TurnLine]:
    """The line in each turn that observes it."""
    lines = []
    for turn in turns:
        along = direction(turn, likeliest.axis)
        frequency = likeliest.frequencies.get(turn.name)
        if frequency is None or not turn.observes(along):
            continue
        shape = turn.shape(along)
        line = line_at(turn.along(along), 1 / turn.step, lowest, frequency, 1.0, shape)
        drop = (line.amplitude / line.sigma_amplitude) ** 2
        searched = min(len(turn.truth) * float(np.exp(-min(drop / 2, 700.0))), 1.0)
        whole = turn.whole(replace(line, p_value=searched))
        lines.append(TurnLine(turn.name, likeliest.axis, whole, drop))
    return lines


def _clear(
    lines: Sequence[TurnLine], turns: Sequence[SteadyTurn], level: float
) -> Sequence[TurnLine]:
    """The turns that show a line by themselves; all where none does."""
    trials = len(turns) * len(AXES)
    return [line for line in lines if line.line.p_value * trials < level] or lines


# ---- The oscillations of all turns of one mount, one after another.

MAX_OSCILLATIONS = 6  # that are searched for one after another
# In each turn, in all turns, of orders with amplitudes of all turns and of each, of the order 1.
SEARCHES = 5  # with equal shares of the level


@dataclass(frozen=True)
class SearchResult:
    """The oscillations of the turns of one mount.

    turns : without the steps that one of them alone carries
    oscillations : in the order of their detection
    strongest : the strongest line in time of each axis and turn before any was removed
    orders : those of the last search; None without a turn whose angle is known
    remaining : of the last search, the most significant in time, the order 1, and the best other
    sigmas : (m,), multiples of sigma from which an order is detected
    truncated : whether the last search detected another beyond the largest number
    steps : that one turn alone carries, the clearest first
    """

    turns: Sequence[SteadyTurn]
    oscillations: Sequence[Oscillation]
    strongest: Sequence[TurnLine]
    orders: Orders | None
    remaining: Sequence[Detection]
    sigmas: Array
    truncated: bool
    steps: Sequence[StepInTurn] = ()


def find_oscillations(turns: Sequence[SteadyTurn], level: float, lowest: float) -> SearchResult:
    """The oscillations that explain the turns by the fewest causes.

    Where several lines are found each one taken alone may be bound to the wrong one: turns at one
    rate and at twice it have the harmonics of a ripple at one frequency. So what is bound to time,
    and what is bound to the angle, is tried first too, where it explains a line half as well.
    A step of one turn has power at all frequencies, and is left out before.

    level : accepted probability of a false detection; lowest : Hz, of lines in time
    """
    turns, steps = without_steps(turns)
    searches: dict[Removed, Search] = {}
    searches[()] = Search(turns, {turn.name: () for turn in turns}, lowest, level / SEARCHES)
    plain = replace(_searched(searches, ""), steps=steps)
    if len(plain.oscillations) < 2:
        return plain
    tried = [plain, *(_searched(searches, favoured) for favoured in (ANGLE, TIME))]
    best = min(tried, key=lambda result: (result.truncated, len(result.oscillations)))
    return replace(best, steps=steps)


@dataclass(frozen=True)
class Search:
    """One search for the most significant line in all turns, in time and against the angle.

    turns : without the lines that were found before; taken : these lines in each turn
    lowest : Hz, of lines in time; level : accepted probability of a false detection
    """

    turns: Sequence[SteadyTurn]
    taken: Mapping[str, Sequence[Taken]]
    lowest: float
    level: float

    @cached_property
    def turning(self) -> Sequence[SteadyTurn]:
        """The turns whose angle is known."""
        return [turn for turn in self.turns if np.isfinite(turn.rate)]

    @cached_property
    def lines(self) -> Sequence[TurnLine]:
        """The strongest line in time of each axis and turn."""
        every = (strongest_lines(turn, self.lowest, self.taken[turn.name]) for turn in self.turns)
        return [line for lines in every for line in lines]

    @cached_property
    def orders(self) -> Orders | None:
        """Against the angle; None without a turn whose angle is known."""
        courses = [turn.course(turn.about) for turn in self.turning]
        return search(courses) if courses else None

    @cached_property
    def detections(self) -> Sequence[Detection]:
        """The most significant in time, the order 1, and the best other."""
        against = best_orders(self.turning, self.orders, self.taken) if self.orders else []
        in_time = in_all(self.turns, self.taken, self.lowest)
        return [*in_turns(self.lines, self.turns), *in_time, *against]

    @cached_property
    def largest(self) -> Detection | None:
        """The largest of those that are significant."""
        significant = [one for one in self.detections if one.p_value < self.level]
        return max(significant, key=lambda detection: detection.drop, default=None)

    @cached_property
    def hypotheses(self) -> Sequence[Hypothesis]:
        """What the largest may be."""
        return hypotheses_of(self.largest, self.turns) if self.largest else []

    def without(self, frequencies: Mapping[str, float]) -> "Search":
        """The next search, of turns less the line at a frequency, Hz, in each."""
        turns, taken = [], dict(self.taken)
        for turn in self.turns:
            if turn.name in frequencies:
                turn, line = _without(turn, frequencies[turn.name])
                taken[turn.name] = [*taken[turn.name], line]
            turns.append(turn)
        return replace(self, turns=turns, taken=taken)


# Of each line that was removed: the turns, and its frequency in each, Hz.
Removed = tuple[tuple[tuple[str, float], ...], ...]


def _searched(searches: dict[Removed, Search], favoured: str) -> SearchResult:
    """Find the most significant oscillation, remove it, and search again.

    searches : by the lines that were removed before; those that are made here are added
    favoured : time or angle, what is bound to it comes first if it explains half as much
    """
    first = current = searches[()]
    oscillations: list[Oscillation] = []
    removed: Removed = ()
    while current.largest and current.hypotheses and len(oscillations) < MAX_OSCILLATIONS:
        hypotheses = favouring(current.hypotheses, favoured)
        p_value, lowest, level = current.largest.p_value, current.lowest, current.level
        found = oscillation_of(hypotheses, p_value, current.turns, lowest, level)
        if found is None:
            break
        oscillations.append(found)
        frequencies = hypotheses[0].frequencies
        removed = (*removed, tuple(frequencies.items()))
        if removed not in searches:
            searches[removed] = current.without(frequencies)
        current = searches[removed]
    sigmas = np.zeros(0)
    if current.orders:
        sigmas = detection_limit(current.orders, shortest(current.turning), current.level)
    return SearchResult(
        first.turns,
        in_causes(oscillations, first.turns),
        first.lines,
        current.orders,
        current.detections,
        sigmas,
        truncated=bool(current.hypotheses),
    )


def in_causes(
    oscillations: Sequence[Oscillation], turns: Sequence[SteadyTurn]
) -> Sequence[Oscillation]:
    """One oscillation for each cause, in the order of detection.

    Lines at multiples of one frequency, or of one order, have one cause, and so have lines that no
    turn resolves.
    """
    detected = {id(one): i for i, one in enumerate(oscillations)}
    causes: list[Oscillation] = []
    for one in sorted(oscillations, key=lambda one: one.mean.frequency):
        for i, cause in enumerate(causes):
            shared = [
                effect
                for effect in cause.effects
                if cause.axis(effect) == one.axis(effect) is not None
                and _is_multiple(cause, one, effect, turns)
            ]
            if shared:
                hypotheses = [each for each in cause.hypotheses if each.effect in shared]
                multiples = (*cause.multiples, one)
                causes[i] = replace(cause, hypotheses=hypotheses, multiples=multiples)
                detected[id(causes[i])] = min(detected[id(cause)], detected[id(one)])
                break
        else:
            causes.append(one)
    return _of_one_step(sorted(causes, key=lambda cause: detected[id(cause)]), turns)


def _of_one_step(
    causes: Sequence[Oscillation], turns: Sequence[SteadyTurn]
) -> Sequence[Oscillation]:
    """Ripples of whole orders as one cause, where one step in each turn explains more than they.

    Lines of a gear's teeth, and of another, are whole orders too: no step is in their sum.
    """
    whole = [one for one in causes if all(part.order is not None for part in one.parts)]
    parts = [replace(part, multiples=()) for one in whole for part in one.parts]
    ripples = [part for part in parts if part.likeliest.effect != ECCENTRICITY]
    if len(parts) < MIN_ORDERS or not ripples:
        return causes
    step = step_per_turn(turns)
    if step is None or step.drop < sum(part.ripple.drop for part in parts if part.ripple):
        return causes
    main = min(ripples, key=lambda part: part.order or 0)
    others = sorted((part for part in parts if part is not main), key=lambda part: part.order or 0)
    hypotheses = [one for one in main.hypotheses if one.effect == RIPPLE]
    of_step = replace(main, hypotheses=hypotheses, multiples=others, step=step)
    first = next(i for i, one in enumerate(causes) if one in whole)
    left = [one for one in causes[:first] if one not in whole]
    return [*left, of_step, *(one for one in causes[first:] if one not in whole)]


def _is_multiple(
    cause: Oscillation, one: Oscillation, effect: str, turns: Sequence[SteadyTurn]
) -> bool:
    """Whether an oscillation is at a whole multiple of another, as an effect has both."""
    base, other = cause.number(effect), one.number(effect)
    if base is None or other is None:
        return False
    base, other = min(base, other), max(base, other)
    length = np.nanmax([t.seconds * (1.0 if effect == IN_TIME else t.hertz(1.0)) for t in turns])
    if abs(other[0] - base[0]) * length < UNRESOLVED_BINS:
        return True
    multiples = {k: k * base[0] for k in range(2, MAX_MULTIPLE + 1)}
    if effect == IN_TIME:
        aliased = range(2, MAX_ALIAS_MULTIPLE + 1)
        multiples |= {k: folded(k * base[0], turns[0].step) for k in aliased}
    within = {k: MULTIPLE_SIGMAS * float(np.hypot(k * base[1], other[1])) for k in multiples}
    return any(
        abs(other[0] - at) < within[k] < MAX_MULTIPLE_SHARE * base[0] for k, at in multiples.items()
    )


def _without(turn: SteadyTurn, frequency: float) -> tuple[SteadyTurn, Taken]:
    """A turn less a line, of which amplitude and phase are fitted about each axis; and the line."""
    parts = [without_line(record, 1 / turn.step, frequency) for record in turn.truth.T]
    residuals = [
        record - part.amplitude * part.shape
        for record, part in zip(turn.truth.T, parts, strict=True)
    ]
    taken = Taken(frequency, max(part.amplitude for part in parts))
    return replace(turn, truth=np.column_stack(residuals)), taken

"""Sentences about oscillations, detected and not detected: each a template with named values."""

from collections.abc import Sequence
from math import degrees, exp, pi

import numpy as np

from inertial.arrays import Array
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.periodic_in_angle import Ripple
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import counted, fixed, plus_minus, significant
from inertial.text.typography import capital
from inertial.text.units import ARC_SECOND
from stages.criticism.angle_steps import StepPerTurn
from stages.criticism.oscillation_fits import MIN_EXCESS_SIGMA, TABLE, Coupled
from stages.criticism.oscillation_hypotheses import ANGLE, IN_TIME
from stages.criticism.oscillation_search import Oscillation

MAX_ALIKE_LOG_ODDS = 0.7  # a factor of two
MAX_LOG_ODDS = 40.0  # beyond which the number of the odds is not informative
MIN_PERIODS_IN_TURN = 1.5  # below which a turn determines little of an eccentricity
MAX_INTEGER_SIGMAS = 3.0  # within which an order is a whole number
MAX_TURNS = 4  # that a sentence names
MAX_RATES = 3  # of the table that a sentence lists
MIN_CLOCK_SHARE = 1e-6  # of a frequency: no clock of a log is known to less

NO_TURN = _("no whole turn at a steady rate was recorded")
NO_TURN_IN_TIME = _(
    "no whole turn at a steady rate was recorded; an oscillation of the readings themselves is "
    "sought in the recording, and would stand in “What is wrong, and what was done”"
)
NO_ANGLE = _("of no whole turn at a steady rate both rate and acceleration are stated")
SPLIT = _("record the same turns at twice the rate")
SINGLE_TURN = _(
    "Noise at so low a frequency is estimated from the differences between turns; "
    "there is one turn only."
)

VIBRATION = _(
    "The case oscillates about {axis} while the table turns: {frequency} Hz by the clock of the "
    "logs, or an alias of it at {rate} Hz sampling; {amplitude} °/s ({arc:.1f}″ at this "
    "frequency), in {manoeuvres}."
)
AT_REST = _(
    " It goes on while the table rests: the site vibrates, or a disturbance acts within the sensor."
)
IN_ANGLE = _(" It is periodic in the table's angle: {order} per revolution.")
RIPPLE = _("The table's rate has a ripple {order} per revolution, of {size} of its angle, {turns}.")
ECCENTRIC = _("The angle of the table has an error once per revolution, of {size}, {turns}.")
SAME_IN_TURNS = _("the same in {count} turns against the table's angle")
OWN_IN_TURNS = _("rms, of its own amplitude or phase in each of {count} turns")
IN_ONE_TURN = _("in one turn")
AT_RATES = _(" That is {each}.")
AT_RATE = _("{frequency} Hz and {amplitude} °/s at {rate} °/s")

UNDECIDED = _(
    " The data do not distinguish whether it is periodic in time or in the table's "
    "angle: the first is {odds} times as likely."
)
AS_LIKELY = _(
    " The data do not distinguish whether it is periodic in time or in the table's "
    "angle: both are about as likely."
)
NOT_IN_TIME = _(
    " As an oscillation in time, of one frequency in all turns, it would be less likely by a "
    "factor of {odds}."
)
NOT_IN_ANGLE = _(
    " As a ripple of the table's angle (order {orders}) it would be about the table's axis; that "
    "is less likely by a factor of {odds}."
)
STEP = _(
    "The table's angle jumps by {size}° at {at}° of its angle since the start of each turn "
    "(right-hand rule), within about {width}°, and runs back evenly over the rest of it, {turns}. "
    "This one step has ripples of the rate of all whole orders; {orders} per revolution were "
    "found, and it explains more than these."
)
STEP_MEANING = _("by how much the angle of the table jumps in each turn")
IN_STEP = _(
    "{effect}: not told from the step of the table's angle that is named, for its lines of further "
    "orders remain in the turns."
)
MULTIPLES = _(" Lines at {each} have the same cause.")
VERY_LARGE_ODDS = _("more than 10¹⁷")

COUPLED_UNKNOWN = _(" Through the cross-axis terms it also appears in the other gyros.")
COUPLED = _(" Through the cross-axis terms it also appears in the other gyros: {each}{more}.")
COUPLED_HIDDEN = _("{axis}, {expected} °/s expected, less than its noise shows")
COUPLED_READ = _("{axis}, {expected} °/s expected, {read} °/s measured{more}")
COUPLED_MORE = _(
    " (with its phase they differ by {excess} °/s; {tipping} °/s is expected as the case tilts in "
    "the table's rate)"
)
COUPLED_MORE_EACH = _(
    " (with its phase each differs by {excess} °/s; {tipping} °/s is expected as the case tilts in "
    "the table's rate)"
)

CONSEQUENCE = _("{turn} Angles over part of a turn are in error by up to {swing}″.")
CLOSED = _(
    "A whole turn is free of it, so that bias, scale factors and cross-axis terms are hardly "
    "affected."
)
NOT_CLOSED = _(
    "As its order is no whole number it does not close over a turn, but blocks of "
    "turns take their angle from the gyros, so that bias, scale factors and cross-axis terms are "
    "hardly affected."
)
CLOSED_IN_TIME = _(
    "Over a whole turn its angle nearly averages out, so that bias, scale factors and cross-axis "
    "terms are hardly affected."
)
ACTION_UNDECIDED = _("To distinguish them, {split}: if periodic in angle its frequency doubles.")
ACTION_ANGLE = _("Turn by whole turns; look at the table's gear, motor, bearing and encoder.")
ACTION_TIME = _(
    "Turn by whole turns; look for what vibrates: the drive, a loose screw, the mounting."
)
ACTION_AT_REST = _(
    "Turn by whole turns; look for what vibrates near the table at rest too, and for mains or a "
    "pump that couples into the sensor."
)

NOT_SEARCHED = _("{effect}: not searched for after {count} named oscillations.")
NOT_OBSERVABLE = _("{effect}: not observable in this campaign: {reason}.")
NOT_SIGNIFICANT = _("{effect}: not significant against the noise of the turns.")
NO_FURTHER = _("{effect}: none besides the named ones.")
MAY_BE = _("What is named {named} may be {effect}.")
WOULD_BE = _("It would be {detected}")

FROM_AMPLITUDE = _("detected from {size} °/s on in each turn.")
FROM_ANGLE = _("detected from {size}″ on.")
FROM_ANGLE_BY_ORDER = _(
    "detected from {size}″ on; from {largest}″ where it has {lowest} periods per "
    "revolution, from {smallest}″ where it has {highest}."
)
SHORT_TURN = _(
    "The steady part of a turn holds {share:.2f} of its periods: bias and slope "
    "absorb most of it, and noise at so low a frequency is estimated from the "
    "differences between turns."
)


def of_oscillation(oscillation: Oscillation, turns: Sequence[SteadyTurn]) -> str:
    """An oscillation in time, or of an axis of the case against the table's angle."""
    mean, axis = oscillation.mean, oscillation.likeliest.axis
    sentence = VIBRATION.format(
        axis=_("the table's axis") if axis == TABLE else axis,
        frequency=_frequency(mean.frequency, mean.frequency_sigma),
        rate=significant(_sampling_rate(turns, mean.manoeuvres), 3),
        amplitude=plus_minus(degrees(mean.amplitude), degrees(mean.amplitude_sigma)),
        arc=degrees(mean.amplitude / (2 * pi * mean.frequency)) * 3600,
        manoeuvres=_in_turns(mean.manoeuvres),
    )
    if oscillation.likeliest.bound_to == ANGLE and oscillation.ripple is not None:
        sentence += IN_ANGLE.format(order=_order(oscillation.ripple))
    if oscillation.at_rest:
        sentence += AT_REST
    return (
        sentence
        + _multiples(oscillation)
        + _coupling(oscillation.coupled)
        + _other_explanation(oscillation)
    )


def _frequency(value: float, sigma: float) -> str:
    """A frequency, Hz, by the clock of the logs, with no more digits than that is good for."""
    return plus_minus(value, max(sigma, MIN_CLOCK_SHARE * value))


def _sampling_rate(turns: Sequence[SteadyTurn], names: Sequence[str]) -> float:
    """The lowest of the turns that show it, Hz."""
    return 1 / max(turn.step for turn in turns if turn.name in names)


def _in_turns(names: Sequence[str]) -> str:
    return counted(len(names), "turn") if len(names) > MAX_TURNS else ", ".join(names)


def of_ripple(oscillation: Oscillation, ripple: Ripple, turns: Sequence[SteadyTurn]) -> str:
    """A ripple of the table, or its eccentricity."""
    if oscillation.step:
        return _of_step(oscillation, oscillation.step)
    in_turns = SAME_IN_TURNS if ripple.common else OWN_IN_TURNS
    sentence = (ECCENTRIC if eccentric(ripple) else RIPPLE).format(
        order=_order(ripple),
        size=plus_minus(ripple.amplitude / ARC_SECOND, ripple.amplitude_sigma / ARC_SECOND) + "″",
        turns=in_turns.format(count=ripple.turns) if ripple.turns > 1 else IN_ONE_TURN,
    )
    return (
        sentence
        + _at_rates(oscillation, ripple, turns)
        + _multiples(oscillation)
        + _other_explanation(oscillation)
    )


def _of_step(oscillation: Oscillation, step: StepPerTurn) -> str:
    """A step of the table's angle, of which its ripples are."""
    return STEP.format(
        size=plus_minus(degrees(step.size), degrees(step.sigma)),
        at=fixed(degrees(step.at), 0),
        width=significant(degrees(step.width), 2),
        turns=SAME_IN_TURNS.format(count=step.turns) if step.turns > 1 else IN_ONE_TURN,
        orders=listed([str(part.order) for part in oscillation.parts]),
    )


def eccentric(ripple: Ripple) -> bool:
    """Whether the order is fixed at 1."""
    return ripple.order_sigma == 0


def consequence(oscillation: Oscillation) -> str:
    """The effect on the model and on angles."""
    ripple = oscillation.ripple
    if oscillation.likeliest.bound_to == ANGLE and ripple is not None:
        swing = abs(oscillation.step.size) if oscillation.step else 2 * ripple.amplitude
        off = abs(ripple.order - round(ripple.order))
        turn = CLOSED if off < MAX_INTEGER_SIGMAS * ripple.order_sigma + 1e-9 else NOT_CLOSED
    else:
        swing = 2 * oscillation.mean.amplitude / (2 * pi * oscillation.mean.frequency)
        turn = CLOSED_IN_TIME
    return CONSEQUENCE.format(turn=turn, swing=significant(swing / ARC_SECOND, 2))


def action(oscillation: Oscillation) -> str:
    """What to do about it."""
    if len(oscillation.effects) > 1:
        return ACTION_UNDECIDED.format(split=SPLIT)
    if oscillation.likeliest.bound_to == ANGLE:
        return ACTION_ANGLE
    return ACTION_AT_REST if oscillation.at_rest else ACTION_TIME


def not_searched(effect: str, count: int) -> str:
    """The search ended with other oscillations."""
    return NOT_SEARCHED.format(effect=capital(in_words(effect)), count=count)


def in_step(effect: str) -> str:
    """The search ended with a step in each turn, which has lines of all whole orders."""
    return IN_STEP.format(effect=capital(in_words(effect)))


def not_observable(effect: str, reason: str) -> str:
    """No turn shows any size of it."""
    return NOT_OBSERVABLE.format(effect=capital(in_words(effect)), reason=reason)


def not_significant(effect: str, *, after_others: bool = False) -> str:
    """Searched for and not detected; `after_others`: after named oscillations were removed."""
    return (NO_FURTHER if after_others else NOT_SIGNIFICANT).format(
        effect=capital(in_words(effect))
    )


def may_be(named: str, effect: str) -> str:
    """The other member of a class."""
    return MAY_BE.format(named=in_words(named), effect=in_words(effect))


def would_be(detected: str) -> str:
    """The size from which it would have been detected."""
    return WOULD_BE.format(detected=detected)


def limit(effect: str, parameter: str, detected: str, why: str | None) -> str:
    """The size from which a parameter is detected, or `why` it is not."""
    value = detected if why is None else _("not detected. {why}", why=why)
    return _(
        "{effect}, {parameter}: {value}", effect=in_words(effect), parameter=parameter, value=value
    )


def from_amplitude(size: float) -> str:
    """A size in rad/s."""
    return FROM_AMPLITUDE.format(size=significant(degrees(size), 2))


def from_angle(size: float) -> str:
    """A size in rad."""
    return FROM_ANGLE.format(size=significant(size / ARC_SECOND, 2))


def from_angle_by_order(sizes: tuple[float, float, float], orders: Array) -> str:
    """A usual size, that of the lowest order and that of the highest, in rad."""
    size, largest, smallest = (significant(each / ARC_SECOND, 2) for each in sizes)
    lowest, highest = (significant(order, 3) for order in orders[[0, -1]])
    return FROM_ANGLE_BY_ORDER.format(
        size=size, largest=largest, smallest=smallest, lowest=lowest, highest=highest
    )


def of_short_turn(share: float) -> str | None:
    """What a turn shows of an eccentricity whose steady part holds few periods of it."""
    return SHORT_TURN.format(share=share) if share < MIN_PERIODS_IN_TURN else None


def _order(ripple: Ripple) -> str:
    order, sigma = ripple.order, ripple.order_sigma
    text = plus_minus(order, sigma)
    if abs(order - round(order)) < MAX_INTEGER_SIGMAS * sigma < 0.5:
        return _("{round} times ({text})", round=round(order), text=text)
    return _("{text} times", text=text)


def _at_rates(oscillation: Oscillation, ripple: Ripple, turns: Sequence[SteadyTurn]) -> str:
    """The frequency and the rms amplitude in °/s that it has at each rate of the table."""
    rate_of = {t.name: round(degrees(abs(t.rate)), 2) for t in turns if np.isfinite(t.rate)}
    squares: dict[float, list[float]] = {}
    for line in oscillation.lines:
        own = squares.setdefault(rate_of[line.manoeuvre], [])
        own.append(line.line.amplitude**2)
    each = [
        AT_RATE.format(
            frequency=fixed(ripple.order * rate / 360, 3),
            amplitude=significant(degrees(np.sqrt(np.mean(squares[rate]))), 2),
            rate=significant(rate, 3),
        )
        for rate in sorted(squares)[:MAX_RATES]
    ]
    return AT_RATES.format(each=", ".join(each))


def _multiples(oscillation: Oscillation) -> str:
    """Further lines of the same cause."""
    numbers = [part.number(oscillation.effects[0]) for part in oscillation.multiples]
    in_time = oscillation.effects[0] == IN_TIME
    unit, written = (" Hz", _frequency) if in_time else (_(" per revolution"), plus_minus)
    each = [written(*number) + unit for number in numbers if number]
    return MULTIPLES.format(each=", ".join(each)) if each else ""


def _other_explanation(oscillation: Oscillation) -> str:
    """The other explanation, and its odds."""
    if len(oscillation.hypotheses) < 2:
        return ""
    odds = VERY_LARGE_ODDS
    if oscillation.log_odds <= MAX_LOG_ODDS:
        odds = significant(exp(oscillation.log_odds), 1)
    if len(oscillation.effects) > 1:
        alike = abs(oscillation.log_odds) < MAX_ALIKE_LOG_ODDS
        return AS_LIKELY if alike else UNDECIDED.format(odds=odds)
    if oscillation.effects[0] != IN_TIME:
        return NOT_IN_TIME.format(odds=odds)
    orders = significant(oscillation.hypotheses[1].value, 4)
    return NOT_IN_ANGLE.format(orders=orders, odds=odds)


def _coupling(coupled: Sequence[Coupled]) -> str:
    """The oscillation in the other axes by coupling."""
    if not coupled:
        return COUPLED_UNKNOWN
    alike = len(coupled) > 1 and len({_excess(axis) for axis in coupled}) == 1
    return COUPLED.format(
        each="; ".join(_coupled(axis, "" if alike else _more(axis)) for axis in coupled),
        more=_more(coupled[0], COUPLED_MORE_EACH) if alike else "",
    )


def _coupled(axis: Coupled, more: str) -> str:
    return (COUPLED_HIDDEN if _hidden(axis) else COUPLED_READ).format(
        axis=axis.axis,
        expected=significant(degrees(axis.expected), 2),
        read=significant(degrees(axis.read), 2),
        more=more,
    )


def _hidden(axis: Coupled) -> bool:
    """Whether its noise is too large for it to be read in this axis."""
    return axis.read < MIN_EXCESS_SIGMA * axis.residual_sigma


def _excess(axis: Coupled) -> tuple[str, str] | None:
    """What is left beyond coupling and what the case's tipping leads to, °/s; None: nothing."""
    if _hidden(axis) or not axis.exceeds:
        return None
    return significant(degrees(axis.residual), 2), significant(degrees(axis.tipping), 2)


def _more(axis: Coupled, template: str = COUPLED_MORE) -> str:
    """The same in words."""
    if (both := _excess(axis)) is None:
        return ""
    excess, tipping = both
    return template.format(excess=excess, tipping=tipping)

"""Sentences about oscillations, detected and not detected."""

from collections.abc import Sequence
from math import degrees, exp, pi

import numpy as np

from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.periodic_in_angle import Ripple
from inertial.text.numbers import decimals_of, fixed, significant, with_sigma
from inertial.text.units import ARC_SECOND
from stages.criticism.oscillation_fits import CLEAR, TABLE, Coupled
from stages.criticism.oscillation_search import ANGLE, Bound

NO_TURN = "no whole turn at a steady rate was recorded"
NO_ANGLE = "of no whole turn at a steady rate both rate and acceleration are stated"
MANY = 40.0  # logarithm of odds beyond which their number says nothing
SHORT = 1.5  # periods in a turn, below which little of them is seen
NEAR = 3.0  # sigmas within which an order is a whole number
SPLIT = "record the same turns at twice the rate"


def of_oscillation(one: Bound, turns: Sequence[SteadyTurn]) -> str:
    """An oscillation in time, or of an axis of the case against the table's angle."""
    heard = one.oscillating
    arc = degrees(heard.amplitude / (2 * pi * heard.frequency)) * 3600
    about = "the table's axis" if one.axis == TABLE else one.axis
    hertz = f"{_told(heard.frequency, heard.frequency_sigma)} Hz"
    size = f"{_told(heard.amplitude, heard.amplitude_sigma)} rad/s"
    told = (
        f"The case oscillates about {about} while the table turns: {hertz}, {size} ({arc:.1f}″), in"
        f" {', '.join(heard.manoeuvres)}."
    )
    if one.bound == ANGLE and one.ripple is not None:
        told += f" It is bound to the table's angle: {_order(one.ripple)} in a turn."
    told += _through(one.through) + _instead(one, turns)
    return f"{told} Over a whole turn it adds no angle."


def _told(value: float, sigma: float) -> str:
    return " ± ".join(with_sigma(value, sigma, decimals_of(sigma, 1)))


def of_ripple(one: Bound, ripple: Ripple, turns: Sequence[SteadyTurn]) -> str:
    """A ripple of the table, or its eccentricity."""
    size = _arc(ripple.amplitude, ripple.amplitude_sigma)
    count = int(np.isfinite(ripple.own).all(axis=1).sum())
    same = f"the same in {count} turns against the table's angle" if count > 1 else "in one turn"
    if eccentric(ripple):
        told = f"The angle of the table is off once per revolution, by {size}, {same}."
    else:
        told = (
            f"The table's rate ripples {_order(ripple)} in a turn, by {size} of its angle, {same}."
        )
    return told + _at_rates(ripple, turns) + _instead(one, turns)


def eccentric(ripple: Ripple) -> bool:
    """Whether it is of the order 1, which was not free then."""
    return ripple.order_sigma == 0


def of_short_turn(share: float) -> str:
    """What a turn can show of the order 1 whose steady part holds few periods of it."""
    if share >= SHORT:
        return ""
    return (
        f" The steady part of a turn holds {share:.2f} of its periods: bias and slope take most of"
        " it up, and noise so slow is told by how turns differ."
    )


def consequence(one: Bound) -> str:
    """What it does to the model and to angles, in words."""
    ripple = one.ripple
    if one.bound == ANGLE and ripple is not None:
        swing = 2 * ripple.amplitude
        whole = abs(ripple.order - round(ripple.order)) < NEAR * ripple.order_sigma + 1e-9
        turn = (
            "A whole turn is free of it, and so are"
            if whole
            else "Being of no whole order it does not close over a turn, but blocks of turns take"
            " their angle from the gyros; it does no harm to"
        )
    else:
        swing = 2 * one.oscillating.amplitude / (2 * pi * one.oscillating.frequency)
        turn = "Over whole turns it adds no angle, so it does no harm to"
    return (
        f"{turn} bias, scale factors and cross terms. Part of a turn is off by up to"
        f" {significant(swing / ARC_SECOND, 2)}″. What the quality of the logs calls an oscillation"
        " at this frequency is the same."
    )


def action(one: Bound) -> str:
    """What to do about it."""
    if not one.told:
        return f"To tell them apart, {SPLIT}: bound to the angle its frequency doubles."
    if one.bound == ANGLE:
        return "Turn by whole turns; look at the table's gear, motor, bearing and encoder."
    return "Turn by whole turns; look for what vibrates: the drive, a loose screw, the mounting."


def _order(ripple: Ripple) -> str:
    order, sigma = ripple.order, ripple.order_sigma
    text = " ± ".join(with_sigma(order, sigma, decimals_of(sigma, 1)))
    if abs(order - round(order)) < NEAR * sigma < 0.5:
        return f"{round(order)} times ({text})"
    return f"{text} times"


def _arc(size: float, sigma: float) -> str:
    value, scatter = size / ARC_SECOND, sigma / ARC_SECOND
    return " ± ".join(with_sigma(value, scatter, decimals_of(scatter, 1))) + "″"


def _at_rates(ripple: Ripple, turns: Sequence[SteadyTurn]) -> str:
    """The frequency and the rate that it has at each rate of the table."""
    rates = sorted({round(degrees(abs(t.rate)), 2) for t in turns if np.isfinite(t.rate)})
    said = [
        f"{fixed(ripple.order * rate / 360, 3)} Hz and"
        f" {significant(ripple.order * ripple.amplitude * rate * pi / 180, 2)} rad/s at"
        f" {significant(rate, 3)} °/s"
        for rate in rates[:3]
    ]
    return f" That is {', '.join(said)}."


def _instead(one: Bound, turns: Sequence[SteadyTurn]) -> str:
    """What the other explanation would be, and what speaks against it."""
    if one.ripple is None:
        return ""
    if not one.told:
        return (
            " Whether it is bound to time or to the table's angle the data cannot tell: what is"
            f" named first is {_odds(one.log_odds)} as likely."
        )
    if one.bound == ANGLE:
        return (
            " Against time, with a phase of its own in each turn, it would be"
            f" {_odds(one.log_odds)} less likely."
        )
    rates = sorted({round(turn.hertz(1.0), 6) for turn in turns if np.isfinite(turn.rate)})
    orders = " or ".join(significant(one.oscillating.frequency / rate, 4) for rate in rates[:3])
    return (
        f" It is bound to time: as a ripple of order {orders} of the table's angle it would be"
        f" {_odds(one.log_odds)} less likely."
    )


def _odds(log_odds: float) -> str:
    if log_odds > MANY:
        return "more than 10¹⁷ times"
    return f"{significant(exp(log_odds), 1)} times"


def _through(through: Sequence[Coupled]) -> str:
    """What the other axes see."""
    if not through:
        return " The other axes see it through their cross terms."
    told = f" Through their cross terms {' and '.join(_seen(one) for one in through)}."
    for one in through:
        if one.more:
            told += (
                f" In {one.axis} {significant(one.left, 2)} rad/s is more than coupling; the case"
                f" tips into the table's rate, which brings {significant(one.tipping, 2)}."
            )
    return told


def _seen(one: Coupled) -> str:
    expected = significant(one.expected, 2)
    if one.read < CLEAR * one.left_sigma:
        return f"{one.axis} sees {expected} rad/s, less than its noise shows"
    return f"{one.axis} sees {expected} rad/s and reads {significant(one.read, 2)}"

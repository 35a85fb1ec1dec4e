"""Sentences about effects that are selected from block means: each a template with named values."""

from collections.abc import Sequence

import numpy as np

from inertial.campaign.effect_sentences import Estimated, effect_sentence
from inertial.effects.bias_jump import BiasJump
from inertial.effects.latitude_sign import LatitudeSign
from inertial.effects.law import Law
from inertial.effects.temperature_model import TemperatureModel
from inertial.effects.warm_up import WarmUp
from inertial.model_selection.cause import Cause, EffectTest
from inertial.model_selection.detection_limits import (
    ABSORBED,
    NOT_EXCITED,
    ONLY_TOGETHER,
    VISIBLE,
    Visible,
)
from inertial.physics.drift import Drift, OfTemperature, SettingIn
from inertial.physics.effect import Effect
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import fixed, p_is, plus_minus, significant
from inertial.text.parameters import sign_of
from inertial.text.typography import capital
from inertial.text.units import quantity
from stages.criticism.class_splitting import TURNED_OVER, Splitting
from stages.criticism.laws import law_sentence

SETTLED = 5.0  # time constants, after which e⁻⁵ of a warm-up is left
MIN_SEPARATION = 0.1  # sigma; below, which manoeuvre is the best says nothing

REASONS = {
    NOT_EXCITED: _("none of the readings that the estimates use changes by it"),
    ABSORBED: _("it cannot be separated here from the parameters that are always estimated"),
    ONLY_TOGETHER: _("only combinations of its parameters are determined, none by itself"),
}

ACTION = _(
    "Remove it at its origin, or compensate readings with its terms too, which the export "
    "holds where the result includes them."
)
ACTION_OF_SENSOR = _(
    "It is a property of the sensor, and stays: compensate readings with its terms too, which the "
    "export holds where the result includes them."
)
ACTION_OF_WARM_UP = _(
    "Switch the IMU on and wait until it has settled before recording: after {minutes} min, five "
    "time constants, less than 1 % of it is left. Or compensate readings with its terms too, which "
    "the export holds where the result includes them."
)
ACTION_OF_TEMPERATURE = _(
    "Record at the temperature at which the IMU is used, or keep it constant; or compensate "
    "readings with its terms too, which the export holds where the result includes them."
)
ACTION_OF_LATITUDE_SIGN = _(
    "Check the sign of latitude_deg, which is positive in the north. If that is right, see whether "
    "each `up` was read off accelerometers that read −g on the axis that points up, and whether "
    "the axes are right-handed."
)
ACTION_OF_GRAVITY_SIGN = _(
    "By hand nothing tells these two apart. If the accelerometers read −g on the axis that points "
    "up, as those of iPhones do, which is the likelier, state accelerometer: {reads: gravity} in "
    "the format; else correct the sign of latitude_deg, which is positive in the north."
)
ACTION_WITHOUT_TERMS = _("Remove it at its origin. Readings are not compensated for it: {stays}.")
ACTION_PER_RUN = _(
    "If the IMU was switched off in between, state power_cycle: true in the first manoeuvre after "
    "it: then each run has biases of its own, and the report says how well they repeat."
)
ACTION_PER_FREE_RUN = _(
    "If the IMU was switched off in between, make a campaign of each run, with the same serial: "
    "then each has biases of its own, and the report says how well they repeat. power_cycle is for "
    "positions of known attitude."
)
ACTION_OF_FREE_CHANGE = _(
    "Find what changed there; if the IMU was switched off and on, make a campaign of what was "
    "recorded before it and one of what was recorded after it, with the same serial. Later "
    "readings have the value before it and what is added at it together, which the export holds "
    "where the result includes them."
)
NO_COMMON_TIME = _(
    " If it stayed on, a warm-up or a drift does the same, and without a time that the logs share "
    "nothing tells them apart: record all in one log, or with stamps that go on from log to log."
)
ACTION_OF_JUMP = _(
    "If the IMU was switched off and on at that time, state power_cycle: true in the first "
    "manoeuvre after it; else find what changed then. Later readings have the value before the "
    "jump and the jump together, which the export holds where the result includes them."
)
ACTION_OF_RESTARTS = _(
    "If the IMU was switched off and on at these gaps, state power_cycle: true in {manoeuvres}: "
    "then the report says how well the biases repeat. Else find what changed there. Later readings "
    "have the value before a gap and what is added at it together, which the export holds where "
    "the result includes them."
)
ACTION_OF_RESTART = _(
    "If the IMU was switched off and on at this gap, state power_cycle: true in {manoeuvres}: then "
    "the report says how well the biases repeat. Else find what changed there. Later readings have "
    "the value before the gap and what is added at it together, which the export holds where the "
    "result includes them."
)
ACTION_OF_LATITUDE = _(
    "By the gyros the table stands at {latitude}°: correct latitude_deg, from which the earth's "
    "rate and normal gravity follow{or_heading}."
)
ACTION_OF_HEADING = _(
    "By the gyros the table's zero mark is {angle}° further {sense} than stated, seen from above: "
    "state heading_deg by so much {larger}; or see whether each `mark` is right."
)
ACTION_WITHOUT_LAW = _(
    "Look at the residuals against time; record again with the IMU switched on long before."
)
CONSEQUENCE = _(
    "Without it bias, scale factors and cross terms absorb a part of it and do not "
    "hold in other motions."
)
CONSEQUENCE_WITHOUT_LAW = _(
    "The joint fit allows for a random walk, or a scatter of the manoeuvres, where there is one."
)

PER_LOG = {
    "gyro_bias_per_log": _(
        "The biases of the gyros differ from run to run, by up to {size}.{others}"
    ),
    "accel_bias_per_log": _(
        "The biases of the accelerometers differ from run to run, by up to {size}.{others}"
    ),
}
RESTARTS = {  # at one gap, at several
    "gyro": (
        _(
            "The biases of the gyros are others after a gap of the recording, at {times} s, by up "
            "to {size}: there the IMU was probably switched off and on.{others}"
        ),
        _(
            "The biases of the gyros are others after gaps of the recording, at {times} s, by up "
            "to {size}: there the IMU was probably switched off and on.{others}"
        ),
    ),
    "accel": (
        _(
            "The biases of the accelerometers are others after a gap of the recording, at {times} "
            "s, by up to {size}: there the IMU was probably switched off and on.{others}"
        ),
        _(
            "The biases of the accelerometers are others after gaps of the recording, at {times} "
            "s, by up to {size}: there the IMU was probably switched off and on.{others}"
        ),
    ),
}
DRIFT = _("The biases drift in a way that no effect of the catalogue explains{nearest}.")

NOT_SIGNIFICANT = _("{effect}: not significant ({p_value}).")
NO_OWN_SIGNAL = _("{effect}: no signal of its own beside the named effects.")
NOT_OBSERVABLE = _("{effect}: not observable in this campaign, for {reason}.")
ABSORBED_BY = _("it is absorbed by {parameters}")

LIMIT = _("{parameter}: detected from {size} on.")
LIMIT_SCANNED = _(
    "{parameter}: detected from {size} on, from {smallest} to {largest} depending on {scanned}."
)
NO_LIMIT = _("{parameter}: not observable, for {reason}.")
SAME_RATE = _(
    "{now:.0f} % of it could as well be a scale factor that depends on the rate; "
    "{manoeuvre}, and it is {then:.0f} %."
)

SPLIT = _(" To distinguish them, {manoeuvre}: expected separation {sigmas} sigma.")
SPLIT_PAIR = _(
    " To distinguish {first} from {second}, {manoeuvre}: expected separation {sigmas} sigma."
)
SPLIT_NONE = _(" No further manoeuvre would distinguish them.")
SPLIT_TOO_WEAK = _(
    " No further manoeuvre would distinguish them: the best of those that were tried, {manoeuvre}, "
    "would by {sigmas} sigma."
)


def per_log_sentence(cause: Cause, difference: float, sigma: float, si: str) -> str:
    """Of biases that differ from run to run; `difference`: the largest, in its SI unit `si`."""
    return PER_LOG[cause.effect].format(
        size=_difference(difference, sigma, si), others=_or_others(cause)
    )


def restarts_sentence(
    cause: Cause, sensor: str, times: Sequence[float], difference: float, sigma: float, si: str
) -> str:
    """Of biases that differ after gaps at some times, s; `difference`: as in `per_log_sentence`."""
    return RESTARTS[sensor][len(times) > 1].format(
        times=listed([fixed(time, 1) for time in times]),
        size=_difference(difference, sigma, si),
        others=_or_others(cause),
    )


def _difference(difference: float, sigma: float, si: str) -> str:
    unit = quantity("bias", si).laboratory
    return f"{plus_minus(unit.of(difference), unit.of(sigma))} {unit.name}"


def _or_others(cause: Cause) -> str:
    others = _others(cause)
    return _(" Or it is {others}.", others=_(" or ").join(others)) if others else ""


def cause_sentence(
    cause: Cause, effect: Effect | None, parameters: Sequence[Estimated], positions: Sequence[str]
) -> str:
    """A detected cause or its class, with numbers; `effect` None: a drift that follows no law.

    `positions`: those that it may be at, if it is an effect of a single position.
    """
    others = _others(cause)
    if effect is None:
        return DRIFT.format(
            nearest=_("; nearest is {others}", others=", ".join(others)) if others else ""
        )
    if isinstance(effect, Law):
        return law_sentence(cause, effect, parameters)
    return effect_sentence(
        cause.effect, effect.cause, parameters, cause.verdict, cause.members, positions
    )


def _others(cause: Cause) -> list[str]:
    """The other members of its class, in words."""
    return [in_words(member) for member in cause.members if member != cause.effect]


def not_named_sentence(effect: Effect, test: EffectTest, reason: str, blind: str) -> str:
    """Why an effect is not named; `reason`: that of the limit of its first parameter."""
    title = capital(in_words(effect.name))
    if test.degrees:
        return NOT_SIGNIFICANT.format(effect=title, p_value=p_is(test.after_search))
    if reason == VISIBLE:
        return NO_OWN_SIGNAL.format(effect=title)
    return NOT_OBSERVABLE.format(effect=title, reason=_reason(effect, reason, blind))


def explanation(effect: Effect, reason: str, blind: str) -> str | None:
    """Why a parameter is not observable; None where it is."""
    return None if reason == VISIBLE else _reason(effect, reason, blind)


def limit_sentence(effect: Effect, limit: Visible, why: str | None) -> str:
    """From which size on a parameter is detected, or `why` it is not observable."""
    parameter = effect.parameters[limit.parameter]
    title = f"{in_words(effect.name)}, {sign_of(parameter.name)}"
    if why is not None:
        return NO_LIMIT.format(parameter=title, reason=why)
    unit = quantity(parameter.name, parameter.unit).laboratory
    values = {"parameter": title, "size": f"{significant(unit.of(limit.size), 2)} {unit.name}"}
    if limit.best >= limit.worst:
        return LIMIT.format_map(values)
    values |= {"smallest": significant(unit.of(limit.best), 2)}
    values |= {"largest": significant(unit.of(limit.worst), 2)}
    values["scanned"] = _("the scanned value") if effect.scan is None else effect.scan.meaning
    return LIMIT_SCANNED.format_map(values)


def action_against(effect: Effect | None, *, timed: bool = True, free: bool = False) -> str:
    """What to do against an effect; None: biases of each run, of logs that are `timed` alike.

    `free`: of positions of unknown attitude, which have one bias in all runs.
    """
    if effect is None:
        action = ACTION_PER_FREE_RUN if free else ACTION_PER_RUN
        return action if timed else action + NO_COMMON_TIME
    if isinstance(effect, BiasJump):
        return ACTION_OF_FREE_CHANGE if free else ACTION_OF_JUMP
    if isinstance(effect, LatitudeSign):
        return ACTION_OF_GRAVITY_SIGN if free else ACTION_OF_LATITUDE_SIGN
    if isinstance(effect, WarmUp) and effect.at:
        return ACTION_OF_WARM_UP.format(minutes=significant(SETTLED * effect.at / 60, 2))
    if effect.terms and isinstance(effect, (OfTemperature, TemperatureModel)):
        return ACTION_OF_TEMPERATURE
    if effect.terms:
        return ACTION if isinstance(effect, (Drift, SettingIn)) else ACTION_OF_SENSOR
    return ACTION_WITHOUT_TERMS.format(stays=effect.stays)


def action_against_restarts(manoeuvres: Sequence[str]) -> str:
    """What to do where biases change at gaps; `manoeuvres`: the first after each."""
    action = ACTION_OF_RESTART if len(manoeuvres) == 1 else ACTION_OF_RESTARTS
    return action.format(manoeuvres=listed(manoeuvres))


def action_against_heading(error: float) -> str:
    """What to do where the gyros show another azimuth; `error`: true less stated, rad."""
    return ACTION_OF_HEADING.format(
        angle=significant(abs(float(np.degrees(error))), 3),
        sense=_("clockwise") if error > 0 else _("counter-clockwise"),
        larger=_("larger") if error > 0 else _("smaller"),
    )


def action_against_latitude(latitude: float, *, surveyed: bool) -> str:
    """What to do where the gyros show another latitude, rad; `surveyed`: a heading is stated."""
    return ACTION_OF_LATITUDE.format(
        latitude=fixed(float(np.degrees(latitude)), 2),
        or_heading=_("; or heading_deg, if that is uncertain") if surveyed else "",
    )


def split_sentence(split: Splitting | None) -> str:
    """The manoeuvre that would distinguish the members of a class."""
    if split is None:
        return ""
    if not split.distinguishes and split.separation < MIN_SEPARATION:
        return SPLIT_NONE
    first, second = (in_words(name) for name in split.pair)
    template = SPLIT if split.members == 2 else SPLIT_PAIR
    return (template if split.distinguishes else SPLIT_TOO_WEAK).format(
        first=first,
        second=second,
        manoeuvre=split.manoeuvre,
        sigmas=significant(split.separation, 2),
    )


def same_rate_sentence(now: float, then: float) -> str:
    """The gain from turns with the axis up and down at the same rate; shares of the signal."""
    return SAME_RATE.format(now=100 * now, then=100 * then, manoeuvre=TURNED_OVER)


def _reason(effect: Effect, reason: str, blind: str) -> str:
    if effect.absorbed_by and not blind:
        return ABSORBED_BY.format(parameters=effect.absorbed_by)
    why = blind.rstrip(".") or REASONS[reason]
    return why[:1].lower() + why[1:]

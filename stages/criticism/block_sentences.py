"""Sentences about effects that are selected from block means."""

from collections.abc import Mapping, Sequence
from typing import Any

from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, Asked, Cause
from inertial.model_selection.detection_limits import (
    ABSORBED,
    NOT_EXCITED,
    ONLY_TOGETHER,
    VISIBLE,
    Visible,
)
from inertial.physics.effect import Effect
from inertial.text.cause_names import in_words
from inertial.text.numbers import decimals_of, p_is, significant, with_sigma
from inertial.text.units import quantity
from stages.criticism.class_splitting import TURNED_OVER, Splitting

Row = Mapping[str, Any]

ACTION = "Take the extended model's parameters where they foretell unseen data."
CLEAR = 3.0  # sigmas from which a parameter is told
REASONS = {
    NOT_EXCITED: "no manoeuvre of this plan changes a reading by it",
    ABSORBED: "the parameters that are estimated anyway do the very same here",
    ONLY_TOGETHER: "only combinations of its parameters are seen, none by itself",
}


def of_cause(cause: Cause, effect: Effect | None, rows: Sequence[Row], place: str = "") -> str:
    """A cause in a sentence or two, with its numbers; or its class; none: a course without a law.

    `place`: the position that is meant, if it is one.
    """
    others = [in_words(member) for member in cause.members if member != cause.effect]
    if effect is None:
        near = f"; nearest is {', '.join(others)}" if others else ""
        return f"The data drift in a way that no effect of the catalogue explains{near}."
    at = f" at {place}" if place else ""
    numbers = "; ".join(_number(row) for row in _told(rows)) or "no parameter by itself"
    if cause.verdict == FOUND:
        return f"The data ask for {in_words(cause.effect)}{at}: {effect.cause}. {numbers}."
    if cause.verdict == ONE_OF_CLASS:
        return (
            f"The data ask for {in_words(cause.effect)}{at} ({effect.cause}), or for"
            f" {' or '.join(others)}: this campaign cannot tell them apart. As"
            f" {in_words(cause.effect)}: {numbers}."
        )
    like = " or ".join([f"{in_words(cause.effect)}{at}", *others])
    return (
        f"The data are consistent with {like}, and no more is said, for what is left of them or a"
        f" random walk has no law. As {in_words(cause.effect)}: {numbers}."
    )


def of_silence(effect: Effect, asked: Asked, reason: str, blind: str) -> str:
    """Why an effect is not named; `reason`: that of its first parameter in `visible`."""
    title = in_words(effect.name)
    if asked.degrees:
        return f"No {title} is needed ({p_is(asked.after_search)})."
    if reason == VISIBLE:
        return f"Nothing is left that {title} could explain beside what is named."
    return f"This campaign cannot show {title}: {_why_not(effect, reason, blind)}."


def _why_not(effect: Effect, reason: str, blind: str) -> str:
    if effect.absorbed_by and not blind:
        return f"it is taken for {effect.absorbed_by}"
    why = blind.rstrip(".") or REASONS[reason]
    return why[:1].lower() + why[1:]


def of_blindness(effect: Effect, one: Visible, blind: str) -> str:
    """What of a parameter could have been seen, or why nothing."""
    parameter = effect.parameters[one.parameter]
    title = f"{in_words(effect.name)}, {parameter.name}"
    if one.reason in REASONS:
        return f"{title}: not seen, for {_why_not(effect, one.reason, blind)}."
    unit = quantity(parameter.name, parameter.unit).laboratory
    size = f"{significant(unit.of(one.size), 2)} {unit.name}"
    if one.best < one.worst:
        span = [significant(unit.of(x), 2) for x in (one.best, one.worst)]
        return f"{title}: seen from {size} on, from {span[0]} to {span[1]} by {_scanned(effect)}."
    return f"{title}: seen from {size} on."


def of_split(split: Splitting | None) -> str:
    """What would tell the members of a class apart."""
    if split is None:
        return ""
    clear = f"{significant(split.separation, 2)} sigma"
    if split.tells:
        return f" To tell them apart, {split.manoeuvre}: that would do it by {clear}."
    return f" Not even this would tell them apart: {split.manoeuvre} ({clear})."


def of_same_rate(now: float, then: float) -> str:
    """What turns at the same rate with the axis down would bring."""
    return (
        f" {100 * now:.0f} % of it could as well be a scale factor that goes with the rate;"
        f" {TURNED_OVER}, and it is {100 * then:.0f} %."
    )


def _scanned(effect: Effect) -> str:
    return "what is scanned" if effect.scan is None else effect.scan.meaning


def _told(rows: Sequence[Row]) -> list[Row]:
    clear = [r for r in rows if r["sigma"] and abs(r["value"]) > CLEAR * r["sigma"]]
    return clear or [r for r in rows if r["sigma"]]


def _number(row: Row) -> str:
    unit = quantity(row["parameter"], row["unit"]).laboratory
    sigma = unit.of(row["sigma"])
    value = " ± ".join(with_sigma(unit.of(row["value"]), sigma, decimals_of(sigma)))
    return f"{row['parameter']} = {value} {unit.name}"

"""A detected effect in a sentence: its physical cause, and how large its parameters are."""

from collections.abc import Sequence
from dataclasses import dataclass

from inertial.model_selection.cause import FOUND, ONE_OF_CLASS
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.numbers import plus_minus
from inertial.text.parameters import sign_of
from inertial.text.units import DEGREE, DEGREES, SECONDS_OF_ARC, quantity

MIN_SIGMAS = 3.0  # from which a parameter is given in a sentence, if any reaches it

DETECTED = _("Detected: {effect}{place}: {cause}. {numbers}.")
DETECTED_CLASS = _(
    "Detected: {effect}{place} ({cause}), or {others}: this campaign cannot "
    "distinguish them. As {effect}: {numbers}."
)
CONSISTENT = _(
    "The data are consistent with {effects}; no more can be said, for the remaining "
    "residuals, a random walk or further jumps follow no law. As {effect}: {numbers}."
)
NO_NUMBER = _("no parameter by itself")
NONE_ALONE = _("{numbers} (significant together, none of them by itself)")


@dataclass(frozen=True)
class Estimated:
    """A parameter of an effect: value and sigma in the SI `unit`, where they are known.

    `least_squares`: the value before the correction for having been selected.
    """

    name: str
    unit: str
    meaning: str
    value: float | None = None
    sigma: float | None = None
    detection_limit: float | None = None
    least_squares: float | None = None


def effect_sentence(
    effect: str,
    cause: str,
    parameters: Sequence[Estimated],
    verdict: str,
    members: Sequence[str],
    positions: Sequence[str],
) -> str:
    """An effect or its class, with numbers.

    Parameters
    ----------
    effect, members : names of the catalogue; cause : why it is, in words
    verdict : how sure its name is
    positions : those that it may be at, if it is an effect of a single position
    """
    title = in_words(effect)
    others = [in_words(member) for member in members if member != effect]
    values = {
        "effect": title,
        "place": _(" at {positions}", positions=_(" or ").join(positions)) if positions else "",
        "cause": cause,
        "others": _(" or ").join(others),
        "numbers": _numbers(parameters),
    }
    if verdict == FOUND:
        return DETECTED.format_map(values)
    if verdict == ONE_OF_CLASS:
        return DETECTED_CLASS.format_map(values)
    values["effects"] = _(" or ").join([title + values["place"], *others])
    return CONSISTENT.format_map(values)


def _numbers(parameters: Sequence[Estimated]) -> str:
    """The sizes that are clear, or all, and the times: without one a size says nothing.

    An effect is tested with all its parameters at once, so it may be significant where none is. Of
    one that shows by a combination of parameters alone, those that are determined say nothing.
    """
    known = [p for p in parameters if p.value is not None and p.sigma]
    sizes, times = [p for p in known if p.unit != "s"], [p for p in known if p.unit == "s"]
    clear = [p for p in sizes if abs(p.value or 0.0) > MIN_SIGMAS * (p.sigma or 0.0)]
    if not clear and len(sizes) < sum(p.unit != "s" for p in parameters):
        sizes = []
    numbers = "; ".join(map(_number, (clear or sizes) + times)) or NO_NUMBER
    together = not clear and len(sizes) > 1
    return NONE_ALONE.format(numbers=numbers) if together else numbers


def _number(parameter: Estimated) -> str:
    size, sigma = parameter.value or 0.0, parameter.sigma or 0.0
    unit = quantity(parameter.name, parameter.unit).laboratory
    unit = DEGREES if unit == SECONDS_OF_ARC and abs(size) > DEGREE else unit
    value = plus_minus(size / unit.size, sigma / unit.size)
    return f"{sign_of(parameter.name)} = {value} {unit.name}"

"""Sentences about laws that no effect of the catalogue has."""

from collections.abc import Sequence

import numpy as np

from inertial.campaign.effect_sentences import Estimated
from inertial.effects.law import ALL, Law
from inertial.model_selection.cause import ONE_OF_CLASS, Cause
from inertial.physics.laws import UNITS
from inertial.sensors import PLURAL
from inertial.text.cause_names import STATES, in_words
from inertial.text.messages import _
from inertial.text.numbers import plus_minus, significant
from inertial.text.units import DEGREE, HOUR, quantity

LAW = _("{subject}: {form}, {numbers}; no effect of the catalogue does this.")
LAW_OR_WALK = _(
    "{subject}: {form}, {numbers}; no effect of the catalogue does this. It may also be {walk}: "
    "this campaign cannot distinguish them."
)
ONE = {"gyro": _("{axis} gyro"), "accel": _("{axis} accelerometer")}
ACTION = _(
    "Look for its physical cause: {file} proposes it as an effect, in the form of the catalogue. "
    "Readings are not compensated by it."
)
POWERS = {2: _("quadratic in {state}"), 3: _("cubic in {state}"), 4: _("quartic in {state}")}
FORMS = {
    "polynomial": _("a polynomial of degree {degree} in {state}"),
    "power": _("{state} to the power {first}, alike for both signs"),
    "odd_power": _("{state} to the power {first}, with its sign"),
    "harmonic": _("a sine of {state} with a period of {period}"),
    "exponential": _("an exponential of {state}, by e in {first} {unit}"),
    "ramp": _("a ramp from {times} s on"),
    "telegraph": _("two levels, changed at {times} s"),
    "pulse": _("another level from {first_time} s to {last_time} s"),
    "hysteresis": _("hysteresis of {state}, {first} {unit} wide to either side"),
    "product": _("in proportion to {state}"),
}
MIN_SIGMAS = 3.0  # of a size that is written


def law_sentence(cause: Cause, law: Law, parameters: Sequence[Estimated]) -> str:
    """The law with its numbers."""
    subject = PLURAL[law.sensor] if law.axis == ALL else ONE[law.sensor].format(axis=law.axis)
    values = {
        "subject": subject,
        "form": form_of(law),
        "numbers": "; ".join(_numbers(law, parameters)),
    }
    if cause.verdict == ONE_OF_CLASS:
        return LAW_OR_WALK.format(walk=in_words(cause.members[-1]), **values)
    return LAW.format_map(values)


def law_action(name: str, mount: str) -> str:
    """What to do about a law."""
    return ACTION.format(file=f"extension/proposed/{name}{f'-{mount}' if mount else ''}.py")


def form_of(law: Law) -> str:
    """The form of a law in words."""
    state = _(" times ").join(STATES[one] for one in law.state.split("*"))
    first = law.shape[0] if law.shape else 0.0
    if law.family == "power" and law.state.endswith("time"):
        if first in POWERS:
            return POWERS[int(first)].format(state=state)
        return _("{state} to the power {first}", state=state, first=significant(first, 3))
    period = 2 * np.pi / first if law.family == "harmonic" else 0.0
    of_time = f"{significant(HOUR * period, 3)} s"
    times = [f"{HOUR * time:.0f}" for time in law.shape]
    if law.family == "telegraph" and len(times) == 2:
        return FORMS["pulse"].format(first_time=times[0], last_time=times[1])
    return FORMS[law.family].format(
        state=state,
        first=significant(first, 3),
        degree=f"{first:.0f}",
        unit=UNITS.get(law.state, "g"),
        period=of_time if law.state == "time" else f"{significant(period / DEGREE, 4)}°",
        times=", ".join(times),
    )


def _numbers(law: Law, parameters: Sequence[Estimated]) -> list[str]:
    """The sizes that are clear, or the first."""
    sizes = [one for one in parameters if one.sigma and one.value is not None]
    clear = [one for one in sizes if abs(one.value or 0.0) > MIN_SIGMAS * (one.sigma or 0.0)]
    written = []
    for one in clear or sizes[:1]:
        unit = quantity(one.name, one.unit).laboratory
        size = plus_minus(unit.of(one.value or 0.0), unit.of(one.sigma or 0.0))
        label = "" if len(sizes) == 1 else f"{one.name} = "
        written.append(f"{label}{size} {unit.name}{_per(law)}")
    return written


def _per(law: Law) -> str:
    """The unit of a size beyond that of the reading."""
    if law.family == "power" and law.state == "time":
        power = law.shape[0]
        return f"/h{'' if power == 1 else '²³⁴⁵'[int(power) - 2]}" if power in (2, 3, 4, 5) else ""
    if law.family == "ramp":
        return "/h"
    if law.family == "hysteresis" and law.state != "temperature":  # whose size is per K
        unit = UNITS.get(law.state, "g")
        return f"/({unit})" if "/" in unit else f"/{unit}"
    return ""

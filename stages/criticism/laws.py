"""Laws in place of what is unexplained: their choice, their sentences, and what follows none."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.campaign.effect_sentences import Estimated
from inertial.campaign.equations import Campaign
from inertial.effects import TEMPERATURE_MODELS
from inertial.effects.law import ALL, TELEGRAPH, Law
from inertial.model_selection.cause import LAW, ONE_OF_CLASS, UNKNOWN_STRUCTURE, Cause
from inertial.physics.effect import Effect
from inertial.physics.laws import UNITS
from inertial.sensors import PLURAL, SENSORS
from inertial.text.cause_names import STATES, in_words
from inertial.text.messages import _
from inertial.text.numbers import plus_minus, significant
from inertial.text.units import DEGREE, HOUR, quantity
from stages.criticism.bias_drift import drift_name
from stages.criticism.effect_selection import select_with_scatter
from stages.criticism.finding_rows import finding_id
from stages.criticism.law_search import FoundLaw, find_law
from stages.criticism.residual_structure import CAUSE as STRUCTURE
from stages.criticism.residual_structure import Tested, carrying, structure_tests
from stages.criticism.selection import Selection, walk_name

# ---- Laws in place of what is unexplained, and the effects of the catalogue beside them.

OF_CLASS = ("members", "member_values", "weights", "captured", "p_value")  # fields of a cause


def with_laws(
    selection: Selection,
    tested: Tested,
    campaign: Campaign,
    effects: Sequence[Effect],
    level: float,
    structure_level: float,
    degrees: float,
) -> tuple[Selection, Tested]:
    """The selection with a law in each sensor that is unexplained and has one.

    A law counts where the residuals of the sensor have no structure beside it. `campaign`,
    `effects`, `level`: of the selection; `structure_level`: of the tests of structure.
    """
    for sensor in unexplained(selection, tested):
        found = find_law(selection, sensor, level)
        if found is None:
            continue
        before = [
            e for e in selection.effects if e.name in TEMPERATURE_MODELS or isinstance(e, Law)
        ]
        again = select_with_scatter(campaign, effects, level, degrees, [*before, found.law])
        checked = structure_tests(again.campaign, again.fitted, degrees, structure_level)
        if not checked.of(sensor):
            known = {c.effect: c for c in selection.named.causes if c.verdict == LAW}
            selection, tested = _named(again, found, known), checked
    return selection, tested


def unexplained(selection: Selection, tested: Tested) -> list[str]:
    """The sensors with a structure, a random walk, a drift without a law, or several effects.

    Several effects of the catalogue together may imitate one that is in none.
    """
    own = [selection.sensor(cause) for cause in selection.named.causes]
    drifts: Collection[str] = {cause.effect for cause in selection.named.causes}
    walks = zip(SENSORS, selection.random_walks, strict=True)
    return [
        sensor
        for sensor, walk in walks
        if walk or tested.of(sensor) or drift_name(sensor) in drifts or own.count(sensor) > 1
    ]


def _named(selection: Selection, found: FoundLaw, known: dict[str, Cause]) -> Selection:
    """The selection in which the law is named with its class; `known`: laws of other sensors."""

    def named(cause: Cause) -> Cause:
        if cause.effect in known:
            old = known[cause.effect]
            again = {name: getattr(old, name) for name in OF_CLASS}
            return replace(cause, verdict=LAW, **again)
        if cause.effect != found.law.name:
            return cause
        share = 1 / (1 + float(np.exp(found.odds))) if found.walk else 0.0
        walk = (found.walk,) if found.walk else ()
        return replace(
            cause,
            verdict=ONE_OF_CLASS if found.walk else LAW,
            members=(*found.members, *walk),
            member_values=(0,) * (len(found.members) + len(walk)),
            weights=(*(w * (1 - share) for w in found.weights), *([share] if walk else [])),
            captured=(*found.captured, *([1.0] if walk else [])),
            p_value=found.p_value,
        )

    causes = tuple(named(cause) for cause in selection.named.causes)
    return replace(selection, named=replace(selection.named, causes=causes))


# ---- Sentences about laws that no effect of the catalogue has.

LAW_IN_WORDS = _("{subject}: {form}, {numbers}; no effect of the catalogue does this.")
THERE_AND_BACK = _("{subject}: {form}, {numbers}; the bias jumps and goes back.")
FURTHER_JUMP = _("{subject}: {form}, {numbers}; it is a further jump, at a time of its own.")
LAW_OR_WALK = _(
    "{subject}: {form}, {numbers}; no effect of the catalogue does this. It may also be {walk}: "
    "this campaign cannot distinguish them."
)
NO_SIZES = _("of whose terms this campaign shows the sum alone")
ONE = {"gyro": _("{axis} gyro"), "accel": _("{axis} accelerometer")}
ACTION = _(
    "Look for its physical cause: {file} proposes it as an effect, in the form of the catalogue. "
    "Readings are not compensated by it."
)
DRIFT_ACTION = _(
    "Look for its physical cause: {file} proposes it as an effect, in the form of the catalogue. "
    "Readings are not compensated by it: the bias is the mean over the recording, and its sigma "
    "contains how far the law goes about that."
)
POWERS = {2: _("quadratic in {state}"), 3: _("cubic in {state}"), 4: _("quartic in {state}")}
FORMS = {
    "polynomial": _("a polynomial of degree {degree} in {state}"),
    "power": _("{state} to the power {first}, alike for both signs"),
    "odd_power": _("{state} to the power {first}, with its sign"),
    "harmonic": _("a sine of {state} with a period of {period}"),
    "exponential": _("an exponential of {state}, by e in {first} {unit}"),
    "ramp": _("a ramp from {times} s on"),
    TELEGRAPH: _("two levels, changed at {times} s"),
    "jump": _("another level from {first_time} s on"),
    "pulse": _("another level from {first_time} s to {last_time} s"),
    "hysteresis": _("hysteresis of {state}, {first} {unit} wide to either side"),
    "product": _("in proportion to {state}"),
    "product_of_drifts": _("in proportion to {state}, each counted from a value of its own"),
}
MIN_SIGMAS = 3.0  # of a size that is written
UNITS_OF_FACTORS = {**UNITS, "other_forces": "g²"}
EXPONENTS = {2.0: "²", 3.0: "³", 4.0: "⁴", 5.0: "⁵"}


def law_sentence(cause: Cause, law: Law, parameters: Sequence[Estimated]) -> str:
    """The law with its numbers."""
    subject = PLURAL[law.sensor] if law.axis == ALL else ONE[law.sensor].format(axis=law.axis)
    values = {
        "subject": subject,
        "form": form_of(law),
        "numbers": "; ".join(_numbers(law, parameters)) or NO_SIZES,
    }
    if cause.verdict == ONE_OF_CLASS:
        return LAW_OR_WALK.format(walk=in_words(cause.members[-1]), **values)
    changes = len(law.shape) if law.family == TELEGRAPH else 0
    return {1: FURTHER_JUMP, 2: THERE_AND_BACK}.get(changes, LAW_IN_WORDS).format_map(values)


def law_action(law: Law, mount: str) -> str:
    """What to do about a law."""
    action = DRIFT_ACTION if law.is_drift else ACTION
    return action.format(file=f"extension/proposed/{law.name}{f'-{mount}' if mount else ''}.py")


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
    if law.family == TELEGRAPH and len(times) <= 2:
        form = FORMS["pulse" if len(times) == 2 else "jump"]
        return form.format(first_time=times[0], last_time=times[-1])
    of_drifts = law.family == "product" and law.is_drift
    return FORMS["product_of_drifts" if of_drifts else law.family].format(
        state=state,
        first=significant(first, 3),
        degree=f"{first:.0f}",
        unit=UNITS.get(law.state, "g"),
        period=of_time if law.state == "time" else f"{significant(period / DEGREE, 4)}°",
        times=", ".join(times),
    )


def _numbers(law: Law, parameters: Sequence[Estimated]) -> list[str]:
    """The sizes that are clear, or the first; none where no term is told from the others."""
    sizes = [one for one in parameters if one.sigma and one.value is not None]
    clear = [one for one in sizes if abs(one.value or 0.0) > MIN_SIGMAS * (one.sigma or 0.0)]
    written = []
    for one in clear or sizes[:1]:
        unit = quantity(one.name, one.unit).laboratory
        size = plus_minus(unit.of(one.value or 0.0), unit.of(one.sigma or 0.0))
        label = "" if len(sizes) == 1 else f"{one.name} = "
        written.append(f"{label}{size} {unit.name}{_per(law, one.name)}")
    return written


def _per(law: Law, parameter: str) -> str:
    """The unit of a size beyond that of the reading."""
    if law.family in ("polynomial", "power", "odd_power"):
        power = float(parameter[1]) if law.family == "polynomial" else law.shape[0]
        unit = UNITS.get(law.state, "g")
        unit = f"({unit.removeprefix('× ')})" if " " in unit or "/" in unit else unit
        exponent = "" if power == 1 else EXPONENTS.get(power) or f"^{significant(power, 3)}"
        return f"/{unit}{exponent}"
    if law.family == "product":
        term = parameter[1:-2].removeprefix("_")  # none for the product itself
        units = [UNITS_OF_FACTORS.get(one, "g") for one in (term or law.state).split("*")]
        together = " ".join(f"({u.removeprefix('× ')})" if "/" in u else u for u in units)
        return f"/({together})" if " " in together else f"/{together}"
    if law.family == "ramp":
        return "/h"
    if law.family == "hysteresis" and law.state != "temperature":  # whose size is per K
        unit = UNITS.get(law.state, "g")
        return f"/({unit})" if "/" in unit else f"/{unit}"
    return ""


# ---- What follows no law is reported once for each sensor: by its random walk, structure, or
# drift.
#
# A bias that changes by no law shows in several ways: the estimate finds a random walk, the tests a
# structure of the residuals in time, and the search effects or half waves that resemble it a
# little. These are one finding, and what they resemble is what the data are consistent with. A
# structure that few manoeuvres carry is no random walk, which is in all of them.

OF_WALKS = ("time", "change")  # structures that a bias without a law has, whatever its course


@dataclass(frozen=True)
class WithoutLaw:
    """What each sensor has without a law.

    `owner`: by sensor the cause of the finding that reports all of it; `structured`: the p-value of
    the structure of its residuals, by sensor that has one; `members`: by sensor the
    effects with which the data are no more than consistent.
    """

    owner: Mapping[str, str]
    structured: Mapping[str, float]
    members: Mapping[str, tuple[str, ...]]

    @property
    def reported_structures(self) -> dict[str, tuple[str, ...]]:
        """The members of each structure that is a finding of its own, by sensor."""
        return {
            s: self.members[s] for s, cause in self.owner.items() if cause.startswith(STRUCTURE)
        }

    def finding(self, cause: Cause, sensor: str, mount: str) -> str:
        """The finding by which a cause is reported."""
        own = cause.verdict != UNKNOWN_STRUCTURE or sensor not in self.owner
        return finding_id(cause.effect if own else self.owner[sensor], mount)


def without_law(selection: Selection, walks: Collection[str], tested: Tested) -> WithoutLaw:
    """Of a selection; `walks`: the sensors that have a random walk."""
    owner: dict[str, str] = {}
    members: dict[str, tuple[str, ...]] = {}
    drifts = {cause.effect for cause in selection.named.causes}
    for number, sensor in enumerate(SENSORS):
        kinds = {test.kind for test in tested.of(sensor)}
        if sensor in walks and kinds <= set(OF_WALKS) and not carrying(tested, sensor):
            owner[sensor] = walk_name(number)
        elif kinds:
            owner[sensor] = f"{STRUCTURE}/{sensor}"
        elif drift_name(sensor) in drifts:
            owner[sensor] = drift_name(sensor)
        members[sensor] = tuple(dict.fromkeys(selection.consistent()[sensor]))
    structured = {
        sensor: min(test.p_value for test in tested.of(sensor))
        for sensor in SENSORS
        if tested.of(sensor)
    }
    return WithoutLaw(owner, structured, members)

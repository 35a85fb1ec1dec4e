"""Whether the extended result of a sensor replaces the joint one, and the final parameters.

It does where the model with the effects predicts the manoeuvres not used in its fit better
than that without, and no finding shows that the model is still incomplete.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from inertial.estimation.triad import linear_names
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.parameters import EXTENDED, JOINT
from stages.extension.cross_validation import MIN_SNR_SQUARED, CrossValidation
from stages.extension.estimates import Solved
from stages.extension.named_effects import Alarm, Named

Row = Mapping[str, Any]
TableRow = tuple[str, Row]  # the name of a table that the stage writes, and a row of it

SENSORS = {"gyro": "gyros", "accel": "accelerometers"}

NO_JOINT = _("There is no joint result of the {sensors}.")
UNEXPLAINED = _(
    "The joint result of the {sensors} is final, and its sigmas are doubtful: some "
    "findings are not explained ({causes})."
)
NO_EFFECT = _("The joint result of the {sensors} is final: they show no effect that was named.")
KEPT = _("The joint result of the {sensors} is final, though {effects} was named: {reason}.")
NOT_EXPLAINED = _("beside it some findings are not explained ({causes})")
NOT_VALIDATED = _(
    "it is not cross-validatable, for the manoeuvres that can be predicted from the "
    "others hold too little of it (SNR² {snr_squared:.1f}, less than {least:.0f})"
)
NO_BETTER = _(
    "manoeuvres that the fit has not seen are predicted no better with it (χ² grows "
    "by {growth:.1f})"
)
NOT_DETERMINED = _("beside it {parameters} would not be determined")
REPLACED = _(
    "The extended result of the {sensors} is final, with {effects}: χ² of "
    "manoeuvres that the fit has not seen is reduced by {drop:.1f}, of "
    "{expected:.1f} that exactly known effects would bring, and no finding remains "
    "unexplained."
)
AGAINST_WALK = _(
    " Against the joint fit, which describes some of it by a random walk of the "
    "biases, it is reduced by {drop:.1f}."
)
OTHER_MEMBERS = _(
    " Instead of {effect} it may be {others}: that would do the same to these data, "
    "within their noise."
)
NOT_COUNTED = _(
    " Not counted: {manoeuvres}; without {each} the others show less than half of the effect."
)


@dataclass(frozen=True)
class Candidate:
    """The results of one sensor, of which one becomes final.

    `joint`: rows of its joint result; `solution` and `validated`: of the extended one, if any.
    """

    sensor: str
    mount: str
    named: Named
    joint: Sequence[Row]
    solution: Solved | None = None
    validated: CrossValidation | None = None

    @property
    def effects(self) -> tuple[str, ...]:
        """The named effects that the extended model of this sensor has."""
        return tuple(dict.fromkeys(self.solution.effects)) if self.solution else ()

    @property
    def alarms(self) -> Sequence[Alarm]:
        """Findings about this sensor that no named effect explains."""
        return self.named.alarms.get(self.sensor, ())

    @property
    def reason(self) -> str:
        """Why the joint result stays final, in a sentence; empty where it does not."""
        sensors, causes = SENSORS[self.sensor], _listed([alarm.cause for alarm in self.alarms])
        if not any(row["value"] is not None for row in self.joint):
            return NO_JOINT.format(sensors=sensors)
        if self.alarms and not self.effects:
            return UNEXPLAINED.format(sensors=sensors, causes=causes)
        if self.solution is None or self.validated is None or not self.effects:
            return NO_EFFECT.format(sensors=sensors)
        reason = self._against(self.solution, self.validated, causes)
        if not reason:
            return ""
        return KEPT.format(sensors=sensors, effects=_listed(self.effects), reason=reason)

    def _against(self, solution: Solved, validated: CrossValidation, causes: str) -> str:
        if self.alarms:
            return NOT_EXPLAINED.format(causes=causes)
        if not validated.possible:
            size = max(validated.expected_drop, 0.0)
            return NOT_VALIDATED.format(snr_squared=size, least=MIN_SNR_SQUARED)
        if validated.drop <= validated.walk_drop:
            return NO_BETTER.format(growth=validated.walk_drop - validated.drop)
        extended = {row["parameter"] for row in solution.of_sensor if row["value"] is not None}
        before = [row["parameter"] for row in self.joint if row["value"] is not None]
        if lost := [name for name in before if name not in extended]:
            return NOT_DETERMINED.format(parameters=", ".join(lost))
        return ""

    @property
    def final(self) -> str:
        """Which result becomes final."""
        return JOINT if self.reason else EXTENDED

    def rows(self) -> Iterator[TableRow]:
        """The decision, with the effects of the extended model and the unexplained findings."""
        shared = {"mount": self.mount, "sensor": self.sensor}
        validated = self.validated
        yield (
            "decision",
            {
                **shared,
                "result": self.final,
                "drop": validated.drop - validated.walk_drop if validated else None,
                "snr_squared": validated.expected_drop if validated else None,
                "folds": len(validated.folds) if validated else None,
                "counted": len(validated.counted) if validated else None,
                "sentence": (self.reason or self._replaced())
                + self._classes()
                + self._not_counted(),
            },
        )
        for effect in self.effects:
            yield "decision_effects", {**shared, "effect": effect}
        for alarm in self.alarms:
            yield "alarms", {**shared, **alarm._asdict()}

    def final_rows(self) -> list[Row]:
        """The rows of the twelve final parameters."""
        if self.final == EXTENDED and self.solution is not None:
            return list(self.solution.of_sensor)
        own = {row["parameter"]: row for row in self.joint}
        return [own[name] for name in linear_names() if name in own]

    def _replaced(self) -> str:
        validated = self.validated
        assert validated is not None  # else the joint result stays
        sentence = REPLACED.format(
            sensors=SENSORS[self.sensor],
            effects=_listed(self.effects),
            drop=validated.drop,
            expected=validated.expected_drop,
        )
        if validated.walk_drop <= 0:
            return sentence
        return sentence + AGAINST_WALK.format(drop=validated.drop - validated.walk_drop)

    def _classes(self) -> str:
        return "".join(
            OTHER_MEMBERS.format(effect=in_words(effect), others=_listed(others, "or"))
            for effect in self.effects
            if (others := [n for n in self.named.classes.get(effect, ()) if n != effect])
        )

    def _not_counted(self) -> str:
        omitted = self.validated.not_counted if self.validated else ()
        if not omitted:
            return ""
        each = "it" if len(omitted) == 1 else "each"
        return NOT_COUNTED.format(manoeuvres=", ".join(omitted), each=each)


def _listed(causes: Sequence[str], last: str = "and") -> str:
    names = [in_words(cause) for cause in causes]
    if len(names) < 2:
        return "".join(names)
    return f"{', '.join(names[:-1])} {last} {names[-1]}"

"""The candidates for the result of one sensor: the joint fit, and models with effects."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from inertial.physics.effect import Effect
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.parameters import EXTENDED, JOINT
from stages.extension.cross_validation import CrossValidation, Trainings, carrier
from stages.extension.named_effects import Combination


@dataclass(frozen=True)
class Candidate:
    """A model of one sensor.

    `effects`: those of the model that the sensor shows or absorbs; `findings`: by the name of an
    effect; `columns`: of the effects that it shows, in its equations; `absorbed`: of those that its
    parameters absorb, whose size the other sensor tells; `probability`: of the members of classes,
    those of the joint fit being the members that this sensor does not show; `left_out`: the
    manoeuvre without which it is fitted.
    """

    method: str
    effects: tuple[Effect, ...] = ()
    findings: dict[str, str] = field(default_factory=dict)
    columns: tuple[str, ...] = ()
    absorbed: tuple[str, ...] = ()
    probability: float = 0.0
    left_out: str | None = None


def candidates_of(
    combinations: Sequence[Combination],
    shown: frozenset[str],
    absorbed: frozenset[str] = frozenset(),
) -> list[Candidate]:
    """The different models that the combinations make of one sensor, the joint fit first.

    A member that the sensor does not show leaves it without an effect, and so does one that no
    equation of the means can hold, such as a random walk; beside other effects that one is no
    candidate. `shown`: the columns of effects that the sensor shows; `absorbed`: that its
    parameters absorb.
    """
    models: dict[tuple[str, ...], Candidate] = {
        (): Candidate(JOINT, probability=0.0 if combinations else 1.0)
    }
    for number, combination in enumerate(combinations):
        own = shown | absorbed
        effects = tuple(e for e in combination.effects if own.intersection(e.columns))
        if effects and any(e.sought_in != "blocks" for e in combination.effects):
            continue
        key = tuple(sorted(effect.label for effect in effects))
        if key not in models:
            findings = {
                effect.name: finding
                for effect, finding in zip(combination.effects, combination.findings, strict=True)
                if effect in effects
            }
            every = [name for effect in effects for name in effect.columns]
            columns = tuple(name for name in every if name in shown)
            taken = tuple(name for name in every if name in absorbed)
            method = f"member_{number}" if number else EXTENDED
            models[key] = Candidate(method, effects, findings, columns, taken)
        probability = models[key].probability + combination.probability
        models[key] = replace(models[key], probability=probability)
    return list(models.values())


def normalised(candidates: Sequence[Candidate]) -> list[Candidate]:
    """The candidates with probabilities that add up to one; alike where none has any."""
    total = sum(each.probability for each in candidates)
    if not total:
        return [replace(each, probability=1 / len(candidates)) for each in candidates]
    return [replace(each, probability=each.probability / total) for each in candidates]


def carriers_of(trainings: Trainings, sensor: str, candidate: Candidate) -> dict[str, str | None]:
    """The manoeuvre that alone carries each effect, by the name of the effect; None: none does.

    What is of one position is carried by it, whatever manoeuvres it has: all of them are in one
    attitude, whose error they share, so that they hardly predict one another.
    """
    columns, positions = candidate.columns, trainings.models.extended.positions

    def of(effect: Effect) -> str | None:
        if effect.at is not None and effect.scan is not None and effect.scan.name == "position":
            return positions[int(effect.at)]
        own = [name for name in columns if name in effect.columns]
        return carrier(trainings, sensor, columns, own)

    return {effect.name: of(effect) for effect in candidate.effects}


# ---- The gain of a candidate in words

WITHOUT = _("Joint fit of all manoeuvres, without effects.")
BUT_ONE = _("Joint fit of all manoeuvres but {manoeuvre}, without effects.")
REDUCED = _(
    "With {effects} χ² of manoeuvres that the fit has not seen is reduced by {drop:.1f}, of "
    "{expected:.1f} that exactly known effects would bring."
)
INCREASED = _(
    "With {effects} χ² of manoeuvres that the fit has not seen grows by {growth:.1f}, where "
    "exactly known effects would reduce it by {expected:.1f}."
)
AGAINST_WALK = _(
    " Against the joint fit, which describes some of it by a random walk of the biases, it is "
    "reduced by {drop:.1f}."
)
NOT_COUNTED = _(
    " Not counted: {manoeuvres}; without {each} the others show less than half of the effect."
)
CARRIED = _(" Without {manoeuvre} the others do not show {effect}.")


def sentence_of(
    candidate: Candidate,
    validated: CrossValidation | None,
    carriers: Mapping[str, str | None],
) -> str:
    """What the model gains on held-out data, and which manoeuvres alone show its effects."""
    if candidate.left_out:
        return BUT_ONE.format(manoeuvre=candidate.left_out)
    if validated is None:
        return WITHOUT
    effects = listed([in_words(e.name) for e in candidate.effects])
    expected = validated.expected_drop
    if validated.drop >= 0:
        sentence = REDUCED.format(effects=effects, drop=validated.drop, expected=expected)
    else:
        sentence = INCREASED.format(effects=effects, growth=-validated.drop, expected=expected)
    if validated.walk_drop:
        sentence += AGAINST_WALK.format(drop=validated.drop_against_walk)
    if omitted := validated.not_counted:
        each = "it" if len(omitted) == 1 else "each"
        sentence += NOT_COUNTED.format(manoeuvres=", ".join(omitted), each=each)
    for effect, manoeuvre in carriers.items():
        if manoeuvre:
            sentence += CARRIED.format(manoeuvre=manoeuvre, effect=in_words(effect))
    return sentence

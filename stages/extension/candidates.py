"""The candidates for the result of one sensor: the joint fit, and models with effects."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from inertial.physics.effect import Effect
from inertial.text.parameters import EXTENDED, JOINT
from stages.extension.combinations import Combination
from stages.extension.cross_validation import Trainings, carrier


@dataclass(frozen=True)
class Candidate:
    """A model of one sensor.

    `effects`: those of the model that the sensor shows or absorbs; `findings`: by the name of an
    effect; `columns`: of the effects that it shows, in its equations; `absorbed`: of those that its
    parameters absorb, whose size the other sensor tells; `probability`: of the members of classes,
    those of the joint fit being the members that this sensor does not show.
    """

    method: str
    effects: tuple[Effect, ...] = ()
    findings: dict[str, str] = field(default_factory=dict)
    columns: tuple[str, ...] = ()
    absorbed: tuple[str, ...] = ()
    probability: float = 0.0


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
    """The manoeuvre that alone carries each effect, by the name of the effect; None: none does."""
    columns = candidate.columns
    return {
        effect.name: carrier(
            trainings, sensor, columns, [name for name in columns if name in effect.columns]
        )
        for effect in candidate.effects
    }

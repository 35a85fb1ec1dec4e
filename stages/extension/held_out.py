"""The extended model put to the test on manoeuvres that its fit has not seen."""

from collections.abc import Sequence
from dataclasses import dataclass

from stages.extension.folds import Fold, fold, groups, snr_squared
from stages.extension.models import SENSORS, Models, Told

FOLDS = 12  # so many fits at most
CLEAR = 9.0  # of chi-squared: what must be at stake, 3 sigma


@dataclass(frozen=True)
class HeldOut:
    """What the folds of one sensor tell.

    `whole`: all manoeuvres; `folds` with what their training tells, None where that is nothing;
    `snr_squared`: of the effects in all manoeuvres.
    """

    sensor: str
    whole: Told
    folds: Sequence[tuple[Fold, Told | None]]
    snr_squared: float

    @property
    def counted(self) -> list[tuple[Fold, Told]]:
        """The folds that count, and their training."""
        return [(one, told) for one, told in self.folds if one.counts and told is not None]

    @property
    def left_out(self) -> tuple[str, ...]:
        """The manoeuvres that alone show the effects."""
        return tuple(name for one, _ in self.folds if not one.counts for name in one.manoeuvres)

    @property
    def drop(self) -> float:
        """Of chi-squared over the folds that count, both models with the noise of the extended."""
        return sum(one.drop for one, _ in self.counted)

    @property
    def walked(self) -> float:
        """What a walk of the joint model foretells of them better than a bias that stands still."""
        return sum(self.whole.walked - told.walked for _, told in self.counted)

    @property
    def at_stake(self) -> float:
        """The part of SNR² that these folds took away; one manoeuvre may hold what others need."""
        return sum(one.at_stake for one, _ in self.counted)

    @property
    def possible(self) -> bool:
        """Whether they took away enough of the effect to judge it."""
        return self.at_stake >= CLEAR


def held_out(models: Models) -> dict[str, HeldOut]:
    """For each sensor that shows the effects, what others foretell of each manoeuvre."""
    every = models.told()
    found: dict[str, list[tuple[Fold, Told | None]]] = {sensor: [] for sensor in SENSORS}
    names = models.joint.manoeuvres
    if not any(every):
        return {}
    for some in groups(names, FOLDS):
        training = models.told(set(names) - set(some)) if len(names) > len(some) else [None, None]
        for sensor, whole, rest in zip(SENSORS, every, training, strict=True):
            if whole is not None:
                effects = rest.effects if rest else None
                found[sensor].append((fold(some, whole.effects, effects), rest))
    return {
        sensor: HeldOut(sensor, whole, found[sensor], snr_squared(whole.effects))
        for sensor, whole in zip(SENSORS, every, strict=True)
        if whole is not None
    }

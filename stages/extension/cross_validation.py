"""Prediction of manoeuvres by a model that was fitted to the others.

Of the effects' parameters β, all else fitted, the equations of some manoeuvres have the information
and right-hand side F_t, b_t, and those of all F, b; so those of the others, given the some, have
F − F_t and b − b_t. The training predicts β_t = F_t⁻¹ b_t, and the chi-squared of the others,
predicted without the effects less with them, is

    drop = 2 (b − b_t)ᵀ β_t − β_tᵀ (F − F_t) β_t

Both are predicted with the same covariance, and no prior width of β is in it. Where β is the truth
the drop is on average βᵀ (F − F_t) β, the part of SNR² = βᵀ F β that was held out, less
tr(F_t⁻¹ F − I), the cost of estimating β_t.

A fold is counted where its training keeps half of the information, or more, along the estimated
effect (design study); else its manoeuvres alone show the effect. Of a fold that is counted the
training may still know a combination of several parameters poorly. Where it keeps less than half of
its information, it predicts with it only if the training by itself shows it, at 3 sigma; else the
combination stays zero in both models.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.estimation.effect_information import EffectInformation, whitening
from inertial.sensors import SENSORS
from stages.extension.models import Models, SensorEvidence

MIN_TRAINING_SHARE = 0.5  # of the information
MIN_TRAINED_CHI_SQUARED = 9.0  # of a combination: 3 sigma
MIN_COMBINATION_SHARE = 0.05  # of the information; with less a fold would cost 20 by chance


@dataclass(frozen=True)
class Fold:
    """Some manoeuvres, predicted from the others.

    `kept`: of the information along the effect, by the training; `beta`: (k,), its estimate;
    `drop` of chi-squared; `expected_drop`: the drop if the parameters were known exactly;
    `untold`: chi-squared of the combinations that stay zero, as the training does not tell them.
    """

    manoeuvres: tuple[str, ...]
    kept: float
    beta: Array
    drop: float
    expected_drop: float
    untold: float = 0.0

    @property
    def counts(self) -> bool:
        """Whether the training shows enough of the effect."""
        return self.kept >= MIN_TRAINING_SHARE


def snr_squared(whole: EffectInformation) -> float:
    """The squared signal-to-noise ratio of the effects, less what noise adds; at least 0."""
    basis = whitening(whole.information)
    along = basis.T @ whole.right
    return max(float(along @ along) - len(along), 0.0)


def fold_of(
    manoeuvres: Sequence[str], whole: EffectInformation, training: EffectInformation | None
) -> Fold:
    """Predict `manoeuvres` from the training, which is all but them; None if that is nothing."""
    basis = whitening(whole.information)
    information = np.zeros_like(whole.information) if training is None else training.information
    right = np.zeros_like(whole.right) if training is None else training.right
    shares, rotation = np.linalg.eigh(basis.T @ information @ basis)
    basis = basis @ rotation
    along = basis.T @ whole.right
    trained = basis.T @ right
    used = (shares >= MIN_TRAINING_SHARE) | (
        (shares >= MIN_COMBINATION_SHARE) & (trained**2 >= MIN_TRAINED_CHI_SQUARED * shares)
    )
    beta = basis[:, used] @ (trained[used] / shares[used])
    held_out = np.maximum(1 - shares[used], 0.0)
    return Fold(
        tuple(manoeuvres),
        float(shares @ along**2 / max(along @ along, np.finfo(float).tiny)),
        beta,
        drop_of(beta, whole) - (0.0 if training is None else drop_of(beta, training)),
        float(held_out @ (along[used] ** 2 - 1)),
        float(np.sum(along[~used] ** 2)),
    )


def drop_of(beta: Array, effects: EffectInformation) -> float:
    """By how much chi-squared drops where the parameters are `beta`."""
    return float(2 * effects.right @ beta - beta @ effects.information @ beta)


def groups(manoeuvres: Sequence[str], most: int) -> list[tuple[str, ...]]:
    """Each manoeuvre by itself; where they are many, `most` interleaved groups."""
    return [tuple(manoeuvres[start::most]) for start in range(min(most, len(manoeuvres)))]


# ---- The folds of a campaign.

MAX_FOLDS = 12
MIN_SNR_SQUARED = 9.0  # of the effects in the folds that count: 3 sigma
MIN_HELD_OUT_SHARE = 0.1  # of the SNR²: with less each manoeuvre shows what no other does


@dataclass(frozen=True)
class CrossValidation:
    """The folds of one sensor.

    `whole`: all manoeuvres; `folds` with the evidence of their training, None where there is
    none; `snr_squared`: of the effects in all manoeuvres.
    """

    sensor: str
    whole: SensorEvidence
    folds: Sequence[tuple[Fold, SensorEvidence | None]]
    snr_squared: float

    @property
    def counted(self) -> list[tuple[Fold, SensorEvidence]]:
        """The folds that count, and their training."""
        return [(fold, rest) for fold, rest in self.folds if fold.counts and rest is not None]

    @property
    def not_counted(self) -> tuple[str, ...]:
        """The manoeuvres that alone show the effects."""
        return tuple(name for fold, _ in self.folds if not fold.counts for name in fold.manoeuvres)

    @property
    def drop(self) -> float:
        """Of chi-squared over the folds that count, both models with the noise of the extended."""
        return sum(fold.drop for fold, _ in self.counted)

    @property
    def walk_drop(self) -> float:
        """What a random walk of the joint model predicts better than a constant bias."""
        return sum(self._of_walk(training) for _, training in self.counted)

    @property
    def drop_against_walk(self) -> float:
        """The drop against the joint model with its random walk, where it has one.

        The walk predicts a manoeuvre from those beside it, so in a fold whose training leaves a
        part of the effect untold it would be compared with nothing.
        """
        if not self.walk_drop:
            return self.drop
        return sum(
            fold.drop - self._of_walk(training)
            for fold, training in self.counted
            if fold.untold < MIN_TRAINED_CHI_SQUARED
        )

    def _of_walk(self, training: SensorEvidence) -> float:
        return self.whole.walk_drop - training.walk_drop

    @property
    def expected_drop(self) -> float:
        """The part of SNR² in these folds; a manoeuvre may hold what the others need."""
        return sum(fold.expected_drop for fold, _ in self.counted)

    @property
    def saturated(self) -> bool:
        """Whether effects have a term for nearly every manoeuvre, so that none predicts another."""
        return self.expected_drop < MIN_HELD_OUT_SHARE * self.snr_squared

    @property
    def possible(self) -> bool:
        """Whether they hold enough of the effect to judge it."""
        return self.expected_drop >= MIN_SNR_SQUARED


class Trainings:
    """The evidence of all manoeuvres of a mount, and of those that the folds leave.

    It holds the columns of all candidates, so that no equation is formed twice.
    """

    def __init__(self, models: Models) -> None:
        self.models = models
        self.manoeuvres = models.joint.manoeuvres
        self.whole = dict(zip(SENSORS, models.evidence(), strict=True))
        self._without: dict[tuple[str, ...], dict[str, SensorEvidence | None]] = {}

    @property
    def folds(self) -> list[tuple[str, ...]]:
        """The groups of manoeuvres that are held out together."""
        return groups(self.manoeuvres, MAX_FOLDS)

    def without(self, held_out: tuple[str, ...], sensor: str) -> SensorEvidence | None:
        """The evidence of all other manoeuvres; None where there is none."""
        if held_out not in self._without:
            rest = set(self.manoeuvres) - set(held_out)
            some = self.models.evidence(rest) if rest else [None] * len(SENSORS)
            self._without[held_out] = dict(zip(SENSORS, some, strict=True))
        return self._without[held_out][sensor]


def cross_validate(
    trainings: Trainings, sensor: str, columns: Sequence[str]
) -> CrossValidation | None:
    """Every manoeuvre predicted from the others by the model with some columns of effects."""
    whole = trainings.whole[sensor]
    if whole is None:
        return None
    whole = whole.of(columns)
    folds: list[tuple[Fold, SensorEvidence | None]] = []
    for held_out in trainings.folds:
        rest = trainings.without(held_out, sensor)
        if rest is not None:
            rest = rest.of(columns)
        effects = rest.effects if rest else None
        folds.append((fold_of(held_out, whole.effects, effects), rest))
    return CrossValidation(sensor, whole, folds, snr_squared(whole.effects))


# ---- A manoeuvre that alone carries an effect.

MIN_DETECTED = 9.0  # of the reduction of chi-squared, beyond its degrees: 3 sigma


def carrier(
    trainings: Trainings, sensor: str, columns: Sequence[str], own: Sequence[str]
) -> str | None:
    """The manoeuvre without which an effect is not detected in the others; None if there is none.

    Either the others do not show the effect, or they contradict it. Where several are
    needed, the one without which least is left. Single manoeuvres of a group are left out only
    where the effect is not detected without the group.

    Parameters
    ----------
    columns : of all effects of the model
    own : of these, the columns of the effect
    """
    if not _detected(trainings.whole[sensor], columns, own):
        return None
    needed = [
        (name,)
        for held_out in trainings.folds
        if not _detected(trainings.without(held_out, sensor), columns, own)
        for name in held_out
    ]
    left = {
        held_out[0]: trainings.without(held_out, sensor)
        for held_out in needed
        if not _detected(trainings.without(held_out, sensor), columns, own)
    }
    return min(left, key=lambda name: _reduction(left[name], columns, own)[0], default=None)


def _detected(evidence: SensorEvidence | None, columns: Sequence[str], own: Sequence[str]) -> bool:
    drop, degrees = _reduction(evidence, columns, own)
    return degrees > 0 and drop >= MIN_DETECTED + degrees


def _reduction(
    evidence: SensorEvidence | None, columns: Sequence[str], own: Sequence[str]
) -> tuple[float, int]:
    """The reduction of chi-squared by an effect beside the others of its model, and its degrees."""
    if evidence is None:
        return 0.0, 0
    effects = evidence.effects.of(columns)
    others = [i for i, name in enumerate(columns) if name not in own]
    drop, degrees = effects.drop(range(len(columns)))
    known, used = effects.drop(others) if others else (0.0, 0)
    return drop - known, degrees - used

"""Prediction of manoeuvres by a model that was fitted to the others."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.least_squares import MIN_INFORMATION_SHARE, EffectInformation
from stages.extension.models import SENSORS, Models, Told

# ---- What a model foretells of manoeuvres that it has not seen.
#
# Of the effects' parameters β, all else fitted, some manoeuvres tell (F_t, b_t) and all of them
# (F, b); so the others tell, beside these, F − F_t and b − b_t. The training predicts β_t = F_t⁻¹
# b_t, and the chi-squared of the others, foretold without the effects less with them, is
#
#     drop = 2 (b − b_t)ᵀ β_t − β_tᵀ (F − F_t) β_t
#
# Both are foretold with the same covariance, and no width that β had beforehand is in it. Where β
# is the truth the drop is on average βᵀ (F − F_t) β, the part of SNR² = βᵀ F β that was taken
# away, less tr(F_t⁻¹ F − I), what it costs that β_t is only estimated.
#
# A fold is counted where its training keeps half of the information, or more, along the effect as
# it was found (design study); else its manoeuvres alone show the effect. Of a fold that is counted
# the training may still know a combination of several parameters poorly. Where it keeps less than
# half of that one's information, it foretells with it only if the training by itself shows it, at
# 3 sigma; else the combination stays zero in both models.

Array = NDArray[np.float64]

KEPT = 0.5  # of the information: what the training must keep
SHOWN = 9.0  # of chi-squared: 3 sigma
LEAST = 0.05  # of the information: with less a single fold would cost twenty by chance


@dataclass(frozen=True)
class Fold:
    """Some manoeuvres, foretold from the others.

    `kept`: of the information along the effect, by the training; `beta`: (k,), what it foretells
    with; `drop` of chi-squared; `at_stake`: the drop if the parameters were known exactly.
    """

    manoeuvres: tuple[str, ...]
    kept: float
    beta: Array
    drop: float
    at_stake: float

    @property
    def counts(self) -> bool:
        """Whether the training shows enough of the effect."""
        return self.kept >= KEPT


def basis_of(information: Array) -> Array:
    """Combinations of the parameters, (k, m), of which each is known with variance 1."""
    size = np.sqrt(np.maximum(np.diag(information), np.finfo(float).tiny))
    values, vectors = np.linalg.eigh(information / np.outer(size, size))
    seen = values > MIN_INFORMATION_SHARE
    return np.asarray(vectors[:, seen] / np.sqrt(values[seen]) / size[:, None])


def snr_squared(whole: EffectInformation) -> float:
    """The signal-to-noise ratio squared of the effects, what noise adds taken off; at least 0."""
    basis = basis_of(whole.information)
    along = basis.T @ whole.right
    return max(float(along @ along) - len(along), 0.0)


def fold(
    manoeuvres: Sequence[str], whole: EffectInformation, training: EffectInformation | None
) -> Fold:
    """Foretell `manoeuvres` from the training, which is all but them; None if that is nothing."""
    basis = basis_of(whole.information)
    information = np.zeros_like(whole.information) if training is None else training.information
    right = np.zeros_like(whole.right) if training is None else training.right
    left, turn = np.linalg.eigh(basis.T @ information @ basis)
    basis = basis @ turn
    along = basis.T @ whole.right
    trained = basis.T @ right
    there = (left >= KEPT) | ((left >= LEAST) & (trained**2 >= SHOWN * left))
    beta = basis[:, there] @ (trained[there] / left[there])
    taken = np.maximum(1 - left[there], 0.0)
    return Fold(
        tuple(manoeuvres),
        float(left @ along**2 / max(along @ along, np.finfo(float).tiny)),
        beta,
        drop_of(beta, whole) - (0.0 if training is None else drop_of(beta, training)),
        float(taken @ (along[there] ** 2 - 1)),
    )


def drop_of(beta: Array, told: EffectInformation) -> float:
    """By how much chi-squared drops where the parameters are `beta`."""
    return float(2 * told.right @ beta - beta @ told.information @ beta)


def groups(manoeuvres: Sequence[str], most: int) -> list[tuple[str, ...]]:
    """The manoeuvres each by itself; where they are many, in `most` groups through the plan."""
    return [tuple(manoeuvres[start::most]) for start in range(min(most, len(manoeuvres)))]


# ---- The extended model put to the test on manoeuvres that its fit has not seen.

FOLDS = 12  # so many fits at most
MIN_SNR_SQUARED = 9.0  # of chi-squared: what must be at stake, 3 sigma


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
        return self.at_stake >= MIN_SNR_SQUARED


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

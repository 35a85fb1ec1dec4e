"""The joint model of one mount and the extended one."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from operator import add

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.campaign.effect_evidence import MIN_OBSERVABLE_SIGMAS
from inertial.campaign.equations import Campaign
from inertial.estimation.effect_information import (
    MIN_INFORMATION_SHARE,
    EffectInformation,
    whitening,
)
from inertial.estimation.least_squares import Estimate, System, with_columns
from inertial.model_selection.size_after_selection import corrected, regressed
from inertial.physics.effect import Effect
from stages.extension.named_effects import NamedClass

PRIOR_SIGMA = 1e4  # of an effect's parameters, in their typical sizes
MIN_OWN_SHARE = 0.01  # of the other sensor's information: less improves a sigma by half a percent


@dataclass(frozen=True)
class SensorEvidence:
    """The information of the equations of a sensor, of all manoeuvres or of some.

    `plain`: the fit without the effects, with the noise of the extended model; `effects`: the
    information on the effects, all else fitted, without a prior;
    `walk_drop`: where the joint model has another random walk than the extended one, by how much
    that lowers −2 log of the likelihood.
    """

    plain: Estimate
    effects: EffectInformation
    walk_drop: float

    def of(self, names: Sequence[str]) -> "SensorEvidence":
        """The same for some parameters of the effects, the others being zero."""
        return replace(self, effects=self.effects.of(names))


@dataclass(frozen=True)
class Models:
    """Both models, the extended one with the random walks that remain given its effects.

    `effects`: of all candidates; each candidate has some of their columns.
    """

    joint: Campaign
    extended: Campaign
    effects: tuple[Effect, ...]

    @cached_property
    def shown(self) -> tuple[frozenset[str], frozenset[str]]:
        """The columns of the effects that gyros, and accelerometers, show by themselves.

        A column is not shown where its information, all else fitted, is no more than rounding,
        where the largest plausible size would not be observable, or where the other sensor tells
        so much more that its own adds nothing: there the sensor's parameters take the effect up.
        """
        (gyro, _), (accel, _) = self._information
        return _told_by(gyro, accel), _told_by(accel, gyro)

    @cached_property
    def absorbed(self) -> tuple[frozenset[str], frozenset[str]]:
        """The columns that the parameters of a sensor absorb, and that the other sensor shows."""
        some = {name for e in self.effects if e.absorbed_by for name in e.columns}
        (gyro, accel), ((_, in_gyro), (_, in_accel)) = self.shown, self._information
        return frozenset((some | in_gyro) & (accel - gyro)), frozenset(
            (some | in_accel) & (gyro - accel)
        )

    @cached_property
    def _information(self) -> "tuple[Observable, Observable]":
        """Of both sensors."""
        largest = np.array([e.largest_of(p) for e in self.effects for p in e.parameters])
        gyro, accel = (
            _observable(system, largest)
            for system in self.extended.systems(self.effects, PRIOR_SIGMA)
        )
        return gyro, accel

    def complete(self) -> list[System | None]:
        """The equations with the effects that each sensor shows or absorbs; None where none is."""
        return [
            with_columns(system, own) if system is not None and own else None
            for system, shown, absorbed in zip(
                self.extended.systems(self.effects, PRIOR_SIGMA),
                self.shown,
                self.absorbed,
                strict=True,
            )
            for own in [shown | absorbed]
        ]

    def systems(self, only: set[str] | None = None) -> list[System | None]:
        """The equations with the effects that each sensor shows; None where it shows none."""
        systems = self.extended.systems(self.effects, PRIOR_SIGMA, only)
        return [
            None if system is None or not shown else with_columns(system, shown)
            for system, shown in zip(systems, self.shown, strict=True)
        ]

    def evidence(self, only: set[str] | None = None) -> list[SensorEvidence | None]:
        """The evidence of gyros and accelerometers in some manoeuvres, or in all."""
        systems = self.systems(only)
        with_walk: list[System | None] = [None, None]
        joint, extended = self.joint.solution.random_walks, self.extended.solution.random_walks
        if any(walk and walk != other for walk, other in zip(joint, extended, strict=True)):
            with_walk = [
                system if walk and walk != other else None
                for system, walk, other in zip(
                    self.joint.systems([], PRIOR_SIGMA, only), joint, extended, strict=True
                )
            ]
        return [
            None if system is None else _evidence(system, joint)
            for system, joint in zip(systems, with_walk, strict=True)
        ]


def models_of(
    campaign: Campaign, effects: Sequence[Effect], random_walks: tuple[float, float]
) -> Models:
    """Both models of a mount for the named effects.

    `random_walks`: of the biases of gyros and accelerometers given the effects, rad/s/√s and
    m/s²/√s.
    """
    return Models(campaign, campaign.with_random_walks(random_walks), tuple(effects))


def _evidence(system: System, joint: System | None) -> SensorEvidence:
    """`joint`: the equations of the joint model where that has another random walk."""
    plain = with_columns(system, frozenset()).solve_shared()
    drop = 0.0 if joint is None else plain.deviance - joint.solve_shared().deviance
    return SensorEvidence(plain, system.effect_information(), drop)


# The information of a sensor's equations on each observable column, all else fitted; and the
# columns in its readings, which would be observable if nothing else were fitted.
Observable = tuple[Mapping[str, float], frozenset[str]]


def _observable(system: System | None, largest: Array) -> Observable:
    if system is None:
        return {}, frozenset()
    reduced = system.effect_information()
    names, information = np.array(reduced.names), np.diag(reduced.information)
    raw = system.raw_information()
    determined = information > MIN_INFORMATION_SHARE * raw
    there = determined & _is_large(largest, information)
    known = dict(zip(names[there].tolist(), information[there].tolist(), strict=True))
    return known, frozenset(names[_is_large(largest, raw)].tolist())


def _is_large(largest: Array, information: Array) -> Booleans:
    """Whether the largest plausible size of each column is observable, (k,)."""
    return np.asarray(largest * np.sqrt(np.maximum(information, 0.0)) > MIN_OBSERVABLE_SIGMAS)


def _told_by(own: Mapping[str, float], other: Mapping[str, float]) -> frozenset[str]:
    """The columns of which a sensor tells something beside the other one."""
    return frozenset(n for n, known in own.items() if known > MIN_OWN_SHARE * other.get(n, 0.0))


def given(system: System, estimates: Mapping[str, tuple[float, float]]) -> System:
    """The equations with columns of effects whose values and sigmas the other sensor tells."""
    prior, sigma = system.prior.copy(), system.prior_sigma.copy()
    for i, (kind, name) in enumerate(system.names):
        if kind == "effect" and name in estimates:
            prior[i], sigma[i] = estimates[name]
    return replace(system, prior=prior, prior_sigma=sigma)


def compressed(system: System) -> System:
    """Fewer equations with the same sum of squares, for many fits of some of the columns."""
    whole = np.column_stack([system.design, system.observed]) / system.sigma[:, None]
    triangle = np.asarray(np.linalg.qr(whole, mode="r"))
    return replace(
        system, design=triangle[:, :-1], observed=triangle[:, -1], sigma=np.ones(len(triangle))
    )


# ---- Sizes of the named effects in the models, corrected for their having been selected.
#
# Criticism named an effect by the equations of both sensors; by how much its size is on average too
# large then, it tells by the statistic and its threshold. Here each sensor is fitted by itself, and
# other members of a class in place of the named effect. What was too large of the named effect the
# fit of another model took up as well: its parameters move by A δ, A = F⁻¹ F_n, F the information
# of the sensor on its own effects and F_n that between these and the named ones. The twelve
# parameters of the sensor move with the effects of the model, as the conditional mean of a
# Gaussian.


@dataclass(frozen=True)
class SelectedSizes:
    """By how much the named effects change after selection.

    `evidence`: of each sensor on the effects of all candidates; `names`: of the columns of the
    named effects, (k,); `shift`: of their values, (k,); `change`: of their covariance, (k, k).
    """

    evidence: Mapping[str, SensorEvidence | None]
    names: tuple[str, ...]
    shift: Array
    change: Array

    def applied(self, sensor: str, system: System, estimate: Estimate) -> Estimate:
        """The estimate of the equations of a sensor with the effects of a model, corrected."""
        evidence = self.evidence[sensor]
        own = [i for i, (kind, _) in enumerate(system.names) if kind == "effect"]
        if evidence is None or not own or not self.shift.any():
            return estimate
        follows = self._follows(evidence.effects, [system.names[i][1] for i in own])
        covariance = estimate.covariance
        follows = regressed(covariance[:, own], covariance[np.ix_(own, own)]) @ follows
        values = estimate.values.copy()
        values[: len(follows)] += follows @ self.shift
        added = follows @ self.change @ follows.T
        return replace(estimate, values=values, covariance=covariance + added)

    def _follows(self, effects: EffectInformation, own: Sequence[str]) -> Array:
        """What a sensor's estimate of own columns moves by per unit of the named ones, (m, k)."""
        whole = _of(effects, tuple(dict.fromkeys((*own, *self.names)))).information
        column = {name: i for i, name in enumerate(dict.fromkeys((*own, *self.names)))}
        mine, named = [column[name] for name in own], [column[name] for name in self.names]
        basis = whitening(whole[np.ix_(mine, mine)])
        return np.asarray(basis @ (basis.T @ whole[np.ix_(mine, named)]))


def selected_sizes(
    evidence: Mapping[str, SensorEvidence | None], classes: Sequence[NamedClass]
) -> SelectedSizes:
    """The correction of the first members of the classes, fitted together to both sensors."""
    columns = [each.members[0].effect.columns for each in classes]
    names = tuple(name for own in columns for name in own)
    known = [_of(each.effects, names) for each in evidence.values() if each is not None]
    if not known:
        return SelectedSizes(evidence, names, np.zeros(len(names)), np.zeros((len(names),) * 2))
    values, covariance = reduce(add, known).estimate(range(len(names)))
    places = {name: i for i, name in enumerate(names)}
    effects = {
        tuple(places[name] for name in own): each.selected
        for own, each in zip(columns, classes, strict=True)
    }
    after, changed = corrected(values, covariance, effects)
    return SelectedSizes(
        evidence, names, np.nan_to_num(after - values), np.nan_to_num(changed - covariance)
    )


def _of(effects: EffectInformation, names: tuple[str, ...]) -> EffectInformation:
    """The information on some columns, none on those that a sensor does not show."""
    place = {name: i for i, name in enumerate(effects.names)}
    there = [(i, place[name]) for i, name in enumerate(names) if name in place]
    new, old = (list(each) for each in zip(*there, strict=True)) if there else ([], [])
    information, right = np.zeros((len(names), len(names))), np.zeros(len(names))
    information[np.ix_(new, new)] = effects.information[np.ix_(old, old)]
    right[new] = effects.right[old]
    return replace(effects, names=names, information=information, right=right)

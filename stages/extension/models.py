"""The joint model of one mount and the extended one."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inertial.campaign.equations import MIN_OBSERVABLE_SIGMAS, Campaign
from inertial.estimation.least_squares import (
    MIN_INFORMATION_SHARE,
    EffectInformation,
    Estimate,
    System,
)
from inertial.physics.effect import Effect

PRIOR_SIGMA = 1e4  # of an effect's parameters, in their typical sizes
SENSORS = ("gyro", "accel")


@dataclass(frozen=True)
class SensorEvidence:
    """What the equations of one sensor tell, those of all manoeuvres or of some.

    `plain`: the fit without the effects, with the noise of the extended model; `effects`: what is
    said of the effects, all else fitted and nothing taken to be known of them beforehand;
    `walk_drop`: where the biases of the joint model walk and those of the extended one do not, or
    less, by how much that lowers −2 log of the likelihood.
    """

    plain: Estimate
    effects: EffectInformation
    walk_drop: float


@dataclass(frozen=True)
class Models:
    """Both models, the extended one with the walks of the biases that its effects leave."""

    joint: Campaign
    extended: Campaign
    effects: tuple[Effect, ...]

    @cached_property
    def shown(self) -> tuple[frozenset[str], frozenset[str]]:
        """The columns of the effects that gyros, and accelerometers, show by themselves.

        What fitting all else leaves no more of than rounding is not shown, nor what would not be
        seen at the largest size that is thought of.
        """
        largest = np.array([e.largest for e in self.effects for _ in e.parameters])
        gyro, accel = (
            _shown(system, largest) for system in self.extended.systems(self.effects, PRIOR_SIGMA)
        )
        return gyro, accel

    def systems(self, only: set[str] | None = None) -> list[System | None]:
        """The equations with the effects that each sensor shows; None where it shows none."""
        systems = self.extended.systems(self.effects, PRIOR_SIGMA, only)
        return [
            None if system is None or not shown else _with(system, shown)
            for system, shown in zip(systems, self.shown, strict=True)
        ]

    def evidence(self, only: set[str] | None = None) -> list[SensorEvidence | None]:
        """What gyros and accelerometers tell in some manoeuvres, or in all."""
        systems = self.systems(only)
        walking: list[System | None] = [None, None]
        walks, others = self.joint.solution.random_walks, self.extended.solution.random_walks
        if any(walk and walk != other for walk, other in zip(walks, others, strict=True)):
            walking = [
                system if walk and walk != other else None
                for system, walk, other in zip(
                    self.joint.systems([], PRIOR_SIGMA, only), walks, others, strict=True
                )
            ]
        return [
            None if system is None else _evidence(system, walks)
            for system, walks in zip(systems, walking, strict=True)
        ]


def models_of(campaign: Campaign, effects: Sequence[Effect], walks: tuple[float, float]) -> Models:
    """Both models of a mount for the effects that were named.

    `walks`: of the biases of gyros and accelerometers beside the effects, rad/s/√s and m/s²/√s.
    """
    return Models(campaign, campaign.with_random_walks(walks), tuple(effects))


def _evidence(system: System, walking: System | None) -> SensorEvidence:
    """`walking`: the equations of the joint model where that has another walk."""
    plain = _with(system, frozenset()).solve_shared()
    drop = 0.0 if walking is None else plain.deviance - walking.solve_shared().deviance
    return SensorEvidence(plain, system.effect_information(), drop)


def _shown(system: System | None, largest: np.ndarray) -> frozenset[str]:
    if system is None:
        return frozenset()
    reduced = system.effect_information()
    information = np.diag(reduced.information)
    seen = information > MIN_INFORMATION_SHARE * system.raw_information()
    clear = largest * np.sqrt(np.maximum(information, 0.0)) > MIN_OBSERVABLE_SIGMAS
    return frozenset(np.array(reduced.names)[seen & clear].tolist())


def _with(system: System, shown: frozenset[str]) -> System:
    """The equations without the columns of effects that are not shown."""
    kept = [i for i, (kind, name) in enumerate(system.names) if kind != "effect" or name in shown]
    return replace(
        system,
        design=system.design[:, kept],
        prior=system.prior[kept],
        prior_sigma=system.prior_sigma[kept],
        names=tuple(system.names[i] for i in kept),
        # The errors that were eliminated are not asked for here, and hold the other columns.
        eliminated=system.eliminated and replace(system.eliminated, steps=()),
    )

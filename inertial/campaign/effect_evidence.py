"""The evidence of the equations of a campaign on the effects of the catalogue."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.campaign.shared_tilts import shared_tilts
from inertial.estimation.effect_information import EffectInformation
from inertial.estimation.least_squares import System
from inertial.model_selection.evidence import Evidence
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS

MIN_OBSERVABLE_SIGMAS = 5.0  # sigmas of an effect at its largest size; less is not observable
MIN_OWN_SIGMAS = 1.0  # the same, by one sensor of those that see it


def evidence(
    campaign: Campaign, effects: Sequence[Effect], noise_degrees: float = np.inf
) -> Evidence:
    """The information of gyros and accelerometers on the effects, other unknowns eliminated.

    The two share the tilts of the positions. That of the gyros is what they add to the
    accelerometers, so that the two are independent. The columns are named by label and parameter of
    an effect. The information is zero for an effect that is sought elsewhere, and where it is not
    observable at its largest size: there it could only absorb errors of the linearisation. So it is
    of a sensor by itself, where the other one sees it. That is judged against noise alone: a
    scatter by hand may be all effect. `noise_degrees`: of freedom of the noise estimate.
    """
    systems, informative = _informative(campaign, effects)
    quiet = campaign.without_scatter()
    against = informative if quiet is campaign else _informative(quiet, effects)[1]
    largest = np.array(
        [
            effect.largest_of(parameter)
            if effect.sought_in == "blocks" and not campaign.excludes(effect)
            else 0.0
            for effect in effects
            for parameter in effect.parameters
        ]
    )
    own = [largest**2 * np.diag(reduced.information) for _, reduced in against]
    observable = sum(own, np.zeros(1)) > MIN_OBSERVABLE_SIGMAS**2
    seen = [observable & (squares > MIN_OWN_SIGMAS**2) for squares in own]
    return Evidence(
        tuple(
            _restricted(reduced, columns.astype(np.float64))
            for (_, reduced), columns in zip(informative, seen, strict=True)
        ),
        tuple(sensor for sensor, _ in informative),
        tuple(campaign.noise_degrees(sensor, noise_degrees) for sensor, _ in informative),
        np.array([system.raw_information()[: len(largest)] for _, system in systems]),
    )


def _informative(
    campaign: Campaign, effects: Sequence[Effect]
) -> tuple[list[tuple[str, System]], list[tuple[str, EffectInformation]]]:
    """The equations by sensor, and their information on the effects, made independent."""
    tilts = shared_tilts(campaign)
    shared = tilts.names if tilts else {}
    pairs = zip(SENSORS, campaign.systems(effects, 1.0, sharing=shared), strict=True)
    systems = [(sensor, system) for sensor, system in pairs if system is not None]
    informative = [(sensor, system.effect_information()) for sensor, system in systems]
    if tilts:
        (_, gyro), (_, accel) = informative
        gyro, before = tilts.by_those_of_accelerometers(gyro, accel), tilts.before["accel"]
        independent = gyro.following(accel, before), accel.eliminated(before)
        informative = list(zip(SENSORS, independent, strict=True))
    return systems, informative


def _restricted(reduced: EffectInformation, observable: Array) -> EffectInformation:
    """The same with zeros in the columns that are not observable, (k,)."""
    return replace(
        reduced,
        information=reduced.information * np.outer(observable, observable),
        right=reduced.right * observable,
    )

"""How far an effect that is not detected moves the parameters of the result.

The sigma of a parameter holds the noise and what is known of table and site, no effect that nobody
named. One that is as large as its detection limit moves the estimate by the fit of its trace to the
readings: in geodesy the external reliability of a network, beside the internal one, which the
detection limit is.

Source: Baarda, A testing procedure for use in geodetic networks, Delft 1968.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import PRIOR_SIZE, Campaign
from inertial.estimation.triad import linear_names
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS


@dataclass(frozen=True)
class Moved:
    """The parameter of a sensor that an effect moves most, and by how many of its sigmas."""

    sensor: str
    parameter: str
    sigmas: float


NOTHING = Moved("", "", 0.0)


def most_moved(
    campaign: Campaign, named: Sequence[Effect], tested: Sequence[Effect]
) -> list[list[Moved]]:
    """What each parameter of each tested effect moves most, by an effect of the size one, in SI.

    `named`: effects that are estimated beside the parameters.
    """
    found = [[NOTHING] * len(effect.parameters) for effect in tested]
    for sensor in SENSORS:
        system = campaign.system(sensor, [*named, *tested], PRIOR_SIZE)
        if system is None:
            continue
        names, shifts = system.shifts(sum(len(effect.parameters) for effect in named))
        columns = iter(np.abs(shifts).T)
        for own in found:
            for i, before in enumerate(own):
                own[i] = max(before, _largest(sensor, names, next(columns)), key=_sigmas)
    return found


def _largest(sensor: str, names: Sequence[str], sigmas: Array) -> Moved:
    if not len(sigmas):
        return NOTHING
    worst = int(np.argmax(sigmas))
    own = names[worst]
    parameter = linear_names()[int(own)] if own.isdigit() else own
    return Moved(sensor, parameter, float(sigmas[worst]))


def _sigmas(moved: Moved) -> float:
    return moved.sigmas

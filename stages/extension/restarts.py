"""By what the biases of runs differ that restarts of the IMU part, beside other effects.

Then the result is that of stated switch-ons: of the mean of the biases, about which those of the
runs scatter by what they show themselves. Two runs do not show how well biases repeat: the mean
holds for these two alone, and its sigma is half their difference.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.effects.restarts import Restarts
from inertial.estimation.scatter_and_random_walk import SwitchOns, between
from inertial.physics.effect import Effect
from stages.extension.models import PRIOR_SIGMA
from stages.extension.named_effects import NamedClass

MIN_RUNS = 3  # that show how well biases repeat: one difference has 6 times the interval of many


def with_spreads(campaign: Campaign, classes: Sequence[NamedClass]) -> tuple[NamedClass, ...]:
    """The classes, whose restarts have biases that scatter by as much as they do."""
    known = [each.members[0].effect for each in classes]
    known = [effect for effect in known if effect.scan is None or effect.at is not None]

    def sized(effect: Effect) -> Effect:
        if not isinstance(effect, Restarts) or (spread := _spread(campaign, effect, known)) is None:
            return effect
        return effect.with_spread(spread)

    return tuple(
        replace(
            each,
            members=tuple(member._replace(effect=sized(member.effect)) for member in each.members),
        )
        for each in classes
    )


def _spread(campaign: Campaign, restarts: Restarts, known: Sequence[Effect]) -> Array | None:
    """Sigma of the biases of runs about their mean, (3,), by restricted likelihood."""
    others = [effect for effect in known if effect.name != restarts.name]
    system = campaign.system(restarts.sensor, [restarts, *others], PRIOR_SIGMA)
    if system is None:
        return None
    whole = system.effect_information()
    place = {name: i for i, name in enumerate(whole.names)}
    rest = whole.given([place[name] for effect in others for name in effect.columns])
    found = []
    for axis in range(3):
        own = [place[name] for name in restarts.columns[axis::3]]
        found.append(between(rest.information[np.ix_(own, own)], rest.right[own]))
    runs = SwitchOns(len(restarts.times) + 1, *np.array(found).T)
    return runs.covering if runs.count >= MIN_RUNS else np.nan_to_num(runs.value)

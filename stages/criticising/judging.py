"""The causes that a campaign asks for.

Where something is scanned they are found twice, the second time with finer values about the first.
Where the joint estimate has found a random walk, it may stand for effects, or they for it: the two
explanations are weighed by their likelihoods.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from stages.criticising.course import course_of, courses
from stages.estimation.evidence import Campaign, evidence
from stages.inference.least_squares import LIKELIER
from stages.inference.naming.causes import name_causes
from stages.inference.naming.evidence import Evidence
from stages.inference.naming.named import Named
from stages.inference.naming.refining import finer, to_refine
from stages.inference.naming.sought import Sought, sought
from stages.inference.naming.visible import Visible, visible
from stages.model.effect import Effect

OCCAM = 20.0  # of the deviance: so much the sizes that were possible beforehand weigh at most
FINER = 4  # steps of the second look in each interval of the first
SENSORS = ("gyro", "accel")


@dataclass(frozen=True)
class Judged:
    """What the blocks of one mount say: of every effect, of those that are named, and unseen.

    `walks`: whether the biases walk in these equations; `instead`: causes that would explain about
    as well what the walk explains; `asked`: the columns of each effect in
    `said`; `families`: its candidates by its name, in the order of `Sought.candidates`.
    """

    walks: bool
    instead: tuple[str, ...]
    said: Evidence
    asked: Sequence[Sought]
    families: Mapping[str, Sequence[Effect]]
    named: Named
    visible: Sequence[Visible]

    def effect(self, name: str, value: int) -> Effect:
        """A candidate."""
        return self.families[name][value]


def judge(
    campaign: Campaign, effects: Sequence[Effect], level: float, noise_degrees: float
) -> Judged:
    """Name the causes among `effects`; `level`: accepted chance of naming one where none is."""
    with_walk = _judge(campaign, effects, level, noise_degrees)
    if not any(campaign.solution.walks):
        return with_walk
    still = campaign.without_walk()
    alone = _judge(still, effects, level, noise_degrees)
    named = [
        alone.effect(cause.effect, cause.value)
        for cause in alone.named.causes
        if cause.effect in alone.families
    ]
    if not named:
        return with_walk
    worse = still.deviance(named) - campaign.deviance([])
    if worse < -LIKELIER:
        return alone
    if worse > OCCAM:
        return with_walk
    members = [member for cause in alone.named.causes for member in cause.members]
    return replace(with_walk, instead=tuple(dict.fromkeys(members)))


def _judge(
    campaign: Campaign, effects: Sequence[Effect], level: float, noise_degrees: float
) -> Judged:
    families = {name: tuple(family) for name, family in campaign.candidates(effects).items()}
    said, asked = said_of(campaign, families, noise_degrees)
    named = name_causes(said, asked, level)
    seen = visible(said, [one for one in asked if not one.free])
    if refined := to_refine(said, named, asked):
        families |= {name: _finer(families[name], places) for name, places in refined.items()}
        said, asked = said_of(campaign, families, noise_degrees)
        named = name_causes(said, asked, level)
    return Judged(any(campaign.solution.walks), (), said, asked, families, named, seen)


def _finer(family: Sequence[Effect], places: Sequence[int]) -> tuple[Effect, ...]:
    values = np.array([one.at for one in family], np.float64)
    return tuple(family[0].fixed(float(at)) for at in finer(values, places, FINER))


def said_of(
    campaign: Campaign, families: Mapping[str, Sequence[Effect]], noise_degrees: float
) -> tuple[Evidence, list[Sought]]:
    """What the equations say of all candidates and of free courses, and what is sought there."""
    free = {course_of(sensor): tuple(courses(sensor)) for sensor in SENSORS}
    every = [one for family in [*families.values(), *free.values()] for one in family]
    said = evidence(campaign, every, noise_degrees)
    place = {name: i for i, name in enumerate(said.names)}

    def columns(one: Effect) -> list[int]:
        return [place[f"{one.label}.{parameter.name}"] for parameter in one.parameters]

    if not said.sensors:
        return said, [sought(name) for name in families]
    asked = [sought(name, *(columns(one) for one in family)) for name, family in families.items()]
    for name, waves in free.items():
        axes = np.array([columns(one) for one in waves]).T  # (3, waves)
        asked.append(sought(name, *axes.tolist(), axes.ravel().tolist(), free=True))
    return said, asked

"""Selection of the unmodelled effects of one mount from its block means."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.campaign.equations import Campaign, evidence
from inertial.estimation.variance_components import MIN_DEVIANCE_DROP
from inertial.model_selection.cause import UNKNOWN_STRUCTURE, Cause, Named
from inertial.model_selection.detection_limits import Visible, visible
from inertial.model_selection.evidence import Evidence, Sought, sought
from inertial.model_selection.naming import causes, law_of
from inertial.model_selection.scan_refinement import finer, to_refine
from inertial.physics.effect import Effect
from stages.criticism.bias_drift import course_of, courses, slight, walks_beside

OCCAM = 20.0  # of the deviance: so much the sizes that were possible beforehand weigh at most
FINER = 4  # steps of the second look in each interval of the first
SHARP = 20.0  # signal-to-noise ratio from which a third look is finer still
WALKLIKE = 0.2  # share of its information that a walk leaves an effect, below which it is like one
SENSORS = ("gyro", "accel")


@dataclass(frozen=True)
class Judged:
    """What the blocks of one mount say: of every effect, of those that are named, and unseen.

    `campaign`: with the random walks that the equations had; `instead`: causes that would explain
    about as well what a walk explains; `asked`: the columns of each effect in
    `said`; `families`: its candidates by its name, in the order of `Sought.candidates`.
    """

    campaign: Campaign
    instead: tuple[str, ...]
    said: Evidence
    asked: Sequence[Sought]
    families: Mapping[str, Sequence[Effect]]
    named: Named
    visible: Sequence[Visible]

    def effect(self, name: str, value: int) -> Effect:
        """A candidate."""
        return self.families[name][value]

    @property
    def effects(self) -> list[Effect]:
        """The named effects; a course without a law is none."""
        found = [cause for cause in self.named.causes if cause.effect in self.families]
        return [self.effect(cause.effect, cause.value) for cause in found]

    @property
    def walks(self) -> tuple[float, float]:
        """Random walks of the biases of gyros and accelerometers, rad/s/√s and m/s²/√s."""
        return self.campaign.solution.walks

    def demoted(self, sensors: Sequence[str]) -> "Judged":
        """The same where structures are left in these sensors: no name of theirs is certain."""

        def uncertain(cause: Cause) -> Cause:
            inside = self.sensor(cause) in sensors
            return replace(cause, verdict=UNKNOWN_STRUCTURE) if inside else cause

        causes = tuple(uncertain(cause) for cause in self.named.causes)
        return replace(self, named=replace(self.named, causes=causes))

    def sensor(self, cause: Cause) -> str:
        """The sensor that sees a cause best."""
        return self.said.labels[self.said.sensor_of(cause.columns)]

    def consistent(self) -> dict[str, list[str]]:
        """Of each sensor the causes with which the data are no more than consistent."""
        found: dict[str, list[str]] = {sensor: [] for sensor in SENSORS}
        for cause in self.named.causes:
            if cause.verdict == UNKNOWN_STRUCTURE and cause.effect in self.families:
                found[self.sensor(cause)] += cause.members
        return found

    def deviance(self) -> float:
        """−2 log of the likelihood with what is named, and what each size costs beforehand.

        An effect is as large as it was found, in its typical sizes: an effect of nine numbers has
        one size, as a walk has one.
        """
        sizes = [self._size(place) for place in _clear(self)]
        asked = len(sizes) + sum(map(bool, self.walks))
        return self.campaign.deviance(self.effects, sizes) + MIN_DEVIANCE_DROP * asked

    def _size(self, place: int) -> float:
        """How large a named effect is, in its typical sizes."""
        cause = self.named.causes[place]
        effect = self.effect(cause.effect, cause.value)
        typical = np.array([parameter.typical for parameter in effect.parameters])
        return float(np.sqrt(np.mean(np.nan_to_num(np.array(cause.values) / typical) ** 2))) or 1.0


def judge(
    campaign: Campaign, effects: Sequence[Effect], level: float, noise_degrees: float
) -> Judged:
    """Name the causes among `effects`; `level`: accepted chance of naming one where none is."""

    def judged(walks: tuple[float, float]) -> Judged:
        return _judge(campaign.walking(walks), effects, level, noise_degrees)

    still = judged((0.0, 0.0))
    walks = campaign.solution.walks
    if not any(walks):
        walks = _walks_instead(still)
    if not any(walks):
        return still
    walking = judged(walks)
    found = _likelier(still, walking)
    if found.effects:
        walks = walks_beside(found.campaign, found.effects)
        if walks != found.walks:
            found = replace(judged(walks), instead=found.instead) if any(walks) else still
    if not any(found.walks):
        return found
    other = tuple(member for member in found.instead if member not in _members(found))
    return _consistent(replace(found, instead=other))


def _likelier(still: Judged, walking: Judged) -> Judged:
    """Effects without walks, or with them, or with the others as what may stand for the walks."""
    if not still.effects:
        return walking
    more = still.deviance() - walking.deviance()
    if more < -MIN_DEVIANCE_DROP:
        return still
    return replace(walking, instead=_members(still)) if more < OCCAM else walking


def _walks_instead(judged: Judged) -> tuple[float, float]:
    """The likeliest random walks that may stand for effects like them; 0 where none may."""
    campaign, effects = judged.campaign, judged.effects
    like = _like_a_walk(campaign.walking(slight(campaign)), judged)
    if not any(like):
        return (0.0, 0.0)
    return walks_beside(
        campaign, [one for one, walks in zip(effects, like, strict=True) if not walks]
    )


def _members(judged: Judged) -> tuple[str, ...]:
    members = [member for cause in judged.named.causes for member in cause.members]
    return tuple(dict.fromkeys(members))


def _consistent(judged: Judged) -> Judged:
    """The same; of causes that a walk could do as well no more is said than that they may be."""
    like = dict(zip(_clear(judged), _like_a_walk(judged.campaign, judged), strict=True))
    causes = tuple(
        replace(cause, verdict=UNKNOWN_STRUCTURE) if like.get(place) else cause
        for place, cause in enumerate(judged.named.causes)
    )
    return replace(judged, named=replace(judged.named, causes=causes))


def _clear(judged: Judged) -> list[int]:
    """Which of the causes are effects, and no courses without a law."""
    return [i for i, cause in enumerate(judged.named.causes) if cause.effect in judged.families]


def _like_a_walk(walking: Campaign, judged: Judged) -> list[bool]:
    """Of each named effect whether walks leave little of what is known of it."""
    named = judged.effects
    if not named:
        return []
    said = [evidence(campaign, named).total for campaign in (walking, walking.without_walk())]
    result = []
    for place, effect in zip(_clear(judged), named, strict=True):
        own = [i for i, name in enumerate(said[0].names) if name.startswith(f"{effect.label}.")]
        values = np.nan_to_num(judged.named.causes[place].values)
        left, whole = (values @ one.information[np.ix_(own, own)] @ values for one in said)
        result.append(bool(left < WALKLIKE * whole))
    return result


def _judge(
    campaign: Campaign, effects: Sequence[Effect], level: float, noise_degrees: float
) -> Judged:
    families = {name: tuple(family) for name, family in campaign.candidates(effects).items()}
    said, asked = said_of(campaign, families, noise_degrees)
    law = law_of(said, asked, level)
    named = causes(said, asked, law)
    seen = visible(said, [one for one in asked if not one.free])
    sharp = 0.0
    while refined := to_refine(said, named, asked, sharp):
        families |= {name: _finer(families[name], places) for name, places in refined.items()}
        said, asked = said_of(campaign, families, noise_degrees)
        named = causes(said, asked, law)
        if sharp:
            break
        sharp = SHARP
    return Judged(campaign, (), said, asked, families, named, seen)


def _finer(family: Sequence[Effect], places: Sequence[int]) -> tuple[Effect, ...]:
    values = np.array([one.at for one in family], np.float64)
    return tuple(family[0].fixed(float(at)) for at in finer(values, places, FINER))


def _between(effect: Effect) -> bool:
    return effect.scan is None or effect.scan.between


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
    asked = [
        sought(name, *(columns(one) for one in family), between=_between(family[0]))
        for name, family in families.items()
    ]
    for name, waves in free.items():
        axes = np.array([columns(one) for one in waves]).T  # (3, waves)
        asked.append(sought(name, *axes.tolist(), axes.ravel().tolist(), free=True))
    return said, asked

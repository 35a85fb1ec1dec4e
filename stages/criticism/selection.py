"""Selection of the unmodelled effects of one mount from its block means.

Where a variable is scanned the selection is repeated with finer values about its first estimate.

A random walk of a bias may be mistaken for effects, or they for it: a jump, a ramp, any drift. So
the two explanations are compared by their likelihoods, and the random walk is re-estimated given
the named effects. With an effect that a random walk describes as well the data are no more than
consistent, for a random walk follows no law that could be tested.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.campaign.equations import Campaign, evidence
from inertial.estimation.variance_components import MIN_DEVIANCE_DROP
from inertial.model_selection.cause import UNKNOWN_STRUCTURE, Cause, Named
from inertial.model_selection.detection_limits import Visible, visible
from inertial.model_selection.evidence import Evidence, SearchedEffect, searched_effect
from inertial.model_selection.naming import causes, law_of
from inertial.model_selection.search import finer, to_refine
from inertial.physics.effect import Effect
from stages.criticism.bias_drift import (
    barely_detectable_walks,
    drift_name,
    half_waves,
    likely_random_walks,
)

MAX_OCCAM_DEVIANCE = 20.0  # largest penalty of the prior range of sizes
FINER_STEPS = 4  # of the second search in each interval of the first
MIN_THIRD_SEARCH_SNR = 20.0  # from which a third search is finer still
MAX_WALK_SHARE = 0.2  # of the information of an effect that remains with a random walk
SENSORS = ("gyro", "accel")


@dataclass(frozen=True)
class Selection:
    """The named effects of one mount, and the evidence on every effect.

    `campaign`: with the random walks of its equations; `alternatives`: causes that would explain
    about as well what the random walk explains; `searched`: the columns of each effect in
    `evidence`; `families`: its candidates by its name, in the order of
    `SearchedEffect.candidates`; `limits`: the detection limits.
    """

    campaign: Campaign
    alternatives: tuple[str, ...]
    evidence: Evidence
    searched: Sequence[SearchedEffect]
    families: Mapping[str, Sequence[Effect]]
    named: Named
    limits: Sequence[Visible]

    def effect(self, name: str, value: int) -> Effect:
        """A candidate."""
        return self.families[name][value]

    @property
    def effects(self) -> list[Effect]:
        """The named effects; a drift without a law is none."""
        causes = self.named.causes
        return [self.effect(c.effect, c.value) for c in causes if c.effect in self.families]

    @property
    def random_walks(self) -> tuple[float, float]:
        """Random walks of the biases of gyros and accelerometers, rad/s/√s and m/s²/√s."""
        return self.campaign.solution.random_walks

    def without_certain_names(self, sensors: Sequence[str]) -> "Selection":
        """The same with structure in the residuals of these sensors, so no certain name there."""

        def uncertain(cause: Cause) -> Cause:
            inside = self.sensor(cause) in sensors
            return replace(cause, verdict=UNKNOWN_STRUCTURE) if inside else cause

        causes = tuple(uncertain(cause) for cause in self.named.causes)
        return replace(self, named=replace(self.named, causes=causes))

    def sensor(self, cause: Cause) -> str:
        """The sensor that determines a cause best."""
        return self.evidence.labels[self.evidence.sensor_of(cause.columns)]

    def consistent(self) -> dict[str, list[str]]:
        """Of each sensor the causes with which the data are no more than consistent."""
        members: dict[str, list[str]] = {sensor: [] for sensor in SENSORS}
        for cause in self.named.causes:
            if cause.verdict == UNKNOWN_STRUCTURE and cause.effect in self.families:
                members[self.sensor(cause)] += cause.members
        return members

    def deviance(self) -> float:
        """−2 log of the likelihood with the named effects, and the cost of each size.

        The size of an effect is that of its estimate, in its typical sizes: an effect of nine
        parameters has one size, as a random walk has one.
        """
        sizes = [self._size(place) for place in _effects(self)]
        count = len(sizes) + sum(map(bool, self.random_walks))
        return self.campaign.deviance(self.effects, sizes) + MIN_DEVIANCE_DROP * count

    def _size(self, place: int) -> float:
        """How large a named effect is, in its typical sizes."""
        cause = self.named.causes[place]
        effect = self.effect(cause.effect, cause.value)
        typical = np.array([parameter.typical for parameter in effect.parameters])
        return float(np.sqrt(np.mean(np.nan_to_num(np.array(cause.values) / typical) ** 2))) or 1.0


def select_effects(
    campaign: Campaign, effects: Sequence[Effect], level: float, noise_degrees: float
) -> Selection:
    """Name the causes among `effects`; `level`: accepted probability of a false name."""

    def with_walks(walks: tuple[float, float]) -> Selection:
        return _select(campaign.with_random_walks(walks), effects, level, noise_degrees)

    without = with_walks((0.0, 0.0))
    walks = campaign.solution.random_walks
    if not any(walks):
        walks = _replacing_walks(without)
    if not any(walks):
        return without
    selection = _likelier(without, with_walks(walks))
    if selection.effects:
        walks = likely_random_walks(selection.campaign, selection.effects)
        if walks != selection.random_walks:
            selection = (
                replace(with_walks(walks), alternatives=selection.alternatives)
                if any(walks)
                else without
            )
    if not any(selection.random_walks):
        return selection
    named = _members(selection)
    others = tuple(member for member in selection.alternatives if member not in named)
    return _consistent(replace(selection, alternatives=others))


def _likelier(without: Selection, with_walk: Selection) -> Selection:
    """Effects without random walks, or with them, or random walks that may be these effects."""
    if not without.effects:
        return with_walk
    reduction = without.deviance() - with_walk.deviance()
    if reduction < -MIN_DEVIANCE_DROP:
        return without
    if reduction >= MAX_OCCAM_DEVIANCE:
        return with_walk
    return replace(with_walk, alternatives=_members(without))


def _replacing_walks(selection: Selection) -> tuple[float, float]:
    """The most likely random walks in place of effects that resemble them; 0 where none is."""
    campaign, effects = selection.campaign, selection.effects
    resembling = _resembling_walks(
        campaign.with_random_walks(barely_detectable_walks(campaign)), selection
    )
    if not any(resembling):
        return (0.0, 0.0)
    return likely_random_walks(
        campaign, [effect for effect, like in zip(effects, resembling, strict=True) if not like]
    )


def _members(selection: Selection) -> tuple[str, ...]:
    members = [member for cause in selection.named.causes for member in cause.members]
    return tuple(dict.fromkeys(members))


def _consistent(selection: Selection) -> Selection:
    """The same; a cause that a random walk describes as well is consistent with the data only."""
    resembling = dict(
        zip(_effects(selection), _resembling_walks(selection.campaign, selection), strict=True)
    )
    causes = tuple(
        replace(cause, verdict=UNKNOWN_STRUCTURE) if resembling.get(place) else cause
        for place, cause in enumerate(selection.named.causes)
    )
    return replace(selection, named=replace(selection.named, causes=causes))


def _effects(selection: Selection) -> list[int]:
    """Which of the causes are effects of the catalogue, not drifts without a law."""
    causes = selection.named.causes
    return [place for place, cause in enumerate(causes) if cause.effect in selection.families]


def _resembling_walks(with_walk: Campaign, selection: Selection) -> list[bool]:
    """Whether random walks leave little of the information of each named effect."""
    named = selection.effects
    if not named:
        return []
    totals = [
        evidence(campaign, named).total
        for campaign in (with_walk, with_walk.without_random_walks())
    ]
    column = {name: i for i, name in enumerate(totals[0].names)}
    result = []
    for place, effect in zip(_effects(selection), named, strict=True):
        own = [column[name] for name in columns_of(effect) if name in column]
        values = np.nan_to_num(selection.named.causes[place].values)
        remaining, whole = (
            values @ total.information[np.ix_(own, own)] @ values for total in totals
        )
        result.append(bool(remaining < MAX_WALK_SHARE * whole))
    return result


def _select(
    campaign: Campaign, effects: Sequence[Effect], level: float, noise_degrees: float
) -> Selection:
    families = {name: tuple(family) for name, family in campaign.candidates(effects).items()}
    equations, searched = evidence_of(campaign, families, noise_degrees)
    law = law_of(equations, searched, level)
    named = causes(equations, searched, law)
    limits = visible(equations, [effect for effect in searched if not effect.free])
    min_snr = 0.0
    while refined := to_refine(equations, named, searched, min_snr):
        families |= {name: _finer(families[name], places) for name, places in refined.items()}
        equations, searched = evidence_of(campaign, families, noise_degrees)
        named = causes(equations, searched, law)
        if min_snr:
            break
        min_snr = MIN_THIRD_SEARCH_SNR
    return Selection(campaign, (), equations, searched, families, named, limits)


def _finer(family: Sequence[Effect], places: Sequence[int]) -> tuple[Effect, ...]:
    values = np.array([effect.at for effect in family], np.float64)
    return tuple(family[0].fixed(float(at)) for at in finer(values, places, FINER_STEPS))


def columns_of(effect: Effect) -> list[str]:
    """The names of the columns of an effect in the evidence."""
    return [f"{effect.label}.{parameter.name}" for parameter in effect.parameters]


def evidence_of(
    campaign: Campaign, families: Mapping[str, Sequence[Effect]], noise_degrees: float
) -> tuple[Evidence, list[SearchedEffect]]:
    """The evidence on all candidates and on drifts without a law, and the columns of each."""
    drifts = {drift_name(sensor): tuple(half_waves(sensor)) for sensor in SENSORS}
    every = [effect for family in [*families.values(), *drifts.values()] for effect in family]
    equations = evidence(campaign, every, noise_degrees)
    if not equations.sensors:
        return equations, [searched_effect(name) for name in families]
    column = {name: i for i, name in enumerate(equations.names)}

    def columns(effect: Effect) -> list[int]:
        return [column[name] for name in columns_of(effect)]

    searched = []
    for name, family in families.items():
        between = family[0].scan is None or family[0].scan.between
        searched.append(searched_effect(name, *map(columns, family), between=between))
    for name, waves in drifts.items():
        axes = np.array([columns(wave) for wave in waves]).T  # (3, waves)
        searched.append(searched_effect(name, *axes.tolist(), axes.ravel().tolist(), free=True))
    return equations, searched

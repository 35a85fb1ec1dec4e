"""Selection of the unmodelled effects of one mount from its block means.

Where a variable is scanned the selection is repeated with finer values about its first estimate.
The random walk of a bias is estimated again given the named effects, which are weighed against it
and against further jumps, see `rivals`.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.linearisation import about_effects
from inertial.campaign.scatter_given_effects import NAMED_PRIOR_SIZE, scattered
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, Cause, NamedCauses
from inertial.model_selection.detection_limits import visible
from inertial.model_selection.evidence import Evidence, SearchedEffect, searched_effect
from inertial.model_selection.naming import causes, law_of, with_given
from inertial.model_selection.scatter_tests import ScatterTests, named_share, scatter_tests
from inertial.model_selection.search import finer, to_refine
from inertial.physics.effect import LARGE_ANGLE, Effect, TurnedEarthRate, in_sequence
from inertial.sensors import SENSORS
from stages.criticism.bias_drift import (
    biases_of_runs,
    drift_name,
    half_waves,
    likely_random_walks,
    per_log_name,
)
from stages.criticism.rivals import (
    consistent_with_walks,
    members_of,
    replacing_walk,
    weighed,
    with_further_jumps,
    with_rival_walks,
)
from stages.criticism.selection import Selection

FINER_STEPS = 4  # of the second search in each interval of the first
MIN_THIRD_SEARCH_SNR = 20.0  # from which a third search is finer still
UNTHINKABLE_SIGMAS = 3.0  # by which a size is beyond all that is thinkable
MAX_ROUNDS = 3  # of the scatter of positions by hand and the effects
IDENTIFIED = 0.05  # probability of a wrong name for a scatter that has a cause for certain


def select_with_scatter(
    campaign: Campaign,
    effects: Sequence[Effect],
    level: float,
    noise_degrees: float,
    given: Sequence[Effect] = (),
) -> Selection:
    """As `select_effects`, with the scatter of positions by hand, smaller once effects are named.

    A scatter may be all effect: so in each sensor where none is named beside it, that which takes
    most of it away is tested against it. `given`: effects that are named before the search.
    """
    quiet = scattered(campaign, [], noise_degrees)
    selection = first = select_effects(quiet, effects, level, noise_degrees, given)
    if campaign.by_hand is None:
        return first
    fitted = [
        *first.fitted,
        *(instead_of_scatter(first, level) or beyond_motion(first, noise_degrees)),
    ]
    for _round in range(MAX_ROUNDS):
        if not fitted:
            break
        about = about_effects(campaign, fitted, NAMED_PRIOR_SIZE)
        quiet = scattered(about, fitted, noise_degrees)
        selection = select_effects(quiet, effects, level, noise_degrees)
        before, fitted = fitted, selection.fitted
        if [effect.label for effect in fitted] == [effect.label for effect in before]:
            break
    return selection if selection.fitted else first


def instead_of_scatter(
    selection: Selection, level: float, sensors: Collection[str] = SENSORS
) -> list[Effect]:
    """Of each sensor without a name the effect that takes more of its scatter away than by chance.

    Or than a random walk would, which is weighed against it later: so there is none in these
    equations. `level`: accepted probability of a false name.
    """
    named = {selection.sensor(cause) for cause in selection.named.causes}
    scattering = [s for s in selection.campaign.scattering if s in sensors and s not in named]
    if not scattering:
        return []
    equations, searched = selection.evidence, selection.searched
    if any(selection.random_walks):
        constant = selection.campaign.without_random_walks()
        equations, searched = evidence_of(constant, selection.families, np.inf)
    searched = [one for one in searched if one.name in selection.families]
    tests = scatter_tests_of(equations, searched, scattering)
    share = named_share(tests, level) if tests else 0.0
    best = [(one, int(np.argmin(one.p_values))) for one in tests]
    places = [one.places[place] for one, place in best if one.p_values[place] < share]
    return [selection.effect(searched[number].name, value) for number, value in places]


def beyond_motion(selection: Selection, noise_degrees: float) -> list[Effect]:
    """What accounts for a scatter of the specific force that is none of motion at rest.

    |f| depends on no attitude, and no IMU at rest is accelerated by so much: so the accelerometers
    make it, and the question is no longer whether there is an effect, but which. It must leave no
    more than motion can make.
    """
    by_hand = selection.campaign.by_hand
    if by_hand is None or not by_hand.beyond_motion:
        return []
    effects = instead_of_scatter(selection, IDENTIFIED, ["accel"])
    given = scattered(selection.campaign, [*selection.fitted, *effects], noise_degrees).by_hand
    return [] if given is None or given.beyond_motion else effects


def scatter_tests_of(
    equations: Evidence, searched: Sequence[SearchedEffect], sensors: Collection[str]
) -> list[ScatterTests]:
    """The tests of all candidates against the scatter of some sensors."""
    seen = equations.observable()
    assert seen.raw is not None  # as in all evidence of a campaign
    informative = zip(seen.labels, seen.sensors, seen.raw, strict=True)
    tests = (scatter_tests(one, raw, searched) for s, one, raw in informative if s in sensors)
    return [one for one in tests if one is not None]


def select_effects(
    campaign: Campaign,
    effects: Sequence[Effect],
    level: float,
    noise_degrees: float,
    given: Sequence[Effect] = (),
) -> Selection:
    """Name the causes among `effects`; `level`: accepted probability of a false name."""

    def with_walks(walks: tuple[float, float]) -> Selection:
        return _select(campaign.with_random_walks(walks), effects, level, noise_degrees, given)

    selection = without = with_walks((0.0, 0.0))
    for number, walk in enumerate(campaign.solution.random_walks):
        size = walk or replacing_walk(selection, number)
        if size and SENSORS[number] in selection.evidence.labels:  # else it has no equations
            gyro, accel = selection.random_walks
            walks = (size, accel) if number == 0 else (gyro, size)
            selection = weighed(selection, with_walks(walks), number)
    if any(selection.random_walks) and selection.effects:
        likely = likely_random_walks(selection.campaign, selection.fitted)
        gyro, accel = (
            new if old else 0.0 for new, old in zip(likely, selection.random_walks, strict=True)
        )
        if (gyro, accel) != selection.random_walks:
            again = with_walks((gyro, accel)) if gyro or accel else without
            selection = replace(again, alternatives=selection.alternatives, rivals=selection.rivals)
    selection = with_further_jumps(with_rival_walks(selection))
    if not any(selection.random_walks):
        return replace(selection, alternatives=())
    named = members_of(selection)
    others = tuple(member for member in selection.alternatives if member not in named)
    return consistent_with_walks(replace(selection, alternatives=others))


def _select(
    campaign: Campaign,
    effects: Sequence[Effect],
    level: float,
    noise_degrees: float,
    given: Sequence[Effect],
) -> Selection:
    families = {name: tuple(family) for name, family in campaign.candidates(effects).items()}
    equations, rest, searched = _evidence_given(campaign, families, noise_degrees, given)
    law = law_of(rest, searched, level)
    named = causes(rest, searched, law)
    limits = visible(rest, [effect for effect in searched if effect.name in families])
    min_snr = 0.0
    while refined := to_refine(rest, named, searched, min_snr):
        families |= {name: _finer(families[name], places) for name, places in refined.items()}
        equations, rest, searched = _evidence_given(campaign, families, noise_degrees, given)
        named = causes(rest, searched, law)
        if min_snr:
            break
        min_snr = MIN_THIRD_SEARCH_SNR
    for _round in range(MAX_ROUNDS):
        found = _about_what_was_found(named, families)
        there = [families[c.effect][c.value] for c in named.causes if c.effect in families]
        about, campaign = campaign, about_effects(campaign, there, NAMED_PRIOR_SIZE)
        if not found and campaign is about:
            break
        families |= found
        equations, rest, searched = _evidence_given(campaign, families, noise_degrees, given)
        named = causes(rest, searched, law)
    thinkable = _Thinkable(named, rest, searched, families)
    if unthinkable := thinkable.heads_without:
        possible = [effect for effect in effects if effect.name not in unthinkable]
        return _select(campaign, possible, level, noise_degrees, given)
    named = replace(named, causes=tuple(map(thinkable.members_of, named.causes)))
    if given and equations.sensors:
        column = {name: i for i, name in enumerate(equations.names)}
        before = [
            searched_effect(effect.name, [column[name] for name in effect.columns])
            for effect in given
        ]
        named, searched = with_given(equations, named, before), [*searched, *before]
        families |= {effect.name: (effect,) for effect in given}
    return Selection(campaign, (), equations, searched, families, named, limits)


def _about_what_was_found(
    named: NamedCauses, families: Mapping[str, Sequence[Effect]]
) -> dict[str, tuple[Effect, ...]]:
    """The named turns of the earth's rate, about the angle that was found where it is another.

    Equations that are linear about a small one take 1 − cos for other effects.
    """
    turns: list[Effect] = []
    moved = False
    for cause in named.causes:
        effect = families[cause.effect][0] if cause.effect in families else None
        if isinstance(effect, TurnedEarthRate):
            angle = float(cause.values[0])
            moved = moved or abs(angle - (effect.at or 0.0)) > LARGE_ANGLE
            turns.append(effect.about(angle))
    return {turn.name: (turn,) for turn in in_sequence(turns)} if moved else {}


@dataclass(frozen=True)
class _Thinkable:
    """Which members of the named classes would have to be larger than any that is thinkable."""

    named: NamedCauses
    rest: Evidence
    searched: Sequence[SearchedEffect]
    families: Mapping[str, Sequence[Effect]]

    def fits(self, cause: Cause, name: str, value: int) -> bool:
        """Whether a member may be as large as it would have to be."""
        if name not in self.families:
            return True
        effect = self.families[name][value]
        own = next(one for one in self.searched if one.name == name).candidates[value]
        others = (i for other in self.named.causes if other is not cause for i in other.columns)
        values, covariance = self.rest.total.estimate(list(dict.fromkeys([*own, *others])))
        least = np.abs(values) - UNTHINKABLE_SIGMAS * np.sqrt(np.diag(covariance))
        largest = [effect.largest_of(parameter) for parameter in effect.parameters]
        return not bool((least[: len(own)] > largest).any())

    def _fitting(self, cause: Cause) -> list[int]:
        pairs = zip(cause.members, cause.member_values, strict=True)
        return [i for i, (name, value) in enumerate(pairs) if self.fits(cause, name, value)]

    @property
    def heads_without(self) -> set[str]:
        """Causes that do not fit, where another member does."""
        fitting = [
            (one.effect, [one.members[i] for i in self._fitting(one)]) for one in self.named.causes
        ]
        return {head for head, members in fitting if members and head not in members}

    def members_of(self, cause: Cause) -> Cause:
        """The cause with the members that fit."""
        kept = self._fitting(cause)
        if not kept or len(kept) == len(cause.members):
            return cause
        weights = np.array([cause.weights[i] for i in kept])
        return replace(
            cause,
            verdict=FOUND if len(kept) == 1 and cause.verdict == ONE_OF_CLASS else cause.verdict,
            members=tuple(cause.members[i] for i in kept),
            member_values=tuple(cause.member_values[i] for i in kept),
            weights=tuple((weights / weights.sum()).tolist()),
            captured=tuple(cause.captured[i] for i in kept),
        )


def _evidence_given(
    campaign: Campaign,
    families: Mapping[str, Sequence[Effect]],
    noise_degrees: float,
    given: Sequence[Effect],
) -> tuple[Evidence, Evidence, list[SearchedEffect]]:
    """The evidence on all candidates and on effects that are given; and that given these."""
    equations, searched = evidence_of(campaign, families, noise_degrees, given)
    column = {name: i for i, name in enumerate(equations.names)}
    own = [column[name] for effect in given for name in effect.columns if name in column]
    return equations, equations.given(own), searched


def _finer(family: Sequence[Effect], places: Sequence[int]) -> tuple[Effect, ...]:
    values = np.array([effect.at for effect in family], np.float64)
    return tuple(family[0].at_each(finer(values, places, FINER_STEPS)))


def evidence_of(
    campaign: Campaign,
    families: Mapping[str, Sequence[Effect]],
    noise_degrees: float,
    given: Sequence[Effect] = (),
) -> tuple[Evidence, list[SearchedEffect]]:
    """The evidence on all candidates, and the columns of each; on effects that are `given`, too.

    Besides those of the catalogue these are drifts without a law, and the biases of all runs of
    the instrument where there are several.
    """
    drifts = {drift_name(sensor): tuple(half_waves(sensor)) for sensor in SENSORS}
    of_runs = {
        per_log_name(sensor): biases_of_runs(sensor, campaign.motion)
        for sensor in SENSORS
        if campaign.recorded
    }
    every = [
        effect
        for family in [*families.values(), *drifts.values(), *of_runs.values()]
        for effect in family
    ]
    equations = evidence(campaign, [*every, *given], noise_degrees)
    if not equations.sensors:
        return equations, [searched_effect(name) for name in families]
    column = {name: i for i, name in enumerate(equations.names)}

    def columns(effect: Effect) -> list[int]:
        return [column[name] for name in effect.columns]

    searched = []
    for name, family in families.items():
        first = family[0]
        between = first.scan is None or first.scan.between
        searched.append(
            searched_effect(
                name,
                *map(columns, family),
                between=between,
                only=first.only,
                positive=first.positive,
            )
        )
    for name, waves in drifts.items():
        axes = np.array([columns(wave) for wave in waves]).T  # (3, waves)
        searched.append(searched_effect(name, *axes.tolist(), axes.ravel().tolist(), free=True))
    for name, runs in of_runs.items():
        if runs:
            every_run = [column for run in runs for column in columns(run)]
            searched.append(searched_effect(name, every_run, between=False))
    return equations, searched

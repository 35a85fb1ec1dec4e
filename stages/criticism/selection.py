"""Selection of the unmodelled effects of one mount from its block means.

Where a variable is scanned the selection is repeated with finer values about its first estimate.

A random walk of a bias may be mistaken for effects, or they for it: a jump, a ramp, any drift. So
the two explanations are compared by their likelihoods, and the random walk is re-estimated given
the named effects. With an effect that a random walk describes as well the data are no more than
consistent, for a random walk follows no law that could be tested.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.scatter_of_positions import scattered
from inertial.effects import TEMPERATURE_MODELS
from inertial.model_selection import walk_odds
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, UNKNOWN_STRUCTURE, Cause, Named
from inertial.model_selection.detection_limits import Visible, visible
from inertial.model_selection.evidence import Evidence, SearchedEffect, searched_effect
from inertial.model_selection.naming import causes, law_of, with_given
from inertial.model_selection.scatter_tests import ScatterTests, named_share, scatter_tests
from inertial.model_selection.search import finer, to_refine
from inertial.physics.effect import Array, Effect
from stages.criticism.bias_drift import (
    biases_of_runs,
    drift_name,
    half_waves,
    likely_random_walk,
    likely_random_walks,
    per_log_name,
    walk_evidence,
)

MAX_LOG_ODDS = 3.0  # of a law and a random walk that are as likely
FINER_STEPS = 4  # of the second search in each interval of the first
MIN_THIRD_SEARCH_SNR = 20.0  # from which a third search is finer still
MAX_WALK_SHARE = 0.2  # of the information of an effect that remains with a random walk
MIN_TEMPERATURE_SNR = 8.0  # beside a random walk, of functions of temperature that are certain
SENSORS = ("gyro", "accel")
MAX_ROUNDS = 3  # of the scatter of positions by hand and the effects


@dataclass(frozen=True)
class Selection:
    """The named effects of one mount, and the evidence on every effect.

    `campaign`: with the random walks of its equations; `alternatives`: causes that would explain
    about as well what the random walk explains; `searched`: the columns of each effect in
    `evidence`; `families`: its candidates by its name, in the order of
    `SearchedEffect.candidates`; `limits`: the detection limits;
    `rivals`: by effect the random walk that is as likely, and the log odds of the effect;
    `of_structure`: by effect of both sensors that is not significant without the sensor whose
    residuals have a structure, that sensor.
    """

    campaign: Campaign
    alternatives: tuple[str, ...]
    evidence: Evidence
    searched: Sequence[SearchedEffect]
    families: Mapping[str, Sequence[Effect]]
    named: Named
    limits: Sequence[Visible]
    rivals: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    of_structure: Mapping[str, str] = field(default_factory=dict)

    def prior(self, effect: SearchedEffect) -> Array:
        """The share of each value of a scan: that of its range which is nearest to it."""
        count = len(effect.candidates)
        if count == 1 or effect.free or not effect.between:
            return np.ones(count)
        return np.gradient(np.array([one.at for one in self.families[effect.name]], np.float64))

    def equations_without(self, effects: Collection[str]) -> walk_odds.Equations:
        """The evidence given all named effects but some."""
        total = self.evidence.observable().total
        given = [c.columns for c in self.named.causes if c.effect not in effects]
        equations = walk_odds.Equations(total.information, total.right)
        return equations.given(list(dict.fromkeys(i for columns in given for i in columns)))

    def half_waves(self, sensor: str) -> Sequence[Sequence[int]]:
        """The columns of the half waves of each axis."""
        drift = next(each for each in self.searched if each.name == drift_name(sensor))
        return drift.candidates[: walk_odds.AXES]

    def explained(self, effects: Collection[str], first: walk_odds.Explained) -> float:
        """The log evidence of some effects after something else is explained, and of that."""
        evidence, rest = first.log_evidence, first.rest
        for searched in self.searched:
            if searched.name in effects:
                law = walk_odds.law(rest, searched.candidates, self.prior(searched))
                evidence, rest = evidence + law.log_evidence, law.rest
        return evidence

    def effect(self, name: str, value: int) -> Effect:
        """A candidate."""
        return self.families[name][value]

    @property
    def effects(self) -> list[Effect]:
        """The named effects of the catalogue."""
        causes = self.named.causes
        return [self.effect(c.effect, c.value) for c in causes if c.effect in self.families]

    @property
    def fitted(self) -> list[Effect]:
        """These, and the biases of each run where they are named."""
        named = {cause.effect for cause in self.named.causes}
        own = [sensor for sensor in SENSORS if per_log_name(sensor) in named]
        runs = [run for sensor in own for run in biases_of_runs(sensor, self.campaign.motion)]
        return [*self.effects, *runs]

    @property
    def random_walks(self) -> tuple[float, float]:
        """Random walks of the biases of gyros and accelerometers, rad/s/√s and m/s²/√s."""
        return self.campaign.solution.random_walks

    def without_certain_names(self, sensors: Sequence[str]) -> "Selection":
        """The same with structure in the residuals of these sensors, so no certain name there.

        Nor of an effect of both sensors that would not be named without their readings.
        """
        if not sensors:
            return self
        of_structure = dict(self.of_structure)
        for cause in self.named.causes:
            drops = self._drops(cause)
            own = {sensor: drops.pop(sensor) for sensor in sensors}
            seen = max(own.values()) > 0 and self.sensor(cause) not in own
            if seen and sum(drops.values()) < cause.threshold:
                of_structure[cause.effect] = max(own, key=own.__getitem__)
        moved = replace(self, of_structure=of_structure)
        causes = tuple(
            replace(cause, verdict=UNKNOWN_STRUCTURE) if moved.sensor(cause) in sensors else cause
            for cause in self.named.causes
        )
        return replace(moved, named=replace(self.named, causes=causes))

    def _drops(self, cause: Cause) -> dict[str, float]:
        """The reduction of χ² by a cause in each sensor whose readings it changes, else 0.

        Given the other causes, and in units of the noise that the search found.
        """
        others = [i for c in self.named.causes if c is not cause for i in c.columns]
        evidence = self.evidence.given(list(dict.fromkeys(others)))
        if self.named.excesses:
            evidence = evidence.scaled(self.named.excesses)
        raw = evidence.raw
        acts = [
            raw is None or bool((raw[number, list(cause.columns)] > 0).any())
            for number in range(len(evidence.sensors))
        ]
        drops = [sensor.drop(cause.columns)[0] for sensor in evidence.sensors]
        return dict(zip(evidence.labels, np.where(acts, drops, 0.0).tolist(), strict=True))

    def sensor(self, cause: Cause) -> str:
        """The sensor that determines a cause best, or whose structure it resembles."""
        best = self.evidence.labels[self.evidence.sensor_of(cause.columns)]
        return self.of_structure.get(cause.effect, best)

    def consistent(self) -> dict[str, list[str]]:
        """Of each sensor the causes with which the data are no more than consistent."""
        members: dict[str, list[str]] = {sensor: [] for sensor in SENSORS}
        for cause in self.named.causes:
            if cause.verdict == UNKNOWN_STRUCTURE and cause.effect in self.families:
                members[self.sensor(cause)] += cause.members
        return members


def select_with_scatter(
    campaign: Campaign,
    effects: Sequence[Effect],
    level: float,
    noise_degrees: float,
    given: Sequence[Effect] = (),
) -> Selection:
    """The same with the scatter of positions by hand, which is smaller once effects are named.

    A scatter may be all effect: so in each sensor where none is named beside it, that which takes
    most of it away is tested against it. `given`: effects that are named before the search.
    """
    quiet = scattered(campaign, [], noise_degrees)
    selection = first = select_effects(quiet, effects, level, noise_degrees, given)
    if campaign.by_hand is None:
        return first
    fitted = [*first.fitted, *instead_of_scatter(first, level)]
    for _round in range(MAX_ROUNDS):
        if not fitted:
            break
        quiet = scattered(campaign, fitted, noise_degrees)
        selection = select_effects(quiet, effects, level, noise_degrees)
        before, fitted = fitted, selection.fitted
        if [effect.label for effect in fitted] == [effect.label for effect in before]:
            break
    return selection if selection.fitted else first


def instead_of_scatter(selection: Selection, level: float) -> list[Effect]:
    """Of each sensor without a name the effect that takes more of its scatter away than by chance.

    Or than a random walk would, which is weighed against it later: so there is none in these
    equations. `level`: accepted probability of a false name.
    """
    named = {selection.sensor(cause) for cause in selection.named.causes}
    scattering = [s for s in selection.campaign.scattering if s not in named]
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
        size = walk or _replacing_walk(selection, number)
        if size and SENSORS[number] in selection.evidence.labels:  # else it has no equations
            walks = _replaced(selection.random_walks, number, size)
            selection = _weighed(selection, with_walks(walks), number)
    if any(selection.random_walks) and selection.effects:
        likely = likely_random_walks(selection.campaign, selection.fitted)
        gyro, accel = (
            new if old else 0.0 for new, old in zip(likely, selection.random_walks, strict=True)
        )
        if (gyro, accel) != selection.random_walks:
            again = with_walks((gyro, accel)) if gyro or accel else without
            selection = replace(again, alternatives=selection.alternatives, rivals=selection.rivals)
    selection = _with_further_jumps(_with_rivals(selection))
    if not any(selection.random_walks):
        return replace(selection, alternatives=())
    named = _members(selection)
    others = tuple(member for member in selection.alternatives if member not in named)
    return _consistent(replace(selection, alternatives=others))


def _replaced(walks: tuple[float, float], number: int, size: float) -> tuple[float, float]:
    """The random walks with that of one sensor replaced."""
    return (size, walks[1]) if number == 0 else (walks[0], size)


def _weighed(law: Selection, walk: Selection, number: int) -> Selection:
    """The likelier of effects without and with a random walk of one sensor, or both as a class.

    Where they are alike a single effect keeps its name and the random walk joins its class; of
    several effects the random walk is the simpler, and they are what it may be instead. One that
    stands for no effect must be clearly likelier than none.
    """
    walk = replace(walk, alternatives=law.alternatives, rivals=law.rivals)
    odds = _log_odds(law, walk, SENSORS[number])
    kept = {cause.effect for cause in walk.named.causes}
    only = [cause for cause in law.named.causes if cause.effect not in kept]
    if drift_name(SENSORS[number]) in {cause.effect for cause in only}:
        return walk  # a drift without a law has none that could be weighed
    if odds > (MAX_LOG_ODDS if only else -MAX_LOG_ODDS):
        return law
    if odds < -MAX_LOG_ODDS:
        return walk
    if odds > 0 and len(only) == 1:
        return replace(law, rivals={**law.rivals, only[0].effect: (walk_name(number), odds)})
    members = [member for cause in only for member in cause.members]
    return replace(walk, alternatives=tuple(dict.fromkeys([*law.alternatives, *members])))


def walk_name(number: int) -> str:
    """The name of the random walk of a sensor, gyros 0, accelerometers 1."""
    return f"{SENSORS[number]}_random_walk"


def _log_odds(law: Selection, walk: Selection, sensor: str) -> float:
    """Of the effects without a random walk of a sensor against those with it."""
    kept = {cause.effect for cause in walk.named.causes}
    only = [cause.effect for cause in law.named.causes if cause.effect not in kept]
    others = {cause.effect for cause in law.named.causes}
    beside = [cause.effect for cause in walk.named.causes if cause.effect not in others]
    start = law.equations_without(only)
    walking = walk_odds.walk(start, law.half_waves(sensor))
    # Of all its waves: without the fast ones the evidence against a walk would be incomplete.
    known = [effect for effect in law.fitted if effect.name not in only]
    walking = replace(walking, log_evidence=walk_evidence(law.campaign, sensor, known))
    nothing = walk_odds.Explained(0.0, start)
    # A walk is as likely beforehand as any one effect: each further cause is penalised for having
    # been chosen.
    further = (len(only) - len(beside) - 1) * float(np.log(len(law.families)))
    return law.explained(only, nothing) - law.explained(beside, walking) - max(further, 0.0)


def _with_rivals(selection: Selection) -> Selection:
    """The same with each random walk in the class of the effect that is as likely."""
    causes = tuple(
        _or(cause, *selection.rivals[cause.effect]) if cause.effect in selection.rivals else cause
        for cause in selection.named.causes
    )
    return replace(selection, named=replace(selection.named, causes=causes))


def _or(cause: Cause, rival: str, odds: float) -> Cause:
    """A cause with another one in its class, against which it has these log odds."""
    share = 1 / (1 + float(np.exp(odds)))
    return replace(
        cause,
        verdict=ONE_OF_CLASS if cause.verdict == FOUND else cause.verdict,
        members=(*cause.members, rival),
        weights=(*(weight * (1 - share) for weight in cause.weights), share),
        captured=(*cause.captured, 1.0),
    )


def _with_further_jumps(selection: Selection) -> Selection:
    """The same; what a further jump of a bias that jumped explains as well may be one.

    The search has one jump for each sensor, so a second one would be taken for any effect that
    resembles it. Where it is clearly likelier, the bias jumps without a law: then no other effect
    of that sensor is certain.
    """
    jumps = {sensor: f"{sensor}_bias_jump" for sensor in SENSORS}
    named = {cause.effect for cause in selection.named.causes}
    causes, without_a_law = [], set()
    for cause in selection.named.causes:
        sensor = selection.sensor(cause)
        jump = jumps[sensor]
        if jump in named and jump not in cause.members and cause.effect in selection.families:
            start = walk_odds.Explained(0.0, selection.equations_without([cause.effect]))
            odds = selection.explained([cause.effect], start) - selection.explained([jump], start)
            if odds < -MAX_LOG_ODDS:
                without_a_law.add(sensor)
            elif odds < MAX_LOG_ODDS:
                cause = _or(cause, jump, odds)
        causes.append(cause)
    kept = tuple(
        replace(cause, verdict=UNKNOWN_STRUCTURE)
        if selection.sensor(cause) in without_a_law and cause.effect not in jumps.values()
        else cause
        for cause in causes
    )
    return replace(selection, named=replace(selection.named, causes=kept))


def _replacing_walk(selection: Selection, number: int) -> float:
    """The most likely random walk of a sensor in place of effects that it explains as well.

    These may be one of the named effects of the sensor or all of them; 0: none.
    """
    sensor = SENSORS[number]
    own = [c.effect for c in selection.named.causes if selection.sensor(c) == sensor]
    for replaced in [[effect] for effect in own] + [own] * (len(own) > 1):
        start = selection.equations_without(replaced)
        walking = walk_odds.walk(start, selection.half_waves(sensor)).log_evidence
        law = selection.explained(replaced, walk_odds.Explained(0.0, start))
        if law - walking < MAX_LOG_ODDS:
            others = [effect for effect in selection.effects if effect.name not in replaced]
            if size := likely_random_walk(selection.campaign, sensor, others):
                return size
    return 0.0


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
        own = [column[name] for name in effect.columns if name in column]
        values = np.nan_to_num(selection.named.causes[place].values)
        remaining, whole = (
            values @ total.information[np.ix_(own, own)] @ values for total in totals
        )
        # A walk that follows a measured temperature by chance leaves nothing of its functions.
        most = MIN_TEMPERATURE_SNR**2 if effect.name in TEMPERATURE_MODELS else np.inf
        result.append(bool(remaining < min(MAX_WALK_SHARE * float(whole), most)))
    return result


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
    if given and equations.sensors:
        column = {name: i for i, name in enumerate(equations.names)}
        before = [
            searched_effect(effect.name, [column[name] for name in effect.columns])
            for effect in given
        ]
        named, searched = with_given(equations, named, before), [*searched, *before]
        families |= {effect.name: (effect,) for effect in given}
    return Selection(campaign, (), equations, searched, families, named, limits)


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
    return tuple(family[0].fixed(float(at)) for at in finer(values, places, FINER_STEPS))


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

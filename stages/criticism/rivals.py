"""What else may be behind a named effect: a random walk of the biases, or further jumps of one.

A random walk of a bias may be mistaken for effects, or they for it: a jump, a ramp, any drift. So
the two explanations are compared by their likelihoods. With an effect that a random walk describes
as well the data are no more than consistent, for a random walk follows no law that could be tested.
So it is with an effect that further jumps of a bias describe as well, where one jump is named.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.effects import CATALOGUE, TEMPERATURE_MODELS
from inertial.estimation.probability import chi2_sf
from inertial.model_selection import walk_odds
from inertial.model_selection.cause import FOUND, LAW, ONE_OF_CLASS, UNKNOWN_STRUCTURE, Cause
from inertial.physics.effect import Effect
from inertial.sensors import PLURAL, SENSORS
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import p_is
from stages.criticism.bias_drift import drift_name, likely_random_walk, walk_evidence
from stages.criticism.finding_rows import TableRow, finding_id, finding_row, member_rows, snr_of
from stages.criticism.residual_structure import (
    ACTION_IF_CARRIED,
    CAUSE,
    PRIOR_SIGMA,
    Tested,
    consequence,
    moved_by,
)
from stages.criticism.selection import OffManoeuvre, Selection, walk_name

MAX_LOG_ODDS = 3.0  # of two explanations that are as likely
MIN_SURE_LOG_ODDS = 5.3  # of an effect against a walk that is then in no class with it: 1/0.005
MAX_FURTHER_JUMPS = 6  # of a bias: two of them look like any effect of one manoeuvre
MAX_WALK_SHARE = 0.2  # of the information of an effect that remains with a random walk
MIN_TEMPERATURE_SNR = 8.0  # beside a random walk, of functions of temperature that are certain


def weighed(law: Selection, walk: Selection, number: int) -> Selection:
    """The likelier of effects without and with a random walk of one sensor, or both as a class.

    A single effect that is not surely likelier keeps its name, and the random walk joins its class:
    of walks some are nearly straight. Of several effects the random walk is the simpler where they
    are alike, and they are what it may be instead. One that stands for no effect must be clearly
    likelier than none.
    """
    walk = replace(walk, alternatives=law.alternatives, rivals=law.rivals)
    odds = _log_odds(law, walk, SENSORS[number])
    kept = {cause.effect for cause in walk.named.causes}
    only = [cause for cause in law.named.causes if cause.effect not in kept]
    if drift_name(SENSORS[number]) in {cause.effect for cause in only}:
        return walk  # a drift without a law has none that could be weighed
    sure = MIN_SURE_LOG_ODDS if len(only) == 1 else MAX_LOG_ODDS
    if odds > (sure if only else -MAX_LOG_ODDS):
        return law
    if odds < -MAX_LOG_ODDS:
        return walk
    if odds > 0 and len(only) == 1:
        return replace(law, rivals={**law.rivals, only[0].effect: (walk_name(number), odds)})
    members = [member for cause in only for member in cause.members]
    return replace(walk, alternatives=tuple(dict.fromkeys([*law.alternatives, *members])))


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
    nothing = walk_odds.WeighedExplanation(0.0, start)
    # A walk is as likely beforehand as any one effect: each further cause is penalised for having
    # been chosen.
    further = (len(only) - len(beside) - 1) * float(np.log(len(law.families)))
    return law.explained(only, nothing) - law.explained(beside, walking) - max(further, 0.0)


def with_rival_walks(selection: Selection) -> Selection:
    """The same with each random walk in the class of the effect that is as likely."""

    def joined(cause: Cause) -> Cause:
        if cause.effect not in selection.rivals:
            return cause
        walk, odds = selection.rivals[cause.effect]
        share = 1 / (1 + float(np.exp(odds)))
        return replace(
            cause,
            verdict=ONE_OF_CLASS if cause.verdict == FOUND else cause.verdict,
            members=(*cause.members, walk),
            weights=(*(weight * (1 - share) for weight in cause.weights), share),
            captured=(*cause.captured, 1.0),
        )

    causes = tuple(joined(cause) for cause in selection.named.causes)
    return replace(selection, named=replace(selection.named, causes=causes))


def with_further_jumps(selection: Selection) -> Selection:
    """The same; what further jumps of a bias that jumped explain as well is not certain.

    The search has one jump for each sensor, so others would be taken for any effect that resembles
    them, or what they leave at other times than those of the scan. They are in no class, for no
    model has a second one.
    """
    named = {cause.effect for cause in selection.named.causes}
    jumping = {sensor: f"{sensor}_bias_jump" for sensor in SENSORS}
    jumping = {sensor: jump for sensor, jump in jumping.items() if jump in named}
    doubtful: set[str] = set()
    found = -1
    while len(doubtful) > found:  # what stood for a jump hides it no longer
        found = len(doubtful)
        for cause in selection.named.causes:
            jump = jumping.get(selection.sensor(cause))
            if jump is None or jump in cause.members or cause.effect not in CATALOGUE:
                continue
            if cause.effect not in doubtful:
                rest = selection.equations_without({*doubtful, cause.effect})
                effect = selection.explained(
                    [cause.effect], walk_odds.WeighedExplanation(0.0, rest)
                )
                if effect - _log_evidence_of_jumps(selection, jump, rest) < MAX_LOG_ODDS:
                    doubtful.add(cause.effect)
    causes = tuple(
        replace(cause, verdict=UNKNOWN_STRUCTURE) if cause.effect in doubtful else cause
        for cause in selection.named.causes
    )
    return replace(selection, named=replace(selection.named, causes=causes))


def _log_evidence_of_jumps(selection: Selection, jump: str, rest: walk_odds.Equations) -> float:
    """Of as many further jumps as are likeliest, each given those before."""
    searched = selection.search_of(jump)
    whole = np.diag(selection.evidence.observable().total.information)
    evidence = best = 0.0
    for _unused in range(MAX_FURTHER_JUMPS):
        # Not of one that is there.
        remains = np.diag(rest.information) > walk_odds.MIN_INFORMATION * whole
        new = [i for i, one in enumerate(searched.candidates) if remains[list(one)].all()]
        if not new:
            break
        candidates = [searched.candidates[i] for i in new]
        law = walk_odds.law(rest, candidates, selection.prior(searched)[new])
        evidence, rest = evidence + law.log_evidence, law.rest
        best = max(best, evidence)
    return best


def replacing_walk(selection: Selection, number: int) -> float:
    """The most likely random walk of a sensor in place of effects that it explains as well.

    These may be one of the named effects of the sensor or all of them; 0: none.
    """
    sensor = SENSORS[number]
    own = [c.effect for c in selection.named.causes if selection.sensor(c) == sensor]
    for replaced in [[effect] for effect in own] + [own] * (len(own) > 1):
        start = selection.equations_without(replaced)
        walking = walk_odds.walk(start, selection.half_waves(sensor)).log_evidence
        law = selection.explained(replaced, walk_odds.WeighedExplanation(0.0, start))
        if law - walking < MAX_LOG_ODDS:
            others = [effect for effect in selection.effects if effect.name not in replaced]
            if size := likely_random_walk(selection.campaign, sensor, others):
                return size
    return 0.0


def members_of(selection: Selection) -> tuple[str, ...]:
    members = [member for cause in selection.named.causes for member in cause.members]
    return tuple(dict.fromkeys(members))


def consistent_with_walks(selection: Selection) -> Selection:
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


# ---- Whether several effects are what a single manoeuvre alone shows.
#
# A manoeuvre in which something else happened, as a knock against the table or a cable that pulls,
# is described by several effects at once: a jump and another one back, a shift and a slip. Effects
# of a sensor, a mounting or a site are in more than one manoeuvre. So where without one of them no
# effect is significant, nor named, and no structure is left, that manoeuvre is off by a cause
# without a name.

LEAST_EFFECTS = 2  # of one sensor: a single one may be the own error of that manoeuvre
MIN_CHANCE = 0.01  # of the effects in the other manoeuvres by noise alone
MIN_INFORMATION = 1e-6  # of what an effect does to the readings, that the parameters leave
MAX_CHANCE = 0.001  # of the same in all manoeuvres, in a sensor that shows them
OFF = _(
    "The readings of the {sensors} in {manoeuvre} differ from those in all others ({p_value}): "
    "only several effects at once would explain them, {effects}, and without {manoeuvre} none of "
    "these is there."
)

Selected = tuple[Selection, Tested]


def select_beside_one_manoeuvre(
    found: Selected,
    campaign: Campaign,
    select: Callable[[Campaign], Selected],
    without: Callable[[Campaign, str], Campaign],
    tests: Callable[[Campaign], Tested],
) -> Selected:
    """The selection and its tests; without effects where one manoeuvre alone carries several.

    Parameters
    ----------
    found : what is selected of the campaign
    select : of a campaign the effects, and the tests of its residuals
    without : a campaign without a manoeuvre
    tests : of the residuals of a campaign without effects
    """
    selection, _ = found
    named = [cause for cause in selection.named.causes if cause.verdict != LAW]
    of_sensors = Counter(selection.sensor(cause) for cause in named)
    if max(of_sensors.values(), default=0) < LEAST_EFFECTS:
        return found
    effects = selection.effects
    every = set(campaign.manoeuvres)
    chances = {m: _least_chance(_drops(campaign, effects, every - {m})) for m in sorted(every)}
    carrier = max(chances, key=chances.__getitem__)
    if chances[carrier] < MIN_CHANCE:
        return found
    other, other_tested = select(without(campaign, carrier))
    if other.named.causes or other_tested.detected:
        return found
    whole = campaign.with_random_walks(other.campaign.solution.random_walks)
    drops = _drops(whole, effects, every).items()
    shown = {sensor: drop for sensor, drop in drops if chi2_sf(*drop) < MAX_CHANCE}
    if not shown:
        return found
    off = OffManoeuvre(carrier, shown, members_of(selection))
    return replace(other, campaign=whole, off=off), tests(whole)


def _least_chance(drops: Mapping[str, tuple[float, int]]) -> float:
    """That noise alone explains as much, in the sensor where it does so least."""
    return min((float(chi2_sf(*drop)) for drop in drops.values()), default=1.0)


def _drops(
    campaign: Campaign, effects: Sequence[Effect], only: set[str]
) -> dict[str, tuple[float, int]]:
    """The reduction of χ² by effects in some manoeuvres, and its degrees, by sensor."""
    drops = {}
    for sensor in SENSORS:
        if (system := campaign.system(sensor, effects, PRIOR_SIGMA, only)) is not None:
            rest, columns, raw = system.projected(0)
            columns = columns[:, np.sum(columns**2, axis=0) > MIN_INFORMATION * raw]
            fitted, _, rank, _ = np.linalg.lstsq(columns, rest)
            if rank:
                drops[sensor] = (float(rest @ (columns @ fitted)), int(rank))
    return drops


def carrier_of_excess(campaign: Campaign, sensor: str, effects: Sequence[Effect]) -> str | None:
    """The only manoeuvre without which the residuals of a sensor are no larger than noise."""
    every = set(campaign.manoeuvres_of(sensor))
    chances = dict.fromkeys(sorted(every), 0.0)
    for name in chances:
        others = set(campaign.manoeuvres) - {name}
        if (system := campaign.system(sensor, effects, PRIOR_SIGMA, others)) is not None:
            rest = system.solve_shared()
            chances[name] = float(chi2_sf(rest.chi_squared, max(rest.degrees, 1)))
    carriers = [name for name, chance in chances.items() if chance > MIN_CHANCE]
    return carriers[0] if len(carriers) == 1 else None


def off_rows(selection: Selection, tested: Tested, mount: str) -> Iterator[TableRow]:
    """The finding of each sensor that a manoeuvre is off, where no structure says so."""
    off = selection.off
    if off is None:
        return
    for sensor, (drop, degrees) in off.drops.items():
        if tested.of(sensor):
            continue
        chance = float(chi2_sf(drop, degrees))
        names = listed([in_words(name) for name in off.members])
        identifier = finding_id(f"{CAUSE}/{sensor}", mount)
        moves = moved_by(selection.campaign, sensor, [off.manoeuvre])
        yield finding_row(
            CAUSE,
            mount,
            id=identifier,
            sensor=sensor,
            size=drop**0.5,
            unit="sigma",
            p_value=chance,
            sentence=OFF.format(
                sensors=PLURAL[sensor],
                manoeuvre=off.manoeuvre,
                p_value=p_is(chance),
                effects=names,
            ),
            consequence=consequence([off.manoeuvre], moves),
            action=ACTION_IF_CARRIED.format(manoeuvres=off.manoeuvre),
            verdict=UNKNOWN_STRUCTURE,
            statistic=drop,
            degrees=degrees,
            snr=snr_of(drop, degrees),
            moves=moves,
        )
        yield from member_rows(identifier, mount, off.members)
        row = {"finding": identifier, "mount": mount, "rank": 1, "manoeuvre": off.manoeuvre}
        yield "structure_manoeuvres", row

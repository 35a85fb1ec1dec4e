"""Naming of the causes, each with the effects that are indistinguishable from it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from inertial.estimation.probability import chi2_sf
from inertial.model_selection import null_simulation
from inertial.model_selection.cause import (
    FOUND,
    ONE_OF_CLASS,
    UNKNOWN_STRUCTURE,
    Cause,
    EffectTest,
    NamedCauses,
)
from inertial.model_selection.effect_classes import EffectClass, effect_class, with_rivals
from inertial.model_selection.evidence import Evidence, SearchedEffect
from inertial.model_selection.null_simulation import Chance
from inertial.model_selection.search import Candidates, Search

MIN_FREE_ADVANTAGE = 12.0  # of chi-squared, of a drift without a law over the catalogue
MAX_ROUNDS = 3  # of the excess of the residuals and the selection in turn


def law_of(evidence: Evidence, effects: Sequence[SearchedEffect], level: float) -> Chance | None:
    """The null distributions of this campaign; None where it has no equations."""
    if not evidence.sensors:
        return None
    return null_simulation.chance(evidence.observable().total.information, effects, level)


def causes(
    evidence: Evidence, effects: Sequence[SearchedEffect], law: Chance | None
) -> NamedCauses:
    """Name the causes.

    Where the residuals of a sensor exceed the noise also with the named effects, something else
    is wrong: there an effect must be significant against the residuals, not the noise, else any
    effect would be named that happens to resemble the unexplained part.

    Parameters
    ----------
    law : the null distributions; those of the coarse scans serve for refined ones too
    """
    if law is None:
        return NamedCauses((), tuple(EffectTest(e.name, 0, 0.0, 0, 1.0, 1.0) for e in effects), ())
    evidence = evidence.observable()
    candidates = Candidates(effects)
    excesses: tuple[tuple[float, float], ...] = tuple(
        (1.0, evidence.noise_degrees_of(i)) for i in range(len(evidence.sensors))
    )
    scaled = evidence
    for _ in range(MAX_ROUNDS):
        classes = _classes(scaled, candidates, law)
        updated = evidence.excesses(candidates.around([group.place for group in classes]))
        if all(new[0] <= old[0] * 1.01 for new, old in zip(updated, excesses, strict=True)):
            break
        excesses = tuple(max(pair) for pair in zip(updated, excesses, strict=True))
        scaled = evidence.scaled(excesses)
    else:
        classes = _classes(scaled, candidates, law)
    noise_degrees = _noise_degrees(scaled, candidates)
    named = [_cause(scaled, candidates, law, noise_degrees, group, classes) for group in classes]
    return NamedCauses(
        _uncertain_given_drift(scaled, named),
        _tests(scaled, candidates, law, noise_degrees, classes),
        excesses,
    )


def with_given(
    evidence: Evidence, named: NamedCauses, given: Sequence[SearchedEffect]
) -> NamedCauses:
    """The causes with effects that were named before the search, each by its only candidate."""
    total = evidence.total
    every = [*(c.columns for c in named.causes), *(effect.candidates[0] for effect in given)]
    causes, tests = [*named.causes], [*named.tests]
    for effect in given:
        columns = effect.candidates[0]
        joint = list(dict.fromkeys([*columns, *(i for one in every for i in one)]))
        values, covariance = total.estimate(joint)
        whole, used = total.drop(joint)
        rest, fewer = total.drop(joint[len(columns) :]) if len(joint) > len(columns) else (0.0, 0)
        drop, degrees = whole - rest, used - fewer
        p_value = float(chi2_sf(drop, degrees)) if degrees else 1.0
        own = slice(0, len(columns))
        causes.append(
            Cause(
                effect=effect.name,
                value=0,
                verdict=FOUND,
                members=(effect.name,),
                member_values=(0,),
                weights=(1.0,),
                captured=(1.0,),
                statistic=drop,
                degrees=degrees,
                p_value=p_value,
                snr=float(np.sqrt(max(drop - degrees, 0.0))),
                columns=columns,
                values=values[own],
                covariance=covariance[own, own],
            )
        )
        tests.append(EffectTest(effect.name, 0, drop, degrees, p_value, p_value))
    return replace(
        named,
        causes=_uncertain_given_drift(evidence, causes),
        tests=tuple(tests),
    )


def _uncertain_given_drift(evidence: Evidence, named: Sequence[Cause]) -> tuple[Cause, ...]:
    """The causes; where a drift without a law is among them, no other of that sensor is certain."""
    unknown = {evidence.sensor_of(c.columns) for c in named if c.verdict == UNKNOWN_STRUCTURE}
    return tuple(
        replace(cause, verdict=UNKNOWN_STRUCTURE)
        if evidence.sensor_of(cause.columns) in unknown
        else cause
        for cause in named
    )


def _noise_degrees(evidence: Evidence, candidates: Candidates) -> list[float]:
    """Degrees of freedom of the noise of the sensor with most information on each effect."""
    return [
        evidence.noise_degrees_of(
            evidence.sensor_of([i for columns in effect.candidates for i in columns])
        )
        for effect in candidates.effects
    ]


def _classes(evidence: Evidence, candidates: Candidates, law: Chance) -> list[EffectClass]:
    """The best set of candidates, and the class of each."""
    total = evidence.total
    noise_degrees = _noise_degrees(evidence, candidates)
    thresholds = np.array(
        [_threshold(candidates, law, noise_degrees, i) for i in range(len(candidates.effects))]
    )
    best, peers = Search(candidates, thresholds, total.information, total.right).best()
    places = list(best.places)
    classes: list[EffectClass] = []
    for _ in range(2):  # the most probable of a class replaces its candidate
        classes = []
        for i in range(len(places)):
            others = places[:i] + places[i + 1 :]
            group = effect_class(
                candidates, thresholds, total.information, total.right, places[i], others
            )
            places[i] = group.place
            classes.append(group)
    classes = with_rivals(candidates, classes, best, peers)
    explaining = [group for group in classes if group.drop > 0]
    return sorted(explaining, key=lambda group: -group.drop)


def _threshold(
    candidates: Candidates, law: Chance, noise_degrees: Sequence[float], effect: int
) -> float:
    """The drop of chi-squared from which an effect is named."""
    free = candidates.effects[effect].free
    return law.threshold(effect, noise_degrees[effect]) + MIN_FREE_ADVANTAGE * free


def _cause(
    evidence: Evidence,
    candidates: Candidates,
    law: Chance,
    noise_degrees: Sequence[float],
    group: EffectClass,
    classes: Sequence[EffectClass],
) -> Cause:
    effect = int(candidates.effect[group.place])
    columns = candidates.columns[group.place]
    every = candidates.together([group.place, *(other.place for other in classes)])
    values, covariance = evidence.total.estimate(every)
    own = slice(0, len(columns))
    alone = law.p_value(effect, group.drop, group.degrees, noise_degrees[effect])
    return Cause(
        effect=candidates.effects[effect].name,
        value=int(candidates.value[group.place]),
        verdict=_verdict(candidates.effects[effect], group),
        members=tuple(candidates.effects[i].name for i in group.members),
        member_values=tuple(int(candidates.value[group.best[i]]) for i in group.members),
        weights=tuple(float(group.weights[i]) for i in group.members),
        captured=tuple(float(group.captured[i]) for i in group.members),
        statistic=group.drop,
        degrees=group.degrees,
        p_value=law.after_search(alone),
        snr=float(np.sqrt(max(group.drop - group.degrees, 0.0))),
        columns=columns,
        values=values[own],
        covariance=covariance[own, own],
        threshold=_threshold(candidates, law, noise_degrees, effect),
    )


def _verdict(effect: SearchedEffect, group: EffectClass) -> str:
    if effect.free:
        return UNKNOWN_STRUCTURE
    return FOUND if len(group.members) == 1 else ONE_OF_CLASS


def _tests(
    evidence: Evidence,
    candidates: Candidates,
    law: Chance,
    noise_degrees: Sequence[float],
    classes: Sequence[EffectClass],
) -> tuple[EffectTest, ...]:
    """Every effect given the named ones; these given each other."""
    total = evidence.total
    given = candidates.around([group.place for group in classes])
    drops, degrees = candidates.drops(total.information, total.right, given)
    for group in classes:
        drops[candidates.effect == candidates.effect[group.place]] = -1.0
        drops[group.place], degrees[group.place] = group.drop, group.degrees
    rows = []
    for number, effect in enumerate(candidates.effects):
        own = np.flatnonzero(candidates.effect == number)
        if not len(own) or not degrees[own].any():
            rows.append(EffectTest(effect.name, 0, 0.0, 0, 1.0, 1.0))
            continue
        best = own[np.argmax(np.where(degrees[own] > 0, drops[own], -np.inf))]
        drop, own_degrees = float(drops[best]), int(degrees[best])
        p_value = law.p_value(number, drop, own_degrees, noise_degrees[number])
        rows.append(
            EffectTest(
                effect.name,
                int(candidates.value[best]),
                drop,
                own_degrees,
                p_value,
                law.after_search(p_value),
            )
        )
    return tuple(rows)

"""The causes that the data ask for, each with everything that cannot be told from it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from inertial.model_selection import null_simulation
from inertial.model_selection.cause import (
    FOUND,
    ONE_OF_CLASS,
    UNKNOWN_STRUCTURE,
    Cause,
    EffectTest,
    Named,
)
from inertial.model_selection.effect_classes import Alike, alike, with_rivals
from inertial.model_selection.evidence import Evidence, SearchedEffect
from inertial.model_selection.null_simulation import Chance
from inertial.model_selection.scan import Candidates
from inertial.model_selection.search import Search

LAWLESS = 12.0  # by which a course without a law must explain more than laws would
ROUNDS = 3  # of how large the residuals are with what is found, and what is found then


def name_causes(
    evidence: Evidence, effects: Sequence[SearchedEffect], level: float, seed: int = 0
) -> Named:
    """Name the causes at the level of this campaign, see `causes` and `law_of`."""
    return causes(evidence, effects, law_of(evidence, effects, level, seed))


def law_of(
    evidence: Evidence, effects: Sequence[SearchedEffect], level: float, seed: int = 0
) -> Chance | None:
    """What chance would bring in this campaign; None where nothing is said of any effect."""
    if not evidence.sensors:
        return None
    return null_simulation.chance(evidence.seen().total.information, effects, level, seed=seed)


def causes(evidence: Evidence, effects: Sequence[SearchedEffect], law: Chance | None) -> Named:
    """Name the causes.

    Where the residuals of a sensor exceed the noise also with what is found, something else is
    wrong: there an effect must stand out of the residuals, not of the noise, else any effect
    would be named that happens to lie along what is not understood.

    Parameters
    ----------
    law : the laws of the campaign without effects; also where scans have finer values since
    """
    if law is None:
        return Named((), tuple(EffectTest(e.name, 0, 0.0, 0, 1.0, 1.0) for e in effects), ())
    evidence = evidence.seen()
    candidates = Candidates(effects)
    excesses: tuple[tuple[float, float], ...] = tuple(
        (1.0, evidence.known_from(i)) for i in range(len(evidence.sensors))
    )
    weakened = evidence
    for _ in range(ROUNDS):
        found = _found(weakened, candidates, law)
        again = evidence.excesses(candidates.around([one.place for one in found]))
        if all(new[0] <= old[0] * 1.01 for new, old in zip(again, excesses, strict=True)):
            break
        excesses = tuple(max(pair) for pair in zip(again, excesses, strict=True))
        weakened = evidence.weakened(excesses)
    else:
        found = _found(weakened, candidates, law)
    known = _known_from(weakened, candidates)
    named = [_cause(weakened, candidates, law, known, one, found) for one in found]
    return Named(
        _beside_unknown(weakened, named),
        _tests(weakened, candidates, law, known, found),
        excesses,
    )


def _beside_unknown(evidence: Evidence, named: Sequence[Cause]) -> tuple[Cause, ...]:
    """The causes; where a course without a law is one, no other of that sensor is certain."""
    unknown = {evidence.sensor_of(c.columns) for c in named if c.verdict == UNKNOWN_STRUCTURE}
    return tuple(
        replace(cause, verdict=UNKNOWN_STRUCTURE)
        if evidence.sensor_of(cause.columns) in unknown
        else cause
        for cause in named
    )


def _known_from(evidence: Evidence, candidates: Candidates) -> list[float]:
    """Degrees of freedom of the noise of the sensor that sees each effect best."""
    return [
        evidence.known_from(evidence.sensor_of([i for columns in one.candidates for i in columns]))
        for one in candidates.effects
    ]


def _found(evidence: Evidence, candidates: Candidates, law: Chance) -> list[Alike]:
    """The best set of candidates, and the class of each."""
    total = evidence.total
    known = _known_from(evidence, candidates)
    prices = np.array(
        [law.price(i, known[i]) + LAWLESS * one.free for i, one in enumerate(candidates.effects)]
    )
    best, peers = Search(candidates, prices, total.information, total.right).best()
    places = list(best.places)
    classes: list[Alike] = []
    for _ in range(2):  # the most probable of a class replaces the one that was found
        classes = []
        for i in range(len(places)):
            others = places[:i] + places[i + 1 :]
            one = alike(candidates, prices, total.information, total.right, places[i], others)
            places[i] = one.place
            classes.append(one)
    classes = with_rivals(candidates, classes, best, peers)
    return sorted(classes, key=lambda one: -one.drop)


def _cause(
    evidence: Evidence,
    candidates: Candidates,
    law: Chance,
    known: Sequence[float],
    one: Alike,
    found: Sequence[Alike],
) -> Cause:
    effect = int(candidates.effect[one.place])
    columns = candidates.columns[one.place]
    every = candidates.together([one.place, *(other.place for other in found)])
    values, covariance = evidence.total.estimate(every)
    own = slice(0, len(columns))
    alone = law.p_value(effect, one.drop, one.degrees, known[effect])
    return Cause(
        effect=candidates.effects[effect].name,
        value=int(candidates.value[one.place]),
        verdict=_verdict(candidates.effects[effect], one),
        members=tuple(candidates.effects[i].name for i in one.members),
        member_values=tuple(int(candidates.value[one.best[i]]) for i in one.members),
        weights=tuple(float(one.weights[i]) for i in one.members),
        captured=tuple(float(one.captured[i]) for i in one.members),
        statistic=one.drop,
        degrees=one.degrees,
        p_value=law.after_search(alone),
        snr=float(np.sqrt(max(one.drop - one.degrees, 0.0))),
        columns=columns,
        values=values[own],
        covariance=covariance[own, own],
    )


def _verdict(effect: SearchedEffect, one: Alike) -> str:
    if effect.free:
        return UNKNOWN_STRUCTURE
    return FOUND if len(one.members) == 1 else ONE_OF_CLASS


def _tests(
    evidence: Evidence,
    candidates: Candidates,
    law: Chance,
    known: Sequence[float],
    found: Sequence[Alike],
) -> tuple[EffectTest, ...]:
    """Every effect beside what was found; what was found beside the others."""
    total = evidence.total
    beside = candidates.around([one.place for one in found])
    drops, degrees = candidates.drops(total.information, total.right, beside)
    for one in found:
        drops[candidates.effect == candidates.effect[one.place]] = -1.0
        drops[one.place], degrees[one.place] = one.drop, one.degrees
    rows = []
    for number, effect in enumerate(candidates.effects):
        own = np.flatnonzero(candidates.effect == number)
        if not len(own) or not degrees[own].any():
            rows.append(EffectTest(effect.name, 0, 0.0, 0, 1.0, 1.0))
            continue
        best = own[np.argmax(np.where(degrees[own] > 0, drops[own], -np.inf))]
        drop, own_degrees = float(drops[best]), int(degrees[best])
        p_value = law.p_value(number, drop, own_degrees, known[number])
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

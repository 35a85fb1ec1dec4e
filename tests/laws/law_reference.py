"""What the laboratory makes of a law, reduced to the equations of a campaign."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import chain
import numpy as np
from hidden_courses import RATE, Course, _start, known_course
from law_families import Family, plan_document

import laboratory
from inertial.arrays import Array
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.observations import campaign_of
from inertial.effects import CATALOGUE
from inertial.estimation.random_walk import NO_DRIFT
from inertial.model_selection.evidence import searched_effect
from inertial.model_selection.search import Candidates
from inertial.physics.effect import Effect
from laboratory import Recording


@cache
def clean(plan: str) -> tuple[Campaign, Mapping[str, float]]:
    """The equations of a clean campaign of a plan, and when each of its logs began, s."""
    recording = laboratory.perform(laboratory.specify(plan_document(plan, effects={})))
    started = {log: _start(truth) for log, truth in recording.truth.items()}
    return equations_of(chain.in_memory(recording, "gyroscope")), started


def equations_of(results: chain.Results) -> Campaign:
    """The equations of a campaign without random walks."""
    (data,) = chain.mounts(results)
    campaign = replace(campaign_of(data), drifts=dict.fromkeys(("gyro", "accel"), NO_DRIFT))
    return campaign.without_random_walks()


def course(family: Family, numbers: Any, plan: str, sizes: Any, seed: int = 0) -> Course:
    """What the readings have more with a law than without, by slower recordings."""
    told = family.told(numbers, plan, sizes)
    _equations, started = clean(plan)
    return known_course("known_course", [_slow(plan, told, seed)], _quiet(plan, seed), started)


@cache
def _quiet(plan: str, seed: int) -> Recording:
    return _slow(plan, {}, seed)


def _slow(plan: str, effects: Mapping[str, Any], seed: int) -> Recording:
    document = plan_document(plan, effects=effects, seed=seed)
    if document["receiver"].get("message") == "columns":
        document["campaign"]["instrument"] |= {"rate_hz": RATE}
    document["receiver"] = document["receiver"] | {"rate_hz": RATE}
    return laboratory.perform(laboratory.specify(document))


def remaining(campaign: Campaign, known: Effect) -> float:
    """The signal-to-noise ratio of a course beside the best effect of the catalogue."""
    every = [
        effect
        for family in campaign.candidates(
            [e for e in CATALOGUE.values() if e.sought_in == "blocks"]
        ).values()
        for effect in family
    ]
    total = evidence(campaign, [known, *every]).total
    place = {name: i for i, name in enumerate(total.names)}
    signal = total.information[:, 0]
    searched = [searched_effect(e.label, [place[n] for n in e.columns]) for e in every]
    taken, _degrees = Candidates(searched).drops(total.information, signal)
    return float(np.sqrt(max(signal[0] - taken.max(), 0.0)))


def captured(
    campaign: Campaign, known: Effect, law: Effect, sizes: Array, beside: Sequence[Effect] = ()
) -> float:
    """Which share of a course a law of these sizes has, and so the other way round.

    `beside`: effects that are fitted as well.
    """
    total = evidence(campaign, [known, law, *beside]).total
    place = {name: i for i, name in enumerate(total.names)}
    total = total.given([place[name] for effect in beside for name in effect.columns])
    own = [place[name] for name in law.columns]
    signal = total.information[:, own] @ sizes
    size, whole = float(signal[own] @ sizes), float(total.information[0, 0])
    return float(signal[0] ** 2 / max(whole * size, np.finfo(float).tiny))

"""The Bayes classifier: it knows the twelve families, their forms, and how axes are drawn.

The course of each form is the laboratory's own. Sizes have the prior of all odds of the pipeline. A
telegraph has more paths than can be gone through: for it the odds of its most probable path are
divided by the number of paths, which is a lower bound.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from hidden_courses import Course
from law_families import FAMILIES, Family
from law_reference import course

from inertial.arrays import Array
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.effects.law import Law
from inertial.model_selection.effect_classes import log_evidence
from inertial.model_selection.evidence import searched_effect
from inertial.model_selection.law_evidence import best_paths, log_paths
from inertial.model_selection.search import Candidates
from inertial.model_selection.walk_odds import Equations
from inertial.physics.effect import Effect
from inertial.physics.laws import STEPS, after, steps
from stages.criticism.residual_structure import Functions

ALONE = 0.25  # prior of each axis by itself; the rest is that of all axes


@dataclass(frozen=True)
class Guess:
    """The most probable family, and the course and sizes of its most probable form."""

    title: str
    course: Effect
    sizes: Array


def forms(family: Family) -> list[list[tuple[float, float]]]:
    """Numbers of each form: those of two phases together, for they add up to any."""
    if family.numbers == 0:
        return [[(0.5, 0.5)]]
    ways = family.form((0.5, 0.5), 1.0)
    if "phase_deg" in ways:
        return [[((k + 0.5) / 80, 0.0), ((k + 0.5) / 80, 0.25)] for k in range(80)]
    first = [(k + 0.5) / 12 for k in range(12)]
    return [[(a, b)] for a in first for b in (first[::2] if family.numbers == 2 else [0.5])]


@cache
def courses(family: Family, plan: str) -> list[Course]:
    """Of each form the courses of three axes, those of a phase one after another."""
    made = []
    for number, form in enumerate(forms(family)):
        parts = [course(family, numbers, plan, np.ones(3)) for numbers in form]
        gyro, accel = (
            np.concatenate([_by_axis(getattr(part, name)) for part in parts], axis=2)
            for name in ("gyro", "accel")
        )
        title = f"{family.title} {number}"
        made.append(Course(title, parts[0].time, gyro, accel))
    return made


def _by_axis(integral: Array) -> Array:
    """(n, 3, 1) → (n, 3, 3): the k-th course is that of the k-th axis."""
    return integral * np.eye(3)


def chosen(campaign: Campaign, sensor: str, plan: str) -> Guess:
    """The family with the largest posterior probability, of those that this plan shows."""
    own = [f for f in FAMILIES if plan in f.plans and f.sensor == sensor]
    guesses = [(*_odds_of(campaign, family, plan), family) for family in own]
    _odds, known, sizes, family = max(guesses, key=lambda guess: guess[0])
    return Guess(family.title, known, sizes)


def _odds_of(campaign: Campaign, family: Family, plan: str) -> tuple[float, Effect, Array]:
    if family.title == "telegraph":
        return _telegraph(campaign)
    every = courses(family, plan)
    total = evidence(campaign, every).total
    candidates, widths = [], []
    first = 0
    for one in every:
        count = len(one.parameters)
        for axis in range(3):
            candidates.append(list(range(first + axis, first + count, 3)))
        candidates.append(list(range(first, first + count)))
        first += count
        widths.append(count)
    searched = Candidates([searched_effect("", *candidates)])
    drops, degrees = searched.drops(total.information, total.right)
    odds = log_evidence(drops, degrees) + np.log(ALONE)
    best = int(np.argmax(odds))
    values, _covariance = total.estimate(candidates[best])
    form = best // 4
    sizes = np.zeros(widths[form])
    sizes[np.array(candidates[best]) - sum(widths[:form])] = np.nan_to_num(values)
    largest = float(odds.max())
    mean = largest + float(np.log(np.mean(np.exp(odds - largest)) * 4))
    return mean, every[form], sizes


def _telegraph(campaign: Campaign) -> tuple[float, Effect, Array]:
    motion, part = campaign.motion, campaign.stretches("gyro")
    times = steps(motion, STEPS)
    values = np.zeros((len(motion.time), STEPS))
    for column, time in enumerate(times):
        values[part, column] = after(motion, float(time))[part]
    functions = [Functions("gyro", axis, f"steps {axis}", values) for axis in range(3)]
    total = evidence(campaign, functions).total
    found = []
    for axis in range(3):
        own = range(axis * STEPS, (axis + 1) * STEPS)
        for path, drop in best_paths(Equations(total.information, total.right), own, 2).items():
            odds = float(log_evidence(np.array([drop]), np.array([1]))[0])
            found.append((odds + np.log(ALONE) - log_paths(STEPS, len(path)), axis, path))
    odds, axis, path = max(found)
    law = Law("gyro", "xyz"[axis], "telegraph", "time", [float(times[i]) for i in path])
    row = np.zeros(STEPS)
    row[list(path)] = (-1.0) ** np.arange(len(path))
    own = slice(axis * STEPS, (axis + 1) * STEPS)
    size = (row @ total.right[own]) / (row @ total.information[own, own] @ row)
    return odds, law, np.array([size])

"""The second part of the challenge: every effect at every ratio, on sufficient statistics.

A campaign whose equations are linear and whose noise is Gaussian says of the effects no more than
b ~ N(F β, F), F the information of all candidates and of what the laboratory makes of each effect
in the clean reference of a plan; β is not zero for the laboratory's. That is drawn some hundred
times for each effect and ratio and named as criticism does it, which takes milliseconds. Decoding,
detectors and the fit are left out: those are the business of the campaigns.
"""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from hidden_draws import SEED
from hidden_named_sizes import FIRST, MATE, SCANNED, Counts, Truth, counted, summed
from hidden_sizes import Reference, code, reference
from hidden_ways import POSITIVE, WAYS, Array

from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.evidence import Evidence
from inertial.model_selection.naming import causes
from inertial.model_selection.search import MIN_EIGENVALUE

TRIALS = {0.0: 2000, 5.0: 300, 6.0: 200, 8.0: 200}  # how often at each ratio; 0: clean
PARTS = 4  # of the clean draws, so that both cores have work to the end
CLEAR = ("found", "one_of_class")
PLANS = ("positions", "stops", "rates")

Job = tuple[str, str, float, int]


def every_job() -> list[Job]:
    """Plan, effect, ratio, trials: each effect in each plan that shows it; each plan clean."""
    jobs: list[Job] = [
        (plan, name, ratio, trials)
        for name, way in WAYS.items()
        for plan in way.plans
        for ratio, trials in TRIALS.items()
        if ratio
    ]
    share = TRIALS[0.0] // PARTS
    return jobs + [(plan, f"clean {n}", 0.0, share) for plan in PLANS for n in range(PARTS)]


def tried(plan: str, name: str, ratio: float, trials: int) -> dict[str, Any]:
    """How often an effect of this ratio is named, is in the class, and how well it is estimated."""
    told = {"plan": plan, "effect": name, "ratio": ratio, "trials": trials, "code": code()}
    if not ratio:
        return told | {"power": _false_names(plan, int(name.split()[-1]), trials)}
    return told | _counted(plan, name, ratio, trials) | reference(plan).limits(name, ratio)


def _counted(plan: str, name: str, ratio: float, trials: int) -> dict[str, Any]:
    """How often.

    `power`: anything is named; `in_class`: the effect is a member; `first`: it is the most
    probable; `members`: of its classes in all; `sizes`: what the named draws say of the size.
    """
    known = reference(plan)
    random = np.random.default_rng(
        [SEED + 2, PLANS.index(plan), list(WAYS).index(name), int(ratio)]
    )
    told = dict.fromkeys(("power", "in_class", "first", "members"), 0)
    asked = next(one for one in known.asked if one.name == name)
    sizes: dict[str, list[Counts]] = {FIRST: [], MATE: [], SCANNED: []}
    for _ in range(trials):
        columns = _columns(known, name, random)
        beta, values = _truth(known, name, columns, ratio, random)
        said = _drawn(plan, beta, random)
        named = causes(said, known.asked, known.law).causes
        mine = [one for one in named if one.verdict in CLEAR and name in one.members][:1]
        told["power"] += bool(named)
        told["in_class"] += len(mine)
        told["members"] += sum(len(cause.members) for cause in mine)
        told["first"] += sum(cause.effect == name for cause in mine)
        truth = Truth(columns, beta[columns], values, ratio)
        for cause in mine:
            value = cause.member_values[cause.members.index(name)]
            own = cause.columns if cause.effect == name else asked.candidates[value]
            counts = counted(said.total, named, cause, own, truth)
            sizes[FIRST if cause.effect == name else MATE].append(counts)
            if len(asked.candidates) > 1:
                sizes[SCANNED].append(counts)
    return told | {"sizes": {sort: summed(some) for sort, some in sizes.items()}}


def _false_names(plan: str, part: int, trials: int) -> int:
    """In how many of so many clean campaigns anything is named."""
    known = reference(plan)
    random = np.random.default_rng([SEED + 3, PLANS.index(plan), part])
    nothing = np.zeros(len(known.said.names))
    return sum(
        bool(causes(_drawn(plan, nothing, random), known.asked, known.law).causes)
        for _ in range(trials)
    )


def _columns(known: Reference, name: str, random: np.random.Generator) -> list[int]:
    """What the laboratory makes of an effect, of any value of its scan."""
    every = known.hidden[name]
    return list(every[int(random.integers(len(every)))])


def _truth(
    known: Reference, name: str, columns: list[int], ratio: float, random: np.random.Generator
) -> tuple[Array, Array]:
    """β of all columns, and the effect's values, in a random direction, as large as wanted."""
    direction = random.normal(size=len(columns))
    direction = np.abs(direction) if name in POSITIVE else direction
    block = known.said.total.information[np.ix_(columns, columns)]
    sizes = direction * ratio / np.sqrt(direction @ block @ direction)
    beta = np.zeros(len(known.said.names))
    beta[columns] = sizes
    return beta, sizes * known.typical(name)


@cache
def _roots(plan: str) -> list[tuple[Array, Array]]:
    """Of each sensor a root R of its information, F = R Rᵀ, and the inverse of it, (m, k)."""
    roots = []
    for sensor in reference(plan).said.sensors:
        size = np.sqrt(np.maximum(np.diag(sensor.information), np.finfo(float).tiny))
        size = np.where(np.diag(sensor.information) > 0, size, np.inf)
        values, vectors = np.linalg.eigh(sensor.information / np.outer(size, size))
        seen = values > MIN_EIGENVALUE * 1e-3
        scale = np.where(np.isfinite(size), size, 0.0)
        root = scale[:, None] * vectors[:, seen] * np.sqrt(values[seen])
        roots.append((root, (vectors[:, seen] / np.sqrt(values[seen])).T / size))
    return roots


def _drawn(plan: str, beta: Array, random: np.random.Generator) -> Evidence:
    """What a campaign of the plan says where β is true."""
    said = reference(plan).said
    sensors: list[EffectInformation] = []
    for sensor, (root, inverse) in zip(said.sensors, _roots(plan), strict=True):
        right = sensor.information @ beta + root @ random.standard_normal(root.shape[1])
        left = random.chisquare(max(sensor.degrees - root.shape[1], 1))
        explained = float(np.sum((inverse @ right) ** 2))
        sensors.append(replace(sensor, right=right, chi_squared=float(left + explained)))
    return replace(said, sensors=tuple(sensors))

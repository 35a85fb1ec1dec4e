"""Which effects a fleet of campaigns shows, and what shares each: sensor, table or type.

The hypotheses are an effect that is the same in all campaigns of a type, of a table or of an IMU,
and one that has a size of its own in each table or each IMU. They enter the model one by one, the
one first that explains most beyond its threshold, and each may be exchanged for another. The s-th
is accepted where its p-value beside the others is below s times the p-value that the smallest of
all falls below by chance with the accepted probability (Benjamini & Hochberg 1995, with the number
of independent hypotheses by simulation from the information matrices, b ~ N(0, F)).

What else would explain a finding is weighed by local empirical Bayes (Liang et al. 2008): with
sizes of a normal prior whose variance is the likeliest one, a drop D of r degrees has the log
evidence ½ (D − r − r log(D/r)). Each level has the same prior probability, half of it on a size of
its own in each group and half on a single group.

An effect of a size of its own in each campaign is searched for too, but not one in a single
campaign, for that is what each campaign does itself: it may only take the place of another.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TypeVar

import numpy as np

from inertial.arrays import Array, Integers
from inertial.estimation.fleet_components import LEVELS
from inertial.estimation.probability import chi2_isf, chi2_sf
from inertial.model_selection.fleet_evidence import EVERY, FleetEvidence, Given, Shared, whitened

Key = TypeVar("Key")
ArrayOrFloat = TypeVar("ArrayOrFloat", Array, float)

DRAWS = 2000
BATCH_VALUES = 4_000_000  # of scores that are drawn at once
MAX_FOUND = 20
MAX_ROUNDS = 3  # of exchanges
MIN_WEIGHT = 0.05  # of what else a finding may be


@dataclass(frozen=True)
class FleetLaw:
    """What noise alone brings forth; `share`: the p-value of a single hypothesis that is accepted.

    `share` is what the smallest of all p-values falls below with the accepted probability.
    """

    level: float
    share: float
    hypotheses: int

    def of_any(self, p_value: float) -> float:
        """The p-value of any of the hypotheses."""
        return min(p_value * self.level / self.share, 1.0)


@dataclass(frozen=True)
class FleetEffect:
    """An effect that the fleet shows.

    `p_value`: after the search, beside the other findings; `sharings`: posterior probability of
    each level, the first the most probable; `members`: effects that it may be, each with its
    probability; `levels`: what shares it, or one of these: 95 % of the probability.
    """

    hypothesis: Shared
    statistic: float
    degrees: int
    p_value: float
    sharings: Mapping[str, float]
    members: Mapping[int, float]

    @property
    def levels(self) -> tuple[str, ...]:
        """The most probable levels, of 95 % together."""
        kept, total = [], 0.0
        for level, weight in self.sharings.items():
            if total < 1 - MIN_WEIGHT:
                kept.append(level)
            total += weight
        return tuple(kept)


class FleetSearch:
    """The search in the campaigns of one fleet."""

    def __init__(self, evidence: FleetEvidence, law: FleetLaw) -> None:
        self.evidence, self.law = evidence, law
        self.searched = hypotheses(evidence)
        self.every = hypotheses(evidence, campaigns=True)

    def found(self) -> list[FleetEffect]:
        """The effects, each with what shares it."""
        model = self._accepted(self._exchanged(self._forward()))
        model = self._accepted(self._as_shared(model))
        return [self._finding(place, model) for place in range(len(model))]

    def _as_shared(self, model: list[Shared]) -> list[Shared]:
        """Each as what shares it in all probability, where it was found as another level.

        The search goes by significance: sizes of their own in each of few groups may exceed their
        threshold by a little more than the one size that all have.
        """
        model = list(model)
        for place in range(len(model)):
            found = self._finding(place, model)
            if found.hypothesis.level not in found.levels:
                others = model[:place] + model[place + 1 :]
                level = [
                    one
                    for one in self.every
                    if (one.effect, one.level) == (found.hypothesis.effect, found.levels[0])
                    and one not in others
                ]
                best, p_value, _ = self._best(others, level)
                if best is not None and p_value <= self.law.share:
                    model[place] = best
        return model

    def _forward(self) -> list[Shared]:
        model: list[Shared] = []
        while len(model) < MAX_FOUND:
            best, p_value, _ = self._best(model, self.searched)
            if best is None or p_value > self.law.share * (len(model) + 1):
                break
            model = self._exchanged([*model, best])
        return model

    def _exchanged(self, model: list[Shared]) -> list[Shared]:
        """Each in turn replaced by what explains more beside the others."""
        for _ in range(MAX_ROUNDS):
            before = list(model)
            for place in range(len(model)):
                others = model[:place] + model[place + 1 :]
                best, _, gain = self._best(others, self.every)
                if best is not None and gain > self._gain(model[place], others) + 1e-9:
                    model[place] = best
            if model == before:
                break
        return model

    def _accepted(self, model: list[Shared]) -> list[Shared]:
        """Without those that are not significant beside the others, the weakest first."""
        while model:
            chances = [self._p_value(h, model[:i] + model[i + 1 :]) for i, h in enumerate(model)]
            worst = int(np.argmax(chances))
            if chances[worst] <= self.law.share * len(model):
                break
            model = model[:worst] + model[worst + 1 :]
        return model

    def _best(
        self, model: Sequence[Shared], among: Sequence[Shared]
    ) -> tuple[Shared | None, float, float]:
        """What explains most beyond its threshold beside a model, its p-value, and by how much."""
        drops, degrees = self._drops(self.evidence.given(model), among)
        gains = np.where(degrees > 0, drops - self._threshold(degrees), -np.inf)
        there = set(model)
        gains[[i for i, one in enumerate(among) if one in there]] = -np.inf
        place = int(np.argmax(gains)) if len(gains) else -1
        if place < 0 or not np.isfinite(gains[place]):
            return None, 1.0, -np.inf
        p_value = float(chi2_sf(drops[place], degrees[place]))
        return among[place], p_value, float(gains[place])

    def _threshold(self, degrees: Integers) -> Array:
        return chi2_isf(self.law.share, np.maximum(degrees, 1))

    def _gain(self, one: Shared, others: Sequence[Shared]) -> float:
        drop, degrees = self._alone(one, others)
        return drop - float(self._threshold(np.array(degrees))) if degrees else -np.inf

    def _p_value(self, one: Shared, others: Sequence[Shared]) -> float:
        drop, degrees = self._alone(one, others)
        return float(chi2_sf(drop, degrees)) if degrees else 1.0

    def _alone(self, one: Shared, others: Sequence[Shared]) -> tuple[float, int]:
        drops, degrees = self.evidence.drops(one.effect, one.level, self.evidence.given(others))
        return float(drops[one.group]), int(degrees[one.group])

    def _drops(self, given: Given, among: Sequence[Shared]) -> tuple[Array, Integers]:
        """Of some hypotheses."""
        table = {
            pair: self.evidence.drops(*pair, given)
            for pair in dict.fromkeys((one.effect, one.level) for one in among)
        }
        both = [table[one.effect, one.level] for one in among]
        drops = [own[0][one.group] for own, one in zip(both, among, strict=True)]
        degrees = [own[1][one.group] for own, one in zip(both, among, strict=True)]
        return np.array(drops), np.array(degrees, np.int64)

    # ---- What else a finding may be.

    def _finding(self, place: int, model: list[Shared]) -> FleetEffect:
        others = model[:place] + model[place + 1 :]
        given = self.evidence.given(others)
        own = model[place]
        drop, degrees = self._alone(own, others)
        weights = self._weights(given)
        members = {
            effect: sum(weight for (of, _), weight in weights.items() if of == effect)
            for effect in range(len(self.evidence.names))
        }
        of_effect = {level: weights.get((own.effect, level), 0.0) for level in LEVELS}
        total = sum(of_effect.values())
        return FleetEffect(
            own,
            drop,
            degrees,
            self.law.of_any(float(chi2_sf(drop, degrees))),
            _largest_first({level: weight / total for level, weight in of_effect.items()}),
            _largest_first(
                {e: w for e, w in members.items() if w >= MIN_WEIGHT or e == own.effect}
            ),
        )

    def _weights(self, given: Given) -> dict[tuple[int, str], float]:
        """Posterior probability of each effect with each level."""
        logs: dict[tuple[int, str], float] = {}
        for effect, level in product(range(len(self.evidence.names)), LEVELS):
            drops, degrees = self.evidence.drops(effect, level, given)
            shown = degrees[:-1] > 0
            if not shown.any():
                continue
            prior = np.append(np.where(shown, 0.5 / shown.sum(), 0.0), 0.5)
            if len(shown) == 1:
                prior = np.array([1.0, 0.0])
            kept = prior > 0
            terms = log_evidence(drops[kept], degrees[kept]) + np.log(prior[kept])
            logs[effect, level] = float(np.logaddexp.reduce(terms))
        top = max(logs.values())
        weights = {key: float(np.exp(value - top)) for key, value in logs.items()}
        total = sum(weights.values())
        return {key: weight / total for key, weight in weights.items()}


def log_evidence(drops: Array, degrees: Integers) -> Array:
    """Of drops of chi-squared, the variance of the sizes being the likeliest (Liang et al.)."""
    r = np.maximum(degrees, 1)
    excess = np.maximum(drops / r, 1.0)
    return np.asarray(0.5 * r * (excess - 1 - np.log(excess)))


def _largest_first(weights: Mapping[Key, float]) -> dict[Key, float]:
    return dict(sorted(weights.items(), key=lambda item: -item[1]))


# ---- The hypotheses and the null distribution.


def hypotheses(evidence: FleetEvidence, campaigns: bool = False) -> list[Shared]:
    """All that are searched, single `campaigns` too; of the same campaigns only the first."""
    found: list[Shared] = []
    seen: set[tuple[bool, bytes]] = set()
    for level in LEVELS:
        groups = evidence.levels[level]
        single = range(len(groups.labels)) if campaigns or level != LEVELS[-1] else ()
        for group in [*single, EVERY]:
            of = groups.of if group == EVERY else groups.of == group
            key = (group == EVERY, of.tobytes())
            if key in seen or (group == EVERY and len(groups.labels) == 1):
                continue
            seen.add(key)
            found += [
                Shared(effect, level, group)
                for effect in range(len(evidence.names))
                if _shown(evidence, effect, level, group)
            ]
    return found


def _shown(evidence: FleetEvidence, effect: int, level: str, group: int) -> bool:
    of = (
        evidence.levels[level].information
        if group == EVERY
        else (evidence.levels[level].information[[group]])
    )
    columns = evidence.columns[effect]
    shown = np.any(of[:, columns, columns] > 0, axis=1)
    return bool(shown.sum() > 1 if group == EVERY else shown.any())


def fleet_law(evidence: FleetEvidence, level: float, further: int = 0) -> FleetLaw:
    """The null distribution of the search.

    Parameters
    ----------
    level : accepted probability of any finding where there is no effect, and share of false ones
        among all findings
    further : how many independent hypotheses are searched besides, elsewhere
    """
    every = hypotheses(evidence)
    random = np.random.default_rng(0)
    roots = _roots(evidence.information)
    pairs = list(dict.fromkeys((one.effect, one.level) for one in every))
    batch = max(min(BATCH_VALUES // max(evidence.right.size, 1), DRAWS), 1)
    smallest = []
    for start in range(0, DRAWS, batch):
        count = min(batch, DRAWS - start)
        noise = random.standard_normal((*evidence.right.shape, count))
        smallest.append(_smallest(evidence, roots @ noise, every, pairs))
    least = np.concatenate(smallest)
    least = np.minimum(least, smallest_of(further, np.random.default_rng(1).random(len(least))))
    share = float(np.quantile(least, level)) if every or further else level
    return FleetLaw(level, share, len(every) + further)


def smallest_of(count: int, chance: ArrayOrFloat) -> ArrayOrFloat:
    """The p-value that the smallest of so many independent ones falls below with a chance."""
    return -np.expm1(np.log1p(-chance) / count) if count else 1.0 + 0.0 * chance


def _smallest(
    evidence: FleetEvidence,
    right: Array,
    every: Sequence[Shared],
    pairs: Sequence[tuple[int, str]],
) -> Array:
    """The smallest p-value of all hypotheses in each draw; `right`: (c, k, draws)."""
    sums = {}
    for level in LEVELS:
        groups = evidence.levels[level]
        sums[level] = np.zeros((len(groups.labels), *right.shape[1:]))
        np.add.at(sums[level], groups.of, right)
    smallest = np.ones(right.shape[2])
    for effect, level in pairs:
        columns, groups = evidence.columns[effect], evidence.levels[level]
        block = groups.information[:, columns[:, None], columns]
        white, seen = whitened(block)
        along = white @ sums[level][:, columns]
        alone, degrees = np.sum(along**2, axis=1), seen.sum(axis=1)
        drops = {g: (alone[g], degrees[g]) for g in range(len(alone))}
        drops[EVERY] = alone.sum(axis=0), degrees.sum()
        for group in (one.group for one in every if (one.effect, one.level) == (effect, level)):
            np.minimum(smallest, chi2_sf(*drops[group]), out=smallest)
    return smallest


def _roots(information: Array) -> Array:
    """R of each campaign, F = R Rᵀ, (c, k, k)."""
    scale = np.sqrt(np.maximum(np.diagonal(information, axis1=1, axis2=2), 0.0))
    safe = np.where(scale > 0, scale, 1.0)
    values, vectors = np.linalg.eigh(information / (safe[:, :, None] * safe[:, None, :]))
    return np.asarray(scale[:, :, None] * vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :])

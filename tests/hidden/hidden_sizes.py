"""What each plan says of every effect, by a clean campaign: sizes, and the threshold of a name."""

import pickle
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import permutations, product
from typing import Any

import chain
import numpy as np
from hidden_courses import courses, scanned
from hidden_plans import PLANS
from hidden_ways import WAYS, Array
from resumable import code_of_outcomes
from textbook_power import power_limit

import laboratory
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.observations import campaign_of
from inertial.effects import CATALOGUE
from inertial.model_selection.evidence import Evidence, SearchedEffect
from inertial.model_selection.naming import law_of
from inertial.model_selection.null_simulation import Chance, power
from inertial.physics.effect import Effect
from stages.criticism.effect_selection import evidence_of
from stages.criticism.stage import BLOCKS_SHARE

SEED = 9_999
APART = 0.25  # of the square of its ratio, that another effect must leave
KEPT = chain.ROOT / "data/derived/challenge"
DRAWN_BY = ("campaigns", "courses", "draws", "elsewhere", "named_sizes", "outside", "plans")
DRAWN_BY += ("sizes", "statistics", "ways")
BESIDE = ("studies", "comparison", "compensation")  # no later stage of these campaigns needs them
LEVEL = chain.SETTINGS["criticism"]["level"] * BLOCKS_SHARE


@dataclass(frozen=True)
class Reference:
    """A clean campaign of a plan, ready to be asked.

    `said`: of all candidates and of what the laboratory makes of each effect; `asked`: the columns
    of the candidates of each effect, `hidden`: those of the laboratory, for every value of its
    scan; `law`: what noise alone brings forth, by simulation; `noise_degrees`: of freedom of the
    noise.
    """

    plan: str
    campaign: Campaign
    said: Evidence
    asked: Sequence[SearchedEffect]
    hidden: Mapping[str, Sequence[Sequence[int]]]
    law: Chance
    noise_degrees: float

    def columns(self, name: str, at: float | None) -> Sequence[int]:
        """What the laboratory makes of an effect, with the value of its scan that is nearest."""
        values = scanned(WAYS[name], self.plan)
        number = 0 if at is None else int(np.argmin([abs((one or 0.0) - at) for one in values]))
        return self.hidden[name][number]

    def typical(self, name: str) -> Array:
        """The sizes of an effect's parameters of which the courses are, in the model's units."""
        return np.array([one.typical for one in CATALOGUE[name].parameters])

    def size(self, name: str, at: float | None, values: Any) -> float:
        """The signal-to-noise ratio of values of an effect, all 24 parameters being fitted."""
        columns = self.columns(name, at)
        information = self.said.total.information[np.ix_(columns, columns)]
        sizes = values / self.typical(name)
        return float(np.sqrt(sizes @ information @ sizes))

    def along(self, name: str, at: float | None, found: Any, truth: Any) -> float:
        """Estimated values along the true direction, in units of the true size."""
        columns = self.columns(name, at)
        information = self.said.total.information[np.ix_(columns, columns)]
        one, other = found / self.typical(name), truth / self.typical(name)
        return float(one @ information @ other / (other @ information @ other))

    def left(self, name: str, at: float | None, values: Any, other: str) -> float:
        """Which share of the square of its ratio another effect leaves, whatever its size is."""
        hidden = {name: dict(enumerate(values))}
        signal, square = self._together(hidden, {} if at is None else {name: at})
        candidates = next(one.candidates for one in self.asked if one.name == other)
        return self._left(signal, square, candidates) / square

    def limits(self, name: str, ratio: float) -> dict[str, float]:
        """The power at a ratio by this plan's own threshold, and by the textbook's."""
        number = [one.name for one in self.asked].index(name)
        degrees = self.law.tails[number].degrees
        if not degrees:
            return {"degrees": 0, "limit": 0.0, "textbook": 0.0}
        threshold = self.law.threshold(number, self.noise_degrees)
        seen = sum(tail.degrees > 0 for tail in self.law.tails)
        values = self.law.tails[number].trials(threshold)
        return {
            "degrees": degrees,
            "limit": float(power(ratio, degrees, threshold)),
            "textbook": float(power_limit(ratio, degrees, seen, LEVEL, values)),
        }

    def limit_together(
        self, truth: Mapping[str, Mapping[str, float]], at: Mapping[str, float]
    ) -> float:
        """The probability that each of several effects is beyond its threshold.

        What remains of all of them beside the others, with whatever sizes and values of their
        scans take up most, shows an effect; and what remains beside any one effect of the
        catalogue shows that there are several. The search for the others is free.
        """
        signal, square = self._together(truth, at)
        asked = {one.name: one.candidates for one in self.asked}
        likely, further = 1.0, 0.0
        beside_one = min(
            self._left(signal, square, one.candidates) for one in self.asked if not one.free
        )
        for name in truth:
            number = list(asked).index(name)
            others = [asked[other] for other in truth if other != name]
            joint = [[i for one in each for i in one] for each in product(*others)]
            degrees = self.law.tails[number].degrees
            threshold = self.law.threshold(number, self.noise_degrees)
            left = self._left(signal, square, joint)
            likely *= float(power(np.sqrt(left), degrees, threshold))
            further = max(further, float(power(np.sqrt(beside_one), degrees, threshold)))
        return min(likely, further)

    def _together(
        self, truth: Mapping[str, Mapping[str, float]], at: Mapping[str, float]
    ) -> tuple[Array, float]:
        """Of several effects the right side, (k,), and the square of their ratio."""
        columns = [i for name in truth for i in self.columns(name, at.get(name))]
        sizes = np.concatenate(
            [np.array([*truth[name].values()]) / self.typical(name) for name in truth]
        )
        signal = self.said.total.information[:, columns] @ sizes
        return signal, float(sizes @ signal[columns])

    def _left(self, signal: Array, square: float, candidates: Iterable[Sequence[int]]) -> float:
        """What the best of some candidates leaves of the square of a ratio."""
        information = self.said.total.information
        taken = [
            signal[own] @ np.linalg.pinv(information[np.ix_(own, own)], 1e-9, True) @ signal[own]
            for own in map(list, candidates)
        ]
        return max(square - float(max(taken)), 0.0)

    def size_of(self, effect: Effect) -> float:
        """The signal-to-noise ratio of a course that is known but for its size, which is 1."""
        return float(np.sqrt(evidence(self.campaign, [effect]).total.information[0, 0]))


@cache
def code() -> str:
    """A hash of all that an outcome rests on."""
    own = [chain.ROOT / f"tests/hidden/hidden_{name}.py" for name in DRAWN_BY]
    return code_of_outcomes(chain.up_to("extension"), own)


@cache
def reference(plan: str) -> Reference:
    """The reference of a plan; kept on disk for as long as the code is the same."""
    file = KEPT / f"{plan}-{code()}.pickle"
    if file.exists():
        made: Reference = pickle.loads(file.read_bytes())
        return made
    made = _made(plan)
    KEPT.mkdir(parents=True, exist_ok=True)
    for old in KEPT.glob(f"{plan}-*.pickle"):
        old.unlink(missing_ok=True)
    part = file.with_suffix(f".{id(made)}.part")
    part.write_bytes(pickle.dumps(made))
    part.replace(file)
    return made


def size(plan: str, name: str, at: float | None, values: Any) -> float:
    """The signal-to-noise ratio of an effect in a plan."""
    return reference(plan).size(name, at, values)


def apart(plan: str, truth: Mapping[str, Mapping[str, float]], at: Mapping[str, float]) -> bool:
    """Whether no effect that is hidden would do for another one: else one name is enough."""
    known = reference(plan)
    return all(
        known.left(one, at.get(one), list(truth[one].values()), other) > APART
        for one, other in permutations(truth, 2)
    )


def _made(plan: str) -> Reference:
    recording = laboratory.perform(laboratory.specify(PLANS[plan](seed=SEED)))
    (data,) = chain.mounts(chain.in_memory(recording, "gyroscope", BESIDE))
    campaign, degrees = campaign_of(data).without_random_walks(), data.noise.degrees
    in_blocks = [effect for effect in CATALOGUE.values() if effect.sought_in == "blocks"]
    families = {name: tuple(one) for name, one in campaign.candidates(in_blocks).items()}
    made = courses(plan, SEED)
    every = [course for of_effect in made.values() for course in of_effect]
    said, asked = evidence_of(campaign, families, degrees, every)
    law = law_of(said, asked, LEVEL)
    assert law is not None  # the plans show effects
    place = {column: i for i, column in enumerate(said.names)}
    hidden = {
        name: [[place[f"{one.label}.{each.name}"] for each in one.parameters] for one in of_effect]
        for name, of_effect in made.items()
    }
    return Reference(plan, campaign, said.observable(), asked, hidden, law, degrees)

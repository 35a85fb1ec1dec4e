"""Which additional manoeuvre would distinguish the members of a class."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.special import ndtr

from inertial.arrays import Array
from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.cause import Cause
from inertial.model_selection.evidence import SearchedEffect
from inertial.model_selection.search import Candidates

MIN_SEPARATION = 3.3  # at which the likelier of two members is right in 95 of 100 campaigns


@dataclass(frozen=True)
class Pair:
    """Two members of a class, and their separation without and with an additional manoeuvre.

    Separation: root of the expected difference of chi-squared between the best fit of the wrong
    member and of the right one, whichever of the two is right. `weight`: the product of their
    posterior probabilities, how much the class leaves open between them.
    """

    first: str
    second: str
    present: float
    extended: float
    weight: float = 1.0

    @property
    def distinct(self) -> bool:
        """Whether the likelier of the two would be right in 95 of 100 campaigns."""
        return self.extended >= MIN_SEPARATION


@dataclass(frozen=True)
class Split:
    """How well an additional manoeuvre would distinguish the members of a class.

    `pairs`: in order of decreasing separation.
    """

    manoeuvre: str
    pairs: tuple[Pair, ...]

    @property
    def pair(self) -> Pair:
        """The distinct pair that leaves most open; if there is none, the most separate of all."""
        distinct = [pair for pair in self.pairs if pair.distinct]
        return max(distinct, key=lambda pair: pair.weight, default=self.pairs[0])

    @property
    def rank(self) -> tuple[float, float]:
        """The weight of the distinct pairs, then the weighted sum of the squared separations."""
        squares = sum(pair.weight * pair.extended**2 for pair in self.pairs)
        return sum(pair.weight for pair in self.pairs if pair.distinct), float(squares)


def split(
    present: EffectInformation,
    extended: Mapping[str, EffectInformation],
    effects: Sequence[SearchedEffect],
    causes: Sequence[Cause],
    number: int,
) -> list[Split]:
    """The additional manoeuvres, that which best splits the class of a cause first.

    Each member in turn is taken for the truth, with its estimate from this campaign, and fitted
    by every other member; the other causes stay in the model.

    Parameters
    ----------
    present : the information of the campaign on the effects, all sensors
    extended : the same with each manoeuvre added; its `right` is not used
    number : which of the causes has the class
    """
    others = [(c.effect, c.value) for i, c in enumerate(causes) if i != number]
    rivals = Rivals(present, effects, causes[number].members, others)
    if len(rivals.names) < 2:
        return []
    separations = rivals.separations(present.information)
    weights = dict(zip(causes[number].members, causes[number].weights, strict=True))
    splits = []
    for manoeuvre, with_manoeuvre in extended.items():
        pairs = [
            Pair(*names, separations[names], separation, weights[names[0]] * weights[names[1]])
            for names, separation in rivals.separations(with_manoeuvre.information).items()
        ]
        splits.append(Split(manoeuvre, tuple(sorted(pairs, key=lambda pair: -pair.extended))))
    return sorted(splits, key=lambda split: split.rank, reverse=True)


class Rivals:
    """The members of a class, each as large as a campaign has it if it were the truth.

    Parameters
    ----------
    present : the information of the campaign on the effects, all sensors
    members : of the class; those without columns are left out, such as a random walk: it follows
        no law that a manoeuvre would show
    others : the other causes, which stay in the model, with the place of each in its scan
    """

    def __init__(
        self,
        present: EffectInformation,
        effects: Sequence[SearchedEffect],
        members: Sequence[str],
        others: Sequence[tuple[str, int]],
    ) -> None:
        self._candidates = candidates = Candidates(effects)
        index = {effect.name: i for i, effect in enumerate(effects)}
        places = [
            np.flatnonzero((candidates.effect == index[name]) & (candidates.value == value))
            for name, value in others
        ]
        self._given = candidates.together([int(place[0]) for place in places])
        drops, degrees = candidates.drops(present.information, present.right, self._given)
        self._truths = {}
        for member in (index[member] for member in members if member in index):
            own = np.flatnonzero((candidates.effect == member) & (degrees > 0))
            if len(own):
                place = int(own[np.argmax(drops[own])])
                values = _values(present, candidates.columns[place], self._given)
                self._truths[member] = (place, values)
        self._names = {i: effects[i].name for i in self._truths}

    @property
    def names(self) -> list[str]:
        """The members that are compared."""
        return list(self._names.values())

    def separations(self, information: Array) -> dict[tuple[str, str], float]:
        """For each pair of members the smaller of the two separations."""
        found = _separations(information, self._candidates, self._truths, self._given)
        return {(self._names[i], self._names[j]): size for (i, j), size in found.items()}

    def right_share(self, information: Array) -> float:
        """In which share of campaigns the likeliest member is the right one, at least.

        The difference of chi-squared of two members has the mean δ² and the variance 4 δ², δ being
        their separation.
        """
        wrong = dict.fromkeys(self.names, 0.0)
        for names, separation in self.separations(information).items():
            for name in names:
                wrong[name] += float(ndtr(-separation / 2))
        return 1 - max(wrong.values())


def _values(present: EffectInformation, columns: Sequence[int], given: Sequence[int]) -> Array:
    """The joint fit of some columns and those given, 0 where not observable, (w,)."""
    values, _ = present.estimate(list(dict.fromkeys([*columns, *given])))
    return np.nan_to_num(values[: len(columns)])


def _separations(
    information: Array,
    candidates: Candidates,
    truths: Mapping[int, tuple[int, Array]],
    given: Sequence[int],
) -> dict[tuple[int, int], float]:
    """For each pair of members the smaller of the two separations."""
    excess: dict[tuple[int, int], float] = {}
    for right, (place, values) in truths.items():
        signal = information[:, list(candidates.columns[place])] @ values
        drops, _ = candidates.drops(information, signal, given)
        for wrong in truths:
            if wrong != right:
                own = candidates.effect == wrong
                excess[right, wrong] = max(float(drops[place]) - float(drops[own].max()), 0.0)
    return {
        (i, j): float(np.sqrt(min(excess[i, j], excess[j, i]))) for i, j in combinations(truths, 2)
    }

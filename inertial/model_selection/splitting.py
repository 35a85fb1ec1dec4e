"""Which additional manoeuvre would distinguish the members of a class."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.least_squares import EffectInformation
from inertial.model_selection.cause import Cause
from inertial.model_selection.evidence import SearchedEffect
from inertial.model_selection.scan import Candidates

Array = NDArray[np.float64]

MIN_SEPARATION = 3.3  # at which the likelier of two members is right in 95 of 100 campaigns


@dataclass(frozen=True)
class Pair:
    """Two members of a class, and their separation without and with an additional manoeuvre.

    Separation: root of the expected difference of chi-squared between the best fit of the wrong
    member and of the right one, whichever of the two is right.
    """

    first: str
    second: str
    present: float
    extended: float

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
    def separation(self) -> float:
        """The smallest separation of the distinct pairs; if there is none, the largest of all."""
        distinct = [pair.extended for pair in self.pairs if pair.distinct]
        return min(distinct) if distinct else self.pairs[0].extended

    @property
    def rank(self) -> tuple[int, float]:
        """The number of distinct pairs, then the sum of the squared separations."""
        squares = sum(pair.extended**2 for pair in self.pairs)
        return sum(pair.distinct for pair in self.pairs), float(squares)


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
    candidates = Candidates(effects)
    index = {effect.name: i for i, effect in enumerate(effects)}
    # A random walk is no member with columns: it follows no law that a manoeuvre would show.
    members = [index[member] for member in causes[number].members if member in index]
    if len(members) < 2:
        return []
    others = [
        int(
            np.flatnonzero((candidates.effect == index[c.effect]) & (candidates.value == c.value))[
                0
            ]
        )
        for i, c in enumerate(causes)
        if i != number
    ]
    given = candidates.together(others)
    drops, degrees = candidates.drops(present.information, present.right, given)
    truths = {}
    for member in members:
        own = np.flatnonzero((candidates.effect == member) & (degrees > 0))
        place = int(own[np.argmax(drops[own])])
        truths[member] = (place, _values(present, candidates.columns[place], given))
    separations = _separations(present.information, candidates, truths, given)
    splits = []
    for manoeuvre, with_manoeuvre in extended.items():
        pairs = [
            Pair(effects[i].name, effects[j].name, separations[i, j], separation)
            for (i, j), separation in _separations(
                with_manoeuvre.information, candidates, truths, given
            ).items()
        ]
        splits.append(Split(manoeuvre, tuple(sorted(pairs, key=lambda pair: -pair.extended))))
    return sorted(splits, key=lambda split: split.rank, reverse=True)


def _values(present: EffectInformation, columns: Sequence[int], given: Sequence[int]) -> Array:
    """The joint estimate of some columns and those given, 0 where not observable, (w,)."""
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

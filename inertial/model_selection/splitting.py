"""Which further manoeuvre would tell the members of a class apart."""

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

TELLS = 3.3  # separation at which the likelier of two members is right in 95 of 100 campaigns


@dataclass(frozen=True)
class Pair:
    """Two members of a class, and how well they are told apart: now, and with a manoeuvre.

    Root of the expected difference of chi-squared between the best fit of the wrong one and of
    the right one, whichever of the two is right.
    """

    one: str
    other: str
    now: float
    then: float

    @property
    def told(self) -> bool:
        """Whether the likelier of the two would be right in 95 of 100 campaigns."""
        return self.then >= TELLS


@dataclass(frozen=True)
class Split:
    """How well the members of a class would be told apart with a further manoeuvre.

    `pairs`: the best told first.
    """

    manoeuvre: str
    pairs: tuple[Pair, ...]

    @property
    def separation(self) -> float:
        """The signal-to-noise ratio of the split: of the weakest pair that is told apart.

        Where none is, that of the best pair.
        """
        told = [pair.then for pair in self.pairs if pair.told]
        return min(told) if told else self.pairs[0].then

    @property
    def rank(self) -> tuple[int, float]:
        """The more pairs are told apart, then the more clearly, the better."""
        return sum(pair.told for pair in self.pairs), float(sum(p.then**2 for p in self.pairs))


def split(
    now: EffectInformation,
    further: Mapping[str, EffectInformation],
    effects: Sequence[SearchedEffect],
    causes: Sequence[Cause],
    number: int,
) -> list[Split]:
    """All manoeuvres, the one that splits the class of a cause best first.

    Each member in turn is taken for the truth, as large as this campaign has it, and fitted by
    every other member; the other causes stay in the model.

    Parameters
    ----------
    now : what the campaign says of the effects, all sensors
    further : the information of the campaign with each manoeuvre added; its `right` is not used
    number : which of the causes has the class
    """
    candidates = Candidates(effects)
    index = {one.name: i for i, one in enumerate(effects)}
    members = [index[member] for member in causes[number].members]
    others = [
        int(
            np.flatnonzero((candidates.effect == index[c.effect]) & (candidates.value == c.value))[
                0
            ]
        )
        for i, c in enumerate(causes)
        if i != number
    ]
    beside = candidates.together(others)
    drops, degrees = candidates.drops(now.information, now.right, beside)
    truths = {}
    for member in members:
        own = np.flatnonzero((candidates.effect == member) & (degrees > 0))
        place = int(own[np.argmax(drops[own])])
        truths[member] = (place, _values(now, candidates.columns[place], beside))
    now_told = _separations(now.information, candidates, truths, beside)
    found = []
    for manoeuvre, extended in further.items():
        then_told = _separations(extended.information, candidates, truths, beside)
        pairs = [
            Pair(effects[one].name, effects[other].name, now_told[one, other], separation)
            for (one, other), separation in then_told.items()
        ]
        found.append(Split(manoeuvre, tuple(sorted(pairs, key=lambda pair: -pair.then))))
    return sorted(found, key=lambda one: one.rank, reverse=True)


def _values(now: EffectInformation, columns: Sequence[int], beside: Sequence[int]) -> Array:
    """The estimate of some columns beside others, 0 where the data do not show one, (w,)."""
    every = list(dict.fromkeys([*columns, *beside]))
    values, _ = now.estimate(every)
    return np.nan_to_num(values[: len(columns)])


def _separations(
    information: Array,
    candidates: Candidates,
    truths: Mapping[int, tuple[int, Array]],
    beside: Sequence[int],
) -> dict[tuple[int, int], float]:
    """For each pair of members the smaller of the two separations."""
    lost: dict[tuple[int, int], float] = {}
    for right_one, (place, values) in truths.items():
        signal = information[:, list(candidates.columns[place])] @ values
        left, _ = candidates.drops(information, signal, beside)
        for wrong_one in truths:
            if wrong_one != right_one:
                own = candidates.effect == wrong_one
                lost[right_one, wrong_one] = max(float(left[place]) - float(left[own].max()), 0.0)
    return {
        (one, other): float(np.sqrt(min(lost[one, other], lost[other, one])))
        for one, other in combinations(truths, 2)
    }

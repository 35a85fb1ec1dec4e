"""The set of effects that explains the data best, each at its price."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.model_selection.cause import Named
from inertial.model_selection.evidence import Evidence, SearchedEffect
from inertial.model_selection.scan import Candidates, joint_drop

# ---- Finer values of a scan where an effect was found: a second look, at the right value.
#
# A scan whose steps suffice to find an effect leaves a trace of a strong one, whose true value
# lies between two steps; that trace may be given a name of its own. So the evidence is built again
# with finer values about those that were found, and the causes are named from it.

Array = NDArray[np.float64]


def to_refine(
    evidence: Evidence, named: Named, effects: Sequence[SearchedEffect], sharp: float = 0.0
) -> dict[str, tuple[int, ...]]:
    """Which values of which scans: those of every member of a cause, beside the others and alone.

    Alone, because what a coarse scan leaves may have been given to others. `sharp`: the
    signal-to-noise ratio from which on a cause is worth it.
    """
    seen = evidence.seen()
    if not seen.sensors:
        return {}
    candidates = Candidates(effects)
    total = seen.total
    drops, _ = candidates.drops(total.information, total.right)
    found: dict[str, set[int]] = {}
    for cause in named.causes:
        if cause.snr < sharp:
            continue
        for member, value in zip(cause.members, cause.member_values, strict=True):
            found.setdefault(member, set()).add(value)
    refined = {}
    for number, one in enumerate(effects):
        if one.name in found and len(one.candidates) > 1 and one.between and not one.free:
            alone = int(np.argmax(drops[candidates.effect == number]))
            refined[one.name] = tuple(sorted(found[one.name] | {alone}))
    return refined


def finer(values: Array, chosen: Sequence[int], steps: int) -> Array:
    """The values of a scan with so many steps in each interval beside those chosen, sorted."""
    beside = {i for place in chosen for i in (place - 1, place) if 0 <= i < len(values) - 1}
    near = [np.linspace(values[i], values[i + 1], steps + 1)[1:-1] for i in sorted(beside)]
    return np.sort(np.concatenate([values, *near]))


# ---- The set of effects that explains the data best, each at its price.
#
# An effect's price is the drop of chi-squared from which on it is named on its own, so a larger
# set is chosen only where each of its effects earns what chance would not. Several sets are
# followed at once and their effects exchanged, for the effect that explains most alone need not
# be in the best pair (design study: forward selection alone loses one campaign of ten with three
# effects).

FOLLOWED = 6  # sets of each size
LARGEST = 6  # effects in a set


@dataclass(frozen=True, order=True)
class Set:
    """Some candidates, by place, and by how much their drop exceeds their price."""

    gain: float
    places: tuple[int, ...]


class Search:
    """The search for the best set in one campaign.

    `prices`: of each effect, (m,).
    """

    def __init__(
        self, candidates: Candidates, prices: Array, information: Array, right: Array
    ) -> None:
        self.candidates = candidates
        self.information = information
        self.right = right
        self.prices = np.asarray(prices)[candidates.effect]

    def best(self) -> tuple[Set, list[Set]]:
        """The best set of all, and the best ones of its size."""
        best = Set(0.0, ())
        level = peers = [best]
        for _ in range(LARGEST):
            level = self._larger(level)
            if not level:
                break
            if level[0].gain > best.gain:
                best, peers = level[0], level
            elif not best.places or len(level[0].places) > len(best.places) + 1:
                break
        return best, peers

    def _larger(self, sets: Sequence[Set]) -> list[Set]:
        found: dict[frozenset[int], Set] = {}
        for one in sets:
            self._keep(found, self._with_one_more(one.places, FOLLOWED))
        grown = sorted(found.values(), reverse=True)[:FOLLOWED]
        for one in grown:
            self._keep(found, self._exchanged(one))
        return sorted(found.values(), reverse=True)[:FOLLOWED]

    def _keep(self, found: dict[frozenset[int], Set], sets: Sequence[Set]) -> None:
        """Of sets of the same effects the best is kept."""
        for one in sets:
            key = frozenset(int(e) for e in self.candidates.effect[list(one.places)])
            if key not in found or found[key].gain < one.gain:
                found[key] = one

    def _with_one_more(self, places: tuple[int, ...], number: int) -> list[Set]:
        """The best sets with one effect more."""
        gain = self.gain(places)
        more, degrees = self.candidates.drops(
            self.information, self.right, self.candidates.around(places)
        )
        more = np.where(degrees > 0, more - self.prices, -np.inf)
        more[np.isin(self.candidates.effect, self.candidates.effect[list(places)])] = -np.inf
        sets = []
        for _ in range(number):
            place = int(np.argmax(more))
            if not np.isfinite(more[place]):
                break
            sets.append(Set(gain + float(more[place]), (*places, place)))
            more[self.candidates.effect == self.candidates.effect[place]] = -np.inf
        return sets

    def _exchanged(self, one: Set) -> list[Set]:
        """Each effect in turn for the best in its place, or for another value of its scan."""
        if len(one.places) == 1:
            return []
        return [
            better
            for place in one.places
            for better in self._with_one_more(tuple(p for p in one.places if p != place), 2)
        ]

    def gain(self, places: Sequence[int]) -> float:
        """By how much the drop of a set exceeds the price of its effects."""
        columns = self.candidates.together(places)
        price = float(np.sum(self.prices[list(places)]))
        return joint_drop(self.information, self.right, columns) - price

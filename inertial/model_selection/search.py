"""The set of effects that best explains the data, each above its detection threshold."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Integers
from inertial.model_selection.cause import NamedCauses
from inertial.model_selection.evidence import Evidence, SearchedEffect
from inertial.model_selection.scan import Candidates, joint_drop

# ---- Refined scans of the named effects.
#
# A scan whose steps suffice to detect an effect leaves a residual of a strong effect whose true
# value lies between two steps, and that residual may be named as another effect. So the evidence
# is built again with finer values about the detected ones, and the causes are named from it.


def to_refine(
    evidence: Evidence, named: NamedCauses, effects: Sequence[SearchedEffect], min_snr: float = 0.0
) -> dict[str, tuple[int, ...]]:
    """The values to refine of each scan: the best of each member, jointly fitted and alone.

    Alone, because other effects may have absorbed the residual of a coarse scan. `min_snr`:
    signal-to-noise ratio from which a cause is refined.
    """
    observable = evidence.observable()
    if not observable.sensors:
        return {}
    candidates = Candidates(effects)
    total = observable.total
    drops, _ = candidates.drops(total.information, total.right)
    best: dict[str, set[int]] = {}
    for cause in named.causes:
        if cause.snr < min_snr:
            continue
        for member, value in zip(cause.members, cause.member_values, strict=True):
            best.setdefault(member, set()).add(value)
    refined = {}
    for number, effect in enumerate(effects):
        scanned = len(effect.candidates) > 1 and effect.between and not effect.free
        if effect.name in best and scanned:
            alone = int(np.argmax(drops[candidates.effect == number]))
            refined[effect.name] = tuple(sorted(best[effect.name] | {alone}))
    return refined


def finer(values: Array, chosen: Sequence[int], steps: int) -> Array:
    """The values of a scan with `steps` steps in each interval next to those chosen, sorted."""
    intervals = {i for place in chosen for i in (place - 1, place) if 0 <= i < len(values) - 1}
    added = [np.linspace(values[i], values[i + 1], steps + 1)[1:-1] for i in sorted(intervals)]
    return np.sort(np.concatenate([values, *added]))


# ---- The set of effects that best explains the data: beam search with exchanges.
#
# The threshold of an effect is the drop of chi-squared from which it is named on its own, so a
# larger set is chosen only where each of its effects explains more than chance would. Several
# sets are kept at once and their effects exchanged, for the effect that explains most alone need
# not be in the best pair (design study: forward selection alone misses an effect in one campaign
# of ten with three effects).

BEAM_WIDTH = 6  # sets of each size
MAX_EFFECTS = 6  # in a set


@dataclass(frozen=True, order=True)
class Set:
    """Some candidates, by place, and by how much their drop exceeds their thresholds."""

    gain: float
    places: tuple[int, ...]


class Search:
    """The search for the best set in one campaign.

    `thresholds`: of each effect, (m,).
    """

    def __init__(
        self, candidates: Candidates, thresholds: Array, information: Array, right: Array
    ) -> None:
        self.candidates = candidates
        self.information = information
        self.right = right
        self.thresholds = np.asarray(thresholds)[candidates.effect]
        self._drops: dict[frozenset[int], tuple[Array, Integers]] = {}  # given some places

    def best(self) -> tuple[Set, list[Set]]:
        """The best set of all, and the best ones of its size."""
        best = Set(0.0, ())
        level = peers = [best]
        for _ in range(MAX_EFFECTS):
            level = self._larger(level)
            if not level:
                break
            if level[0].gain > best.gain:
                best, peers = level[0], level
            elif not best.places or len(level[0].places) > len(best.places) + 1:
                break
        return best, peers

    def _larger(self, sets: Sequence[Set]) -> list[Set]:
        kept: dict[frozenset[int], Set] = {}
        for smaller in sets:
            self._keep(kept, self._extended(smaller.places, BEAM_WIDTH))
        extended = sorted(kept.values(), reverse=True)[:BEAM_WIDTH]
        for candidate in extended:
            self._keep(kept, self._exchanged(candidate))
        return sorted(kept.values(), reverse=True)[:BEAM_WIDTH]

    def _keep(self, kept: dict[frozenset[int], Set], sets: Sequence[Set]) -> None:
        """Keep the best of the sets of the same effects."""
        for candidate in sets:
            key = frozenset(int(e) for e in self.candidates.effect[list(candidate.places)])
            if key not in kept or kept[key].gain < candidate.gain:
                kept[key] = candidate

    def _extended(self, places: tuple[int, ...], number: int) -> list[Set]:
        """The best sets with an additional effect."""
        gain = self.gain(places)
        more, degrees = self._drops_given(places)
        more = np.where(degrees > 0, more - self.thresholds, -np.inf)
        more[np.isin(self.candidates.effect, self.candidates.effect[list(places)])] = -np.inf
        sets = []
        for _ in range(number):
            place = int(np.argmax(more))
            if not np.isfinite(more[place]):
                break
            larger = (*places, place)
            if self.candidates.possible(self.information, self.right, larger):
                sets.append(Set(gain + float(more[place]), larger))
            more[self.candidates.effect == self.candidates.effect[place]] = -np.inf
        return sets

    def _drops_given(self, places: tuple[int, ...]) -> tuple[Array, Integers]:
        """The drops of all candidates given some; exchanges come to the same ones repeatedly."""
        given = frozenset(places)
        if given not in self._drops:
            around = self.candidates.around(places)
            self._drops[given] = self.candidates.drops(self.information, self.right, around)
        return self._drops[given]

    def _exchanged(self, original: Set) -> list[Set]:
        """Each effect in turn replaced by the best other, or by another value of its scan."""
        if len(original.places) == 1:
            return []
        return [
            exchanged
            for place in original.places
            for exchanged in self._extended(tuple(p for p in original.places if p != place), 2)
        ]

    def gain(self, places: Sequence[int]) -> float:
        """By how much the drop of a set exceeds the thresholds of its effects."""
        columns = self.candidates.together(places)
        threshold = float(np.sum(self.thresholds[list(places)]))
        return joint_drop(self.information, self.right, columns) - threshold

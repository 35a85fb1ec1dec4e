"""The set of effects that best explains the data, each above its detection threshold."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Integers
from inertial.estimation.effect_information import sizes_of
from inertial.model_selection.cause import NamedCauses
from inertial.model_selection.evidence import Evidence, SearchedEffect

# ---- Reduction of chi-squared by every candidate, given what is already in the model.

MAX_BATCH = 20_000  # groups times data sets in one array
MIN_EIGENVALUE = 1e-6  # of the information scaled to unit diagonal; below: not observable


@dataclass(frozen=True)
class Width:
    """Candidates of the same number of columns: their places (g,) and columns (g, w)."""

    places: Integers
    columns: Integers


class Candidates:
    """All candidates of all effects in one sequence, and the reduction of chi-squared by each.

    `effect`: (c,) which effect each belongs to; `value`: (c,) which value of its scan.
    """

    def __init__(self, effects: Sequence[SearchedEffect]) -> None:
        self.effects = tuple(effects)
        listed = [
            (number, value, columns)
            for number, effect in enumerate(effects)
            for value, columns in enumerate(effect.candidates)
        ]
        self.columns = [columns for _, _, columns in listed]
        self.effect = np.array([number for number, _, _ in listed], dtype=np.int64)
        self.value = np.array([value for _, value, _ in listed], dtype=np.int64)
        only = np.array([np.nan if e.only is None else e.only for e in effects], np.float64)
        self.only = only[self.effect]
        self.positive = np.array([e.positive for e in effects], dtype=bool)[self.effect]
        widths = np.array([len(columns) for columns in self.columns], dtype=np.int64)
        self.widths = [
            Width(
                np.flatnonzero(widths == width),
                np.array([c for c in self.columns if len(c) == width], dtype=np.int64),
            )
            for width in np.unique(widths[widths > 0])
        ]

    def __len__(self) -> int:
        return len(self.columns)

    def together(self, places: Sequence[int]) -> list[int]:
        """The columns of some candidates, each once."""
        return list(dict.fromkeys(i for place in places for i in self.columns[place]))

    def around(self, places: Sequence[int]) -> list[int]:
        """The same with the neighbours in each scan, between which the true value may lie."""
        near = [
            neighbour
            for place in places
            for neighbour in self._neighbours(place)
            if 0 <= neighbour < len(self) and self.effect[neighbour] == self.effect[place]
        ]
        return self.together(near)

    def _neighbours(self, place: int) -> tuple[int, ...]:
        between = self.effects[self.effect[place]].between
        return (place, place - 1, place + 1) if between else (place,)

    def possible(self, information: Array, right: Array, places: Sequence[int]) -> bool:
        """Whether no value that cannot be negative is, where some candidates are together."""
        positive = [place for place in places if self.positive[place]]
        if not positive:
            return True
        own = self.together(places)
        white = _white(information, own)
        values = dict(zip(own, white.T @ (white @ right[own]), strict=True))
        return all(values[self.columns[place][0]] >= 0 for place in positive)

    def drops(
        self, information: Array, right: Array, given: Sequence[int] = ()
    ) -> tuple[Array, Integers]:
        """Drop of chi-squared by each candidate given some columns, and its degrees, (c,).

        `right`: (k,), or (k, n) for n data sets at once: then the drops are (c, n).
        """
        size = sizes_of(information)
        many = right.reshape(len(right), -1)
        projection = np.zeros((0, len(right)))
        if len(given):
            white = _white(information, given)
            projection = white @ information[list(given)]
            many = many - projection.T @ (white @ many[list(given)])
        drop = np.zeros((len(self), many.shape[1]))
        degrees = np.zeros(len(self), dtype=np.int64)
        for width in self.widths:
            c = width.columns
            projected = projection[:, c]
            block = information[c[:, :, None], c[:, None, :]]
            block = block - np.einsum("qgi,qgj->gij", projected, projected)
            values, vectors = _modes(block, size[c])
            white = (vectors * _inverse(values)[:, None, :]).transpose(0, 2, 1)
            for batch in _batches(len(c), many.shape[1]):
                along = white[batch] @ many[c[batch]]
                misfit = self._misfit(width.places[batch], values[batch], vectors[batch], along)
                drops = np.einsum("gij,gij->gj", along, along) - misfit
                drops[self.positive[width.places[batch], None] & (many[c[batch, 0]] < 0)] = 0.0
                drop[width.places[batch]] = drops
            degrees[width.places] = np.sum(values > 0, axis=1)
        return np.maximum(drop, 0.0).reshape(len(self), *right.shape[1:]), degrees

    def _misfit(self, places: Integers, values: Array, vectors: Array, along: Array) -> Array:
        """What chi-squared grows by as a column has the only value that it can have, (g, n)."""
        only = self.only[places]
        fixed = ~np.isnan(only)
        misfit = np.zeros((len(places), along.shape[2]))
        own = values[fixed, 0]  # 0 where there is no information
        root = np.sqrt(own) / np.where(own > 0, vectors[fixed, 0, 0], 1.0)
        misfit[fixed] = (along[fixed, 0] - (only[fixed] * root)[:, None]) ** 2
        return misfit


def _batches(groups: int, draws: int) -> list[slice]:
    """Slices of the groups of which the arrays stay small."""
    step = max(MAX_BATCH // max(draws, 1), 1)
    return [slice(start, start + step) for start in range(0, groups, step)]


def joint_drop(information: Array, right: Array, columns: Sequence[int]) -> float:
    """The drop of chi-squared with some columns together."""
    if not len(columns):
        return 0.0
    return float(np.sum((_white(information, columns) @ right[list(columns)]) ** 2))


def _white(information: Array, columns: Sequence[int]) -> Array:
    """Combinations of the columns, (w, w), that are independent and of unit information."""
    block = information[np.ix_(columns, columns)]
    values, vectors = _modes(block[None], sizes_of(block)[None])
    white: Array = (vectors[0] * _inverse(values[0])).T
    return white


def _modes(block: Array, size: Array) -> tuple[Array, Array]:
    """Information (g, w), 0 where there is none, and combinations (g, w, w), of blocks."""
    values, vectors = np.linalg.eigh(block / (size[:, :, None] * size[:, None, :]))
    return np.where(values > MIN_EIGENVALUE, values, 0.0), vectors / size[:, :, None]


def _inverse(values: Array) -> Array:
    """Root of the inverse, 0 where there is no information."""
    return np.where(values > 0, 1 / np.sqrt(np.where(values > 0, values, 1.0)), 0.0)


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

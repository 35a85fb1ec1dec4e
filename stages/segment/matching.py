"""Which stretch of a window is which manoeuvre, and which records are which phase of it.

By the axes as the sensors are taken to be read.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.campaign.records import Manoeuvre
from inertial.signal.axis_permutations import Permutation
from inertial.signal.rests_and_motions import (
    BinStretch,
    moving,
    steady_part,
    stretches,
    with_slow_ends,
)
from stages.segment.windows import Binned

MAX_MOUNTING_ANGLE = np.radians(25)  # how far an IMU may be mounted from the planned direction
FAR_LESS = 0.5  # by which share a rest at that angle fits less than one in the planned direction
MAX_AXIS_ANGLE = np.radians(45)  # and a turn about another axis than the planned one, as by hand
MIN_RECORDED_SHARE = 0.9  # share of the planned direction in the axes that are recorded, to show it
WRONG_SENSE_SCORE = 0.01  # score of a turn against the planned direction
# The same of one by the planned angle: more than that of a small motion the right way, or of a
# quarter of the turn between two positions; two of them less than that of one turn as planned.
WHOLE_WRONG_SENSE_SCORE = 0.3
MAX_WHOLE_DIFFERENCE = 0.1  # of the planned angle, up to which it is by that angle
MIN_ALIKE_COSINE = float(np.cos(np.radians(1)))  # of directions of rests that look the same
MIN_QUIETER = 25.0  # of chi-squared: by less, parts of a still stretch change alike
MOVES_OF_PARTS = 3  # rounds in which each part is moved between its neighbours
MIN_ROOM = 0.9  # share of the time of several rests that a still stretch must last to hold them
MIN_SCALED_TURNS = 2  # turns of a window that show one ratio to their plan, in another unit
MIN_SCALE_RATIO = 1.5  # a ratio that the score of a turn as it is planned does not allow for


def align(scores: Array) -> list[int | None]:
    """Match rows to columns in ascending order so that the sum of the scores is largest.

    Parameters
    ----------
    scores : (m, n), how well manoeuvre i fits stretch j; 0 or less where it does not

    Returns
    -------
    for each manoeuvre its stretch, or None where it is not found. Stretches may be
    left over: anything may happen between two manoeuvres.
    """
    m, n = scores.shape
    best = np.zeros((m + 1, n + 1))
    for i in range(1, m + 1):
        together = np.where(scores[i - 1] > 0, best[i - 1, :-1] + scores[i - 1], -1.0)
        best[i, 1:] = np.maximum.accumulate(np.maximum(best[i - 1, 1:], together))
    stretches_of: list[int | None] = [None] * m
    i, j = m, n
    while i and j:
        if best[i, j] == best[i - 1, j]:
            i -= 1
        elif best[i, j] == best[i, j - 1]:
            j -= 1
        else:
            i, j = i - 1, j - 1
            stretches_of[i] = j
    return stretches_of


def rest_scores(seconds: Array, planned: float | None, forces: Array, up: Array | None) -> Array:
    """How well stretches at rest fit a planned rest: by duration and direction, (n,).

    Parameters
    ----------
    forces : (n, 3), m/s², mean specific force, NaN where not recorded
    up : (3,), the planned direction, None where unknown
    """
    scores = np.minimum(seconds / planned, 1.0) if planned else seconds / (seconds + 1.0)
    if up is None:
        return scores
    # Of a table that is indexed in small steps several rests are near: the nearest fits best.
    off = angles_from(forces, up) / MAX_MOUNTING_ANGLE
    return np.where(off <= 1.0, scores * (1.0 - FAR_LESS * off**2), 0.0)


def angles_from(forces: Array, up: Array) -> Array:
    """By which angles specific forces, (…, 3), point away from the planned up, rad, (…,).

    As far as their axes are recorded; 0 where the axis that would show it is not.
    """
    there = np.isfinite(forces)
    known = np.where(there, forces, 0.0)
    recorded = np.linalg.norm(there * up, axis=-1)
    size = np.linalg.norm(known, axis=-1) * recorded
    cosine = np.divide(known @ up, size, out=np.ones_like(size), where=size > 0)
    angles = np.arccos(np.clip(cosine, -1.0, 1.0))
    return np.asarray(np.where(recorded < MIN_RECORDED_SHARE, 0.0, angles))


def points(forces: Array, up: Array) -> Booleans:
    """Whether specific forces, (…, 3), point up as planned, as far as their axes are recorded."""
    return np.asarray(angles_from(forces, up) <= MAX_MOUNTING_ANGLE)


def turn_scores(turned: Array, about: Array, planned: float | None) -> Array:
    """How well motions fit a planned turn: by angle, rad, or rate, rad/s, (n,).

    A turn in the wrong direction is still the turn, unless a better one is there; by the planned
    angle, it is rather the turn than a small part of it is. A turn about another axis is not.

    Parameters
    ----------
    turned : (n, 3), angles or rates about the axes of the body, NaN where not recorded
    about : (3,), the planned axis
    """
    own = np.nan_to_num(turned)
    angle = own @ about
    if planned is None:
        scores = np.abs(angle) / (np.abs(angle) + 0.1)
    else:
        ratio = angle / planned
        forward = np.where(ratio > 0.005, np.maximum(1.0 - np.abs(1.0 - ratio), 0.02), 0.0)
        scores = np.where(ratio < -0.5, WRONG_SENSE_SCORE, forward)
        whole = np.abs(ratio + 1.0) <= MAX_WHOLE_DIFFERENCE
        scores = np.where(whole, WHOLE_WRONG_SENSE_SCORE, scores)
    other_axis = np.abs(angle) < np.cos(MAX_AXIS_ANGLE) * np.linalg.norm(own, axis=1)
    return np.where(other_axis, 0.0, scores)


BETWEEN = "between"  # from a rest to the next, where attitudes are unknown: what carries them on


@dataclass(frozen=True)
class Part:
    """One phase of one manoeuvre: records [first, after) of its log."""

    manoeuvre: str
    phase: str
    log: str
    first: int
    after: int


@dataclass(frozen=True)
class Observation:
    """What a stretch shows: seconds; force and rate, (3,), means; turned, (3,), angles, rad.

    NaN where an axis is not recorded; rates and angles are those above the gyros' level at rest.
    unsure: (3,), rad/s, sigma of the mean rate.
    """

    moves: bool
    seconds: float
    force: Array
    rate: Array
    turned: Array
    unsure: Array


def observe(binned: Binned, stretches: Sequence[BinStretch], level: Array) -> list[Observation]:
    """What each stretch of a window shows; `level` is what the gyros read at rest."""
    return [_observation(binned, stretch, level) for stretch in stretches]


def _observation(binned: Binned, stretch: BinStretch, level: Array) -> Observation:
    inside = slice(stretch.first, stretch.after)
    rates, seconds = binned.rates[inside] - level, binned.seconds[inside]
    mean, number = _mean(rates), np.isfinite(rates).sum(axis=0)
    angles = np.nansum(rates * seconds[:, None], axis=0)
    return Observation(
        stretch.moves,
        float(seconds.sum()),
        _mean(binned.forces[inside]),
        mean,
        np.where(number > 0, angles, np.nan),
        np.sqrt(_mean((rates - mean) ** 2) / np.maximum(number, 1)),
    )


def _mean(values: Array) -> Array:
    """Means of the columns of (k, 3), NaN where nothing is."""
    there = np.isfinite(values)
    number = there.sum(axis=0)
    total = np.where(there, values, 0.0).sum(axis=0)
    return np.where(number > 0, total / np.maximum(number, 1), np.nan)


def match(
    manoeuvres: Sequence[Manoeuvre], observed: Sequence[Observation]
) -> dict[str, int | None]:
    """For each manoeuvre of a window its stretch, None where it is not found."""
    sought = [m for m in manoeuvres if m.do != "positions"]
    seen = _Seen.of(observed)
    places = align(seen.scores(sought))
    turns = [k for k, m in enumerate(sought) if m.do == "turn"]
    if len(turns) >= MIN_SCALED_TURNS:
        ratios = seen.ratios([sought[k] for k in turns])
        found = [
            0.0 if places[k] is None else row[places[k]]
            for k, row in zip(turns, ratios, strict=True)
        ]
        if np.count_nonzero(_by_the_plan(np.array(found))) < len(turns) / 2:
            places = _by_one_ratio(seen, sought, turns, ratios) or places
    return {m.name: place for m, place in zip(sought, places, strict=True)}


@dataclass(frozen=True)
class _Seen:
    """What the n stretches of a window show, as arrays: (n,), and (n, 3) as of Observation."""

    moves: Booleans
    seconds: Array
    forces: Array
    rates: Array
    turned: Array

    @classmethod
    def of(cls, observed: Sequence[Observation]) -> "_Seen":
        forces, rates, turned = (
            np.array([getattr(o, name) for o in observed], np.float64).reshape(-1, 3)
            for name in ("force", "rate", "turned")
        )
        moves = np.array([o.moves for o in observed], np.bool_)
        return cls(moves, np.array([o.seconds for o in observed], float), forces, rates, turned)

    def turn(self, m: Manoeuvre) -> tuple[Array, float | None]:
        """What is compared of a turn: rates or angles, (n, 3), and the planned one."""
        return (self.rates, m.rate) if m.recorded == "steady" else (self.turned, m.angle)

    def ratios(self, turns: Sequence[Manoeuvre]) -> Array:
        """Every stretch over the plan of each of m turns, (m, n); 1 where nothing is planned."""
        rows = []
        for m in turns:
            own, planned = self.turn(m)
            rows.append(np.nan_to_num(own) @ m.axis / planned if planned else np.ones(len(own)))
        return np.array(rows)

    def scores(self, sought: Sequence[Manoeuvre], ratio: float = 1.0) -> Array:
        """How well each of m manoeuvres fits each stretch, (m, n).

        `ratio`: by how many times the gyros read too much.
        """
        rows = [self._scores(m, ratio) for m in sought]
        return np.array(rows, np.float64).reshape(len(sought), len(self.moves))

    def _scores(self, m: Manoeuvre, ratio: float) -> Array:
        if m.do == "rest":
            return np.where(
                self.moves, 0.0, rest_scores(self.seconds, m.seconds, self.forces, m.up)
            )
        own, planned = self.turn(m)
        return np.where(self.moves, turn_scores(own / ratio, m.axis, planned), 0.0)


def _by_the_plan(ratios: Array) -> Booleans:
    sizes = np.abs(ratios)
    return np.asarray((sizes > 1 / MIN_SCALE_RATIO) & (sizes < MIN_SCALE_RATIO))


def _by_one_ratio(
    seen: _Seen, sought: Sequence[Manoeuvre], turns: Sequence[int], ratios: Array
) -> list[int | None] | None:
    """The places where every turn is the same multiple of its plan, as in another unit.

    Of all that moves in a long log the changes of position are then as near to the plan as the
    turns are, or nearer. None where no ratio has all turns to within MAX_WHOLE_DIFFERENCE.
    `ratios`: of the turns, which are numbers among the manoeuvres, as of _Seen.
    """
    first = np.abs(ratios[0, seen.moves])
    for ratio in np.sort(first[(first > 0) & ~_by_the_plan(first)])[::-1]:
        near = seen.moves & (np.abs(ratios / ratio - 1) <= MAX_WHOLE_DIFFERENCE)
        if near.any(axis=1).all():
            places = align(seen.scores(sought, float(ratio)))
            found = [places[k] for k in turns]
            if all(
                place is not None and own[place] for place, own in zip(found, near, strict=True)
            ):
                return places
    return None


def motion(binned: Binned, stretches: Sequence[BinStretch], place: int) -> tuple[int, int]:
    """The bins of a turn; in a window of its own it is all that moves, pauses included."""
    if binned.window.alone:
        moves = [stretch for stretch in stretches if stretch.moves]
        return moves[0].first, moves[-1].after
    return stretches[place].first, stretches[place].after


def rest_part(binned: Binned, stretch: BinStretch, name: str, margin: float) -> Part:
    """A rest without the margin beside a motion."""
    room = binned.bins_in(margin)
    first = stretch.first + (room if stretch.first > 0 else 0)
    after = stretch.after - (room if stretch.after < binned.bins else 0)
    first, after = (first, after) if after > first else (stretch.first, stretch.after)
    return Part(name, "rest", binned.window.log, int(binned.edges[first]), int(binned.edges[after]))


def position_parts(
    binned: Binned,
    stretches: Sequence[BinStretch],
    m: Manoeuvre,
    matched: Mapping[str, int | None],
    margin: float,
) -> Iterator[Part]:
    """Every rest that is long enough and no other manoeuvre's, numbered."""
    number = 0
    for place, stretch in enumerate(stretches):
        seconds = float(binned.seconds[stretch.first : stretch.after].sum())
        free = not stretch.moves and place not in matched.values()
        if free and seconds >= (m.seconds or 0.0):
            number += 1
            yield rest_part(binned, stretch, m.detected_rest(number), margin)


def between_parts(rests: Sequence[Part]) -> Iterator[Part]:
    """All that lies between each rest and the next one of the same log."""
    for before, behind in pairwise(sorted(rests, key=lambda part: (part.log, part.first))):
        if before.log == behind.log and before.after < behind.first:
            name = f"{before.manoeuvre} to {behind.manoeuvre}"
            yield Part(name, BETWEEN, before.log, before.after, behind.first)


def _first_of(rest: BinStretch, room: int, shared: bool) -> int:
    """Where the rest before a turn begins; the turn before it, if any, has the first half."""
    if shared:
        return (rest.first + rest.after) // 2
    return min(rest.first + (room if rest.first > 0 else 0), rest.after)


def _after_of(rest: BinStretch, room: int, shared: bool, bins: int) -> int:
    """Where the rest after a turn ends; the turn behind it, if any, has the second half."""
    if shared:
        return (rest.first + rest.after) // 2
    return max(rest.after - (room if rest.after < bins else 0), rest.first)


def turn_parts(
    binned: Binned,
    stretches: Sequence[BinStretch],
    m: Manoeuvre,
    matched: Mapping[str, int | None],
    level: Array,
    margin: float,
) -> Iterator[Part]:
    """The phases of a turn, and the rests beside it that no other manoeuvre has."""
    place = matched[m.name]
    assert place is not None  # only a turn that was found has phases
    first, after = motion(binned, stretches, place)
    room = binned.bins_in(margin)
    start, stop = max(first - room, 0), min(after + room, binned.bins)
    taken = set(matched.values())
    free = [place + side not in taken for side in (-1, 1)]
    before, behind = 0, binned.bins
    if not binned.window.alone and place > 0:
        before = _first_of(stretches[place - 1], room, place - 2 in taken)
    if not binned.window.alone and place + 1 < len(stretches):
        behind = _after_of(stretches[place + 1], room, place + 2 in taken, binned.bins)

    phases: list[tuple[str, int, int]] = []
    if free[0] and first > 0:
        phases.append(("rest-before", before, start))
    if m.rate is None:
        phases.append(("turning", start, stop))
    else:
        a, b = steady_part(binned.about(m.axis, level)[first:after])
        steady = (first + a, first + b)
        phases += [
            ("spin-up", start, steady[0]),
            ("steady", *steady),
            ("spin-down", steady[1], stop),
        ]
    if free[1] and after < binned.bins:
        phases.append(("rest-after", stop, behind))
    for phase, a, b in phases:
        if b > a:
            yield Part(m.name, phase, binned.window.log, int(binned.edges[a]), int(binned.edges[b]))


# ---- Where the manoeuvres of every window are, by the axes as the sensors are taken to be read.

AS_NAMED = Permutation((0, 1, 2), (1, 1, 1))


@dataclass(frozen=True)
class Axes:
    """What takes the readings of the two sensors to the axes that the plan names."""

    accel: Permutation = AS_NAMED
    gyro: Permutation = AS_NAMED

    @property
    def as_named(self) -> bool:
        """Whether both sensors read as the plan names their axes."""
        return self == AS_PLANNED

    def plan_of(self, m: Manoeuvre) -> Manoeuvre:
        """A manoeuvre with its directions as these sensors read them; readings stay as they are."""
        up = None if m.up is None else self.accel.inverse.of(m.up)
        about = None if m.about is None else self.gyro.inverse.of(m.about)
        return replace(m, up=up, about=about)


AS_PLANNED = Axes()


@dataclass(frozen=True)
class Division:
    """A window cut into stretches that move or rest, in one way or another."""

    binned: Binned
    ways: Sequence[tuple[Sequence[BinStretch], Sequence[Observation]]]


@dataclass(frozen=True)
class Located:
    """Which stretch of a window is which manoeuvre, None where it is not found.

    `plan`: the manoeuvres as the sensors read their directions, by these axes; `divided`: the rests
    of each still stretch that only the plan divides.
    """

    binned: Binned
    axes: Axes
    plan: Sequence[Manoeuvre]
    stretches: Sequence[BinStretch]
    observed: Sequence[Observation]
    matched: Mapping[str, int | None]
    divided: Sequence[Sequence[str]] = ()

    def place(self, m: Manoeuvre) -> int | None:
        """The stretch of a manoeuvre."""
        return self.matched.get(m.name)

    def rest_before(self, m: Manoeuvre) -> int | None:
        """The stretch at rest just before a turn that was found, or before all that moves."""
        place = self.place(m)
        if place is None and self.binned.window.alone:
            place = next(
                (k for k, observation in enumerate(self.observed) if observation.moves), None
            )
        if not place or self.observed[place - 1].moves or place - 1 in self.matched.values():
            return None
        return place - 1

    @property
    def agreeing(self) -> tuple[int, int]:
        """How many observations agree with the plan, and how many there are.

        A rest gives the direction of gravity, a turn its axis and sense, and the rest before it
        the direction of gravity once more; a sensor of which an axis is lacking gives none.
        """
        agreements = [agrees for m in self.plan for agrees in self._agree(m)]
        return sum(agreements), len(agreements)

    @property
    def fitting(self) -> list[tuple[str, int]]:
        """The observations that agree with the plan, by manoeuvre and number."""
        return [(m.name, n) for m in self.plan for n, agrees in enumerate(self._agree(m)) if agrees]

    def _agree(self, m: Manoeuvre) -> list[bool]:
        place = self.place(m)
        if m.do == "positions":
            return []
        if m.do == "rest":
            known = m.up is not None and any(
                np.isfinite(observation.force).all() for observation in self.observed
            )
            return [place is not None] if known else []
        agreements = []
        if any(np.isfinite(observation.rate).all() for observation in self.observed):
            planned = m.rate if m.recorded == "steady" else m.angle
            turned = 0.0 if place is None else _about(self.observed[place], m)
            agreements.append(turned != 0 if planned is None else turned * planned > 0)
        before = self.rest_before(m)
        if (
            before is not None
            and m.up is not None
            and np.isfinite(self.observed[before].force).all()
        ):
            agreements.append(bool(points(self.observed[before].force, m.up)))
        return agreements


def divide(binned: Binned, level: Array, threshold: float, noise: float) -> Division:
    """A window in which rates beyond the threshold, or else beyond the noise, count as motion."""
    ways = []
    above_noise = moving(binned.rates, binned.forces, level, noise)
    for lowest in (threshold, noise):
        moves = moving(binned.rates, binned.forces, level, lowest)
        divided = stretches(moves, binned.bin_seconds, binned.forces)
        divided = with_slow_ends(divided, above_noise, binned.bin_seconds)
        ways.append((divided, observe(binned, divided, level)))
    return Division(binned, ways)


def locate(
    window: Division, axes: Axes = AS_PLANNED, manoeuvres: Sequence[Manoeuvre] | None = None
) -> Located:
    """Match the manoeuvres of a window, or others, to its stretches.

    A wrong unit makes a turn too slow to count as motion; where a turn is not found, all that is
    above the noise counts.
    """
    plan = [axes.plan_of(m) for m in manoeuvres or window.binned.window.manoeuvres]
    best: Located | None = None
    for divided, observed in window.ways:
        located = Located(window.binned, axes, plan, divided, observed, match(plan, observed))
        located = _with_rests_divided(located)
        lost = [m for m in plan if located.matched.get(m.name, 0) is None]
        if best is None or len(lost) < list(best.matched.values()).count(None):
            best = located
        if not any(m.do == "turn" for m in lost):
            break
    assert best is not None  # there is at least one way
    return best


# ---- Rests of one direction in one still stretch, where no gyro shows a turn between them.


def _with_rests_divided(located: Located) -> Located:
    """The same, each still stretch divided among the rests of the plan that it must hold.

    Accelerometers do not see a turn about the vertical. Rests of one direction that the plan has
    one after another are then one stretch, of which one of them would have all and the others
    nothing; each is taken to lie in it for its planned time, where the readings do not change.
    """
    if np.isfinite(located.binned.rates).any():
        return located
    rests_of = dict(_rests_of_stretches(located))
    if not rests_of:
        return located
    cut: list[BinStretch] = []
    places: dict[int, int] = {}  # of what a stretch is, or begins with, among those that are cut
    matched = dict(located.matched)
    for place, stretch in enumerate(located.stretches):
        places[place] = len(cut)
        if place not in rests_of:
            cut.append(stretch)
            continue
        for m, part in zip(
            rests_of[place], _parts_of(stretch, rests_of[place], located), strict=True
        ):
            if cut and cut[-1].after < part.first:
                cut.append(BinStretch(True, cut[-1].after, part.first))
            matched[m.name] = len(cut)
            cut.append(part)
    shared = {m.name for rests in rests_of.values() for m in rests}
    for name, found in located.matched.items():
        if found is not None and name not in shared:
            matched[name] = places[found]
    return replace(
        located,
        stretches=cut,
        observed=observe(located.binned, cut, np.zeros(3)),
        matched=matched,
        divided=[[m.name for m in rests] for rests in rests_of.values()],
    )


def _rests_of_stretches(located: Located) -> Iterator[tuple[int, list[Manoeuvre]]]:
    """The still stretches that hold several rests of the plan, and these in their order.

    A rest that is not found is in the stretch of the one before it or behind it, whichever has more
    room for the time that is planned in it; in none where that is too short for both.
    """
    for group in _alike(located.plan):
        places = [located.place(m) for m in group]
        for k, found in enumerate(places):
            if found is None:
                places[k] = _roomiest(located, group, places, k)
        for place in dict.fromkeys(p for p in places if p is not None):
            rests = [m for m, p in zip(group, places, strict=True) if p == place]
            if len(rests) > 1:
                yield place, rests


def _roomiest(
    located: Located, group: Sequence[Manoeuvre], places: Sequence[int | None], k: int
) -> int | None:
    """Of the stretches beside rest k of a group that which has more room; None where none has."""
    before = [p for p in places[:k] if p is not None][-1:]
    behind = [p for p in places[k + 1 :] if p is not None][:1]
    best, most = None, MIN_ROOM
    for place in before + behind:
        own = [m.seconds or 0.0 for m, p in zip(group, places, strict=True) if p == place]
        room = located.observed[place].seconds / (sum(own) + (group[k].seconds or 0.0))
        if room >= most:
            best, most = place, room
    return best


def _alike(plan: Sequence[Manoeuvre]) -> Iterator[list[Manoeuvre]]:
    """Rests of one direction and a planned time, one after another in the plan."""
    group: list[Manoeuvre] = []
    for m in plan:
        known = m.do == "rest" and m.up is not None and bool(m.seconds)
        same = known and group and float(_up(group[-1]) @ _up(m)) > MIN_ALIKE_COSINE
        if not same:
            yield group
            group = []
        group += [m] if known else []
    yield group


def _up(m: Manoeuvre) -> Array:
    assert m.up is not None  # of a rest whose direction is known
    return m.up


def _parts_of(
    stretch: BinStretch, rests: Sequence[Manoeuvre], located: Located
) -> Iterator[BinStretch]:
    """The parts of a stretch that the rests have, each for its planned time.

    They lie at equal distances; each is moved between its neighbours to where its readings vary
    clearly less: what a lever arm makes of a turn is outside then, and so is another tilt.
    """
    bins = stretch.after - stretch.first
    planned = np.array([m.seconds or 0.0 for m in rests]) / located.binned.bin_seconds
    lengths = np.maximum(np.floor(planned * min(1.0, bins / planned.sum())).astype(int), 1)
    spare = max(bins - int(lengths.sum()), 0)
    begins = np.cumsum([0, *lengths[:-1]]) + spare * np.arange(len(rests)) // (len(rests) - 1)
    forces = located.binned.forces[stretch.first : stretch.after]
    for _round in range(MOVES_OF_PARTS):
        for k, length in enumerate(lengths):
            least = begins[k - 1] + lengths[k - 1] if k else 0
            most = begins[k + 1] - length if k + 1 < len(begins) else bins - length
            now = int(begins[k]) - int(least)
            begins[k] = least + _quieter(forces[least : most + length], int(length), now)
    for begin, length in zip(begins.tolist(), lengths.tolist(), strict=True):
        yield BinStretch(False, stretch.first + begin, stretch.first + begin + length)


def _quieter(forces: Array, length: int, now: int) -> int:
    """Where, nearest to now, a part of so many bins begins in which forces, (k, 3), change least.

    Or hardly more, by the means of its quarters: over the noise of the bins, chi-squared of nine
    degrees of freedom where nothing changes.
    """
    quarter = length // 4
    known = np.isfinite(forces)
    if not quarter or not known.any():
        return now
    away = np.where(known, forces - np.nanmedian(np.where(known, forces, np.nan), axis=0), 0.0)
    sums = np.vstack([np.zeros(3), np.cumsum(away, axis=0)])
    means = (sums[quarter:] - sums[:-quarter]) / quarter
    begins = np.arange(len(forces) - length + 1)
    quarters = np.array([means[begins + k * quarter] for k in range(4)])
    variance = float(np.mean(np.diff(away, axis=0) ** 2)) / 2
    changes = quarter * ((quarters - quarters.mean(axis=0)) ** 2).sum(axis=(0, 2))
    quiet = np.flatnonzero(changes <= changes.min() + MIN_QUIETER * variance)
    return int(quiet[np.argmin(np.abs(quiet - now))])


def _about(observation: Observation, m: Manoeuvre) -> float:
    return float(
        np.nan_to_num(observation.rate if m.recorded == "steady" else observation.turned) @ m.axis
    )

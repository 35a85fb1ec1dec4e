"""Which stretch of a window is which manoeuvre, and which records are which phase of it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.campaign.records import Manoeuvre
from inertial.signal.rests_and_motions import (
    BinStretch,
    slow_motion,
    steady_part,
    stopped,
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
OTHER_TIME = 0.05  # share of the score that the time of a turn has: its angle and sense tell more
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


MIN_SETTLING_S = 1.0  # s, in which a table swings on after a turn
SETTLING = "settling"  # the phase of a turn in which it does
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
        scores = turn_scores(own / ratio, m.axis, planned) * self._as_fast(m)
        return np.where(self.moves, scores, 0.0)

    def _as_fast(self, m: Manoeuvre) -> Array:
        """By which factor each stretch is rather that turn, of two through one angle, (n,)."""
        if m.recorded == "steady" or not (m.angle and m.rate):
            return np.ones(len(self.moves))
        longer = np.abs(np.log(np.maximum(self.seconds, MIN_SETTLING_S) * abs(m.rate / m.angle)))
        return np.asarray(1.0 - OTHER_TIME * np.minimum(longer, 1.0))


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


def _first_of(binned: Binned, rest: BinStretch, room: int, shared: bool) -> int:
    """Where the rest before a turn begins; the turn before it, if any, has the first half."""
    moved = slow_motion(
        binned.rates[rest.first : rest.after], binned.bin_seconds, binned.quantum[3:]
    )
    if moved:
        return min(rest.first + moved[1] + room, rest.after)
    if shared:
        return (rest.first + rest.after) // 2
    return min(rest.first + (room if rest.first > 0 else 0), rest.after)


def _after_of(binned: Binned, rest: BinStretch, room: int, shared: bool) -> int:
    """Where the rest after a turn ends; the turn behind it, if any, has the second half."""
    moved = slow_motion(
        binned.rates[rest.first : rest.after], binned.bin_seconds, binned.quantum[3:]
    )
    if moved:
        return max(rest.first + moved[0] - room, rest.first)
    if shared:
        return (rest.first + rest.after) // 2
    return max(rest.after - (room if rest.after < binned.bins else 0), rest.first)


def turn_parts(
    binned: Binned,
    stretches: Sequence[BinStretch],
    m: Manoeuvre,
    matched: Mapping[str, int | None],
    level: Array,
    margin: float,
    longest: tuple[float, float] = (np.inf, np.inf),
) -> Iterator[Part]:
    """The phases of a turn, and the rests beside it that no other manoeuvre has.

    `longest`: of the rests before and after it, s.
    """
    place = matched[m.name]
    assert place is not None  # only a turn that was found has phases
    first, after = motion(binned, stretches, place)
    room = binned.bins_in(margin)
    start, stop = max(first - room, 0), min(after + room, binned.bins)
    taken = set(matched.values())
    free = [place + side not in taken for side in (-1, 1)]
    before, behind = 0, binned.bins
    if not binned.window.alone and place > 0:
        before = _first_of(binned, stretches[place - 1], room, place - 2 in taken)
    if not binned.window.alone and place + 1 < len(stretches):
        behind = _after_of(binned, stretches[place + 1], room, place + 2 in taken)
    nearest = [binned.bins_in(min(s, float(binned.seconds.sum()))) for s in longest]
    before, behind = max(before, start - nearest[0]), min(behind, stop + nearest[1])

    phases: list[tuple[str, int, int]] = []
    if free[0] and first > 0:
        phases.append(("rest-before", before, start))
    if m.rate is None:
        phases.append(("turning", start, stop))
    else:
        rate = binned.about(m.axis, level)[first:after]
        a, b = steady_part(rate)
        steady = (first + a, first + b)
        settles = max(first + stopped(rate) - room, steady[1])
        if stop - settles < binned.bins_in(MIN_SETTLING_S) + 2 * room:
            settles = stop
        phases += [
            ("spin-up", start, steady[0]),
            ("steady", *steady),
            ("spin-down", steady[1], settles),
            ("settling", settles, stop),
        ]
    if free[1] and after < binned.bins:
        phases.append(("rest-after", stop, behind))
    for phase, a, b in phases:
        if b > a:
            yield Part(m.name, phase, binned.window.log, int(binned.edges[a]), int(binned.edges[b]))

"""Where the manoeuvres of every window are, by the axes as the sensors are taken to be read.

The rests of one direction in one still stretch, which no gyro tells apart, are divided by the plan.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.campaign.records import Manoeuvre
from inertial.physics.motion import turned_between
from inertial.signal.axis_permutations import AS_NAMED, Permutation
from inertial.signal.rests_and_motions import (
    BinStretch,
    level_of_each_rest,
    moving,
    rest_level,
    shaken_bins,
    stretches,
    with_slow_ends,
)
from stages.segment.matching import MIN_SCALE_RATIO, Observation, match, observe, points
from stages.segment.windows import Binned

MIN_ALIKE_COSINE = float(np.cos(np.radians(1)))  # of directions of rests that look the same
MIN_QUIETER = 25.0  # of chi-squared: by less, parts of a still stretch change alike
MOVES_OF_PARTS = 3  # rounds in which each part is moved between its neighbours
MIN_REST_SHARE = 0.5  # of the planned time of a rest, of which less is but a part
MIN_ROOM = 0.9  # share of the time of several rests that a still stretch must last to hold them


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

    @property
    def log(self) -> str:
        """The log that the window is of."""
        return self.binned.window.log


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

    def ratio(self, m: Manoeuvre, planned: Manoeuvre) -> float:
        """What is recorded of a turn that was found, over the plan of a turn: inf without one."""
        place, size = self.place(m), _planned(planned)
        if place is None or not size:
            return np.inf
        return _about(self.observed[place], planned) / size

    def in_part(self, m: Manoeuvre) -> bool:
        """Whether what is found of a manoeuvre is but a small part, or a multiple, of its plan."""
        place = self.place(m)
        if place is None:
            return False
        if m.do == "rest":
            return self.observed[place].seconds < MIN_REST_SHARE * (m.seconds or 0.0)
        ratio = abs(self.ratio(m, m)) if m.do == "turn" and _planned(m) else 1.0
        return not 1 / MIN_SCALE_RATIO < ratio < MIN_SCALE_RATIO

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
            turned = 0.0 if place is None else _about(self.observed[place], m)
            planned = _planned(m)
            agreements.append(turned != 0 if planned is None else turned * planned > 0)
        before = self.rest_before(m)
        if (
            before is not None
            and m.up is not None
            and np.isfinite(self.observed[before].force).all()
        ):
            agreements.append(bool(points(self.observed[before].force, m.up)))
        return agreements


def divide(
    binned: Binned, level: Array, threshold: float, noise: float, *, swings: bool
) -> Division:
    """A window in which rates beyond the threshold, or else beyond the noise, count as motion.

    `swings`: whether a table moves, which swings on when it is stopped.
    """
    ways = []
    for lowest in (threshold, noise):
        # Where gravity is another one after a pause of the recording, the IMU was moved in it.
        moves = moving(binned.rates, binned.forces, level, lowest)
        moves |= binned.beside_pauses | binned.beside_jumps
        divided = stretches(moves, binned.bin_seconds, binned.forces)
        levels = level_of_each_rest(divided, binned.rates, level, noise)
        above_noise = moving(binned.rates, binned.forces, levels, noise)
        above = above_noise | shaken_bins(divided, binned.forces, binned.quantum[:3])
        divided = with_slow_ends(divided, above, binned.bin_seconds, swings=swings)
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


def _planned(m: Manoeuvre) -> float | None:
    """The planned rate of a turn at a steady rate, rad/s, of another its angle, rad."""
    return m.rate if m.recorded == "steady" else m.angle


def _about(observation: Observation, m: Manoeuvre) -> float:
    return float(
        np.nan_to_num(observation.rate if m.recorded == "steady" else observation.turned) @ m.axis
    )


# ---- What the rests of a recording show: gravity, the signs of the gyros, and their level.

MIN_UPRIGHT_SHARE = 0.9  # share of the vertical in an axis that points up
MIN_EARTH_SIGMA = 4.0  # sigmas to which the earth's rate must be seen to half of itself


def earth_seen(located: Sequence[Located], axes: Axes, earth_rate: float) -> list[int]:
    """The signs of the gyros by the earth rate: +1 right, −1 wrong, 0 nothing, (3,).

    A gyro reads the upward part of the earth's rate with one sign while its axis points up, with
    the other while it points down, whatever its bias. Gyros that are too noisy give 0.
    """
    rests = [pair for window in located for pair in _rates(window, axes)]
    signs = [0, 0, 0]
    for i in range(3):
        ways = []
        for sign in (1, -1):
            same = [
                (r, u)
                for up, r, u in rests
                if sign * up[i] > MIN_UPRIGHT_SHARE and np.isfinite(u[i])
            ]
            if same:
                weight = np.array([1 / max(u[i], 1e-12) ** 2 for _, u in same])
                mean = float(weight @ np.array([r[i] for r, _ in same]) / weight.sum())
                ways.append((mean, float(1 / np.sqrt(weight.sum()))))
        if len(ways) == 2 and earth_rate:
            (above, sigma_above), (below, sigma_below) = ways
            ratio = (above - below) / 2 / earth_rate
            sigma = np.hypot(sigma_above, sigma_below) / 2 / earth_rate
            if MIN_EARTH_SIGMA * abs(sigma) < 0.5 and 0.5 < abs(ratio) < 1.5:
                signs[i] = int(np.sign(ratio))
    return signs


def _rates(located: Located, axes: Axes) -> Iterator[tuple[Array, Array, Array]]:
    """The rests of a window: what points up, rates, and their sigmas, along the plan's axes."""
    unsigned = replace(axes.gyro, signs=(1, 1, 1))
    for up, observation in _rests(located):
        yield axes.accel.of(up), axes.gyro.of(observation.rate), unsigned.of(observation.unsure)


def forces_at_rest(located: Located) -> Iterator[tuple[Array, Array]]:
    """The specific forces at the rests of a window, each with the direction that was planned up."""
    for up, observation in _rests(located):
        if np.isfinite(observation.force).all():
            yield observation.force, up


def _rests(located: Located) -> Iterator[tuple[Array, Observation]]:
    """The rests of a window, those before turns too: what was planned up, and what was seen."""
    for m in located.plan:
        place = located.place(m) if m.do == "rest" else located.rest_before(m)
        if place is not None and m.up is not None and located.place(m) is not None:
            yield m.up, located.observed[place]


def level_of(every: Sequence[Binned]) -> tuple[Array, float]:
    """The gyros at rest over the campaign: from the windows of rests alone, if there are any.

    An axis that none of them records does not count; one that some do not record is taken from the
    others.
    """
    rests = [binned for binned in every if {m.do for m in binned.window.manoeuvres} == {"rest"}]
    for group in (rests, every):
        read = [binned.rates[binned.seconds > 0] for binned in group]  # not where all is masked
        rates = np.concatenate([np.empty((0, 3)), *read])
        recorded = np.isfinite(rates).any(axis=0)
        whole = rates[np.isfinite(rates[:, recorded]).all(axis=1)] if recorded.any() else []
        if len(whole):
            return rest_level(np.where(recorded, whole, 0.0))
    return np.zeros(3), 0.0


def begun_as_recorded(plan: Sequence[Manoeuvre], every: Sequence[Located]) -> list[Manoeuvre]:
    """The plan, with each manoeuvre of a position begun where the table had turned the case.

    Its mark says where that is, as repairs have set it right. Without one it is by the plan where
    the turn before it ended; the log may show that the table went back to where it was set.
    """
    back = set()
    for located in every:
        position, first = None, 0
        found = ((located.place(m), m) for m in located.plan)
        for place, m in sorted(((k, m) for k, m in found if k is not None), key=lambda one: one[0]):
            if m.position != position:
                position, first = m.position, place
            if not m.turned_on or m.mark is not None or m.up is None:
                continue
            turned = [observation.turned for observation in located.observed[first:place]]
            moved = float(np.nansum(turned, axis=0) @ m.up)
            if abs(np.sin(moved / 2)) < abs(np.sin((moved - m.turned_on) / 2)):
                back.add(m.name)
    return _by_marks([replace(m, turned_on=0.0) if m.name in back else m for m in plan])


def _by_marks(plan: Sequence[Manoeuvre]) -> list[Manoeuvre]:
    """The plan, with each manoeuvre begun where the marks of its position say, if it has any."""
    made: list[Manoeuvre] = []
    first: Manoeuvre | None = None
    for m in plan:
        if first is None or not _of_one_setting(first, m):
            first = m
        if m.up is not None and m.mark is not None and first.mark is not None:
            m = replace(m, turned_on=turned_between(m.up, first.mark, m.mark))
        made.append(m)
    return made


def _of_one_setting(one: Manoeuvre, other: Manoeuvre) -> bool:
    """Whether two manoeuvres are of one position with the same direction up, in one log."""
    alike = (one.position, one.log) == (other.position, other.log)
    return alike and one.up is not None and other.up is not None and np.allclose(one.up, other.up)

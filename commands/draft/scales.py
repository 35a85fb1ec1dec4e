"""Units and count sizes: accelerometers by gravity, gyros by how gravity's direction turns."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from commands.draft.series import Divided, Gravity, Still, gravity_in
from inertial.arrays import Array
from inertial.estimation.attitude import integrate
from inertial.signal.axis_permutations import AS_NAMED, PERMUTATIONS, Permutation
from inertial.signal.gravity_turned import Turned, turned
from inertial.tables.yaml_file import YamlFile
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import CHANNEL_UNITS, DEGREE, STANDARD_GRAVITY

# ---- The size of raw gyro readings, and their axes, by how gravity's direction turns in motion.

USUAL_GYRO_COUNTS = (131.0, 65.5, 32.8, 16.4, 228.6, 114.3, 57.1, 28.6, 14.3)  # in 1 °/s
USUAL_SIZES = (1.0, DEGREE, *(DEGREE / counts for counts in USUAL_GYRO_COUNTS))  # rad/s
MIN_TILT = np.radians(20)  # between two static positions, that shows the scale of the gyros
MAX_TILT = np.radians(160)
LARGE = 0.95  # quantile of the rates that is about 1 rad/s
MIN_FACTOR_SIGMA = 10.0  # of the factor by the change of gravity's direction, to be one
FIRST_SIGMA = 0.1  # relative, of a factor by the change of gravity's direction alone
MAX_MISS = np.radians(30)  # of a direction: a motion that misses by more says no more
MIN_WAYS_OF_AXES, MAX_WAYS_OF_AXES = 4, 10  # motions by which axes are tried, the shortest of all
MAX_CARRIED = np.radians(10)  # rms miss of the axes that are right: a scale factor, a hand's turn
MAX_CARRIED_TURN = 4 * np.pi  # of most motions between positions: more turns end anywhere
MIN_MISS_RATIO = 3.0  # of any other axes to that
MAX_WAYS = 20  # motions by which the factor is refined, the shortest of all
RANGE, STEP = 0.4, 0.02  # about the first factor, relative


@dataclass(frozen=True)
class Turning:
    """What takes raw gyros to rad/s: a factor with its relative sigma, and the axes they read.

    `shares`: as in `Scale`.
    """

    factor: float
    sigma: float
    axes: Permutation
    shares: tuple[tuple[float, float], ...] = ()


def turning(recordings: Sequence[Divided], zero: float) -> Turning | None:
    """The factor of raw gyros by gravity's direction in motion; None where it hardly turns.

    `zero`: of the accelerometers, in counts.
    """
    both = [own for own in recordings if len(own.series.gyro) and len(own.series.accel)]
    if not any(own.rests for own in both):
        return None
    gravity = gravity_in(both, zero)
    # Of rates in any unit the largest are made 1 rad/s, about as they are.
    speed = np.concatenate([np.linalg.norm(own.rates - own.level, axis=1) for own in both])
    one = float(np.quantile(speed, LARGE))
    found = turned(
        [
            (
                (own.forces - zero) / gravity.length,
                (own.rates - own.level) / one,
                own.series.bin_seconds(),
            )
            for own in both
        ]
    )
    sure = None if found is None else _of_size_one(found).axes
    ways = [way for own in both for way in _ways(own, zero + gravity.centre)]
    if sure is None and (carried := _by_other_axes(ways)) is not None:
        ways = [_along(way, carried.axes) for way in ways]
        return _refined(carried, ways) if gravity.centre.any() else carried
    axes = sure or AS_NAMED
    ways = [_along(way, axes) for way in ways]
    if found is None:
        return _usual(ways)
    place = (np.arange(3), np.array(axes.sources))
    own, weight = found.matrix[place] * np.array(axes.signs), found.sigma[place] ** -2
    factor = float(np.sum(own * weight) / np.sum(weight))
    if factor < MIN_FACTOR_SIGMA / np.sqrt(np.sum(weight)):
        return None
    shares = np.column_stack([found.matrix[place], found.sigma[place]]) / factor
    first = Turning(factor / one, FIRST_SIGMA, axes, tuple(map(tuple, shares.tolist())))
    # Without a centre the directions at rest are off by the bias.
    return _refined(first, ways) if ways and gravity.centre.any() else first


def _of_size_one(found: Turned) -> Turned:
    """The same with entries near 1 that decide, by which it says whether the axes are sure."""
    size = float(np.median(np.abs(found.matrix).max(axis=1)))
    return replace(found, matrix=found.matrix / size, sigma=found.sigma / size)


Way = tuple[Array, Array, Array, float]  # direction before and after, raw rates (k, 3), their step


def _along(way: Way, axes: Permutation) -> Way:
    """The same with rates along the axes of the accelerometers."""
    before, after, rates, step = way
    return before, after, rates[:, list(axes.sources)] * np.array(axes.signs), step


def _ways(own: Divided, unforced: Array) -> list[Way]:
    """What carries gravity's direction from one static position to the next.

    `unforced`: (3,), what the accelerometers read of no force.
    """

    def up(rest: Still) -> Array:
        force = rest.accel - unforced
        return np.asarray(force / np.linalg.norm(force))

    edges = own.series.edges(own.series.gyro)
    ways: list[Way] = []
    for before, after in own.passages():
        first, second = up(before), up(after)
        if not MIN_TILT < np.arccos(np.clip(first @ second, -1, 1)) < MAX_TILT:
            continue
        inside = slice(
            edges[max(before.after - 2, 0)], edges[min(after.first + 2, own.series.bins)]
        )
        rates = own.series.gyro[inside] - (before.gyro + after.gyro) / 2
        if len(rates) > 2:
            ways.append((first, second, rates, 1 / own.series.gyro_hz))
    return ways


def _by_other_axes(ways: Sequence[Way]) -> Turning | None:
    """The only axes, not those named, along which gyros in a usual unit carry the directions.

    From rest to rest the hand's accelerations, by which axes are not sure otherwise, do not matter.
    """
    ways = sorted(ways, key=lambda way: len(way[2]))[:MAX_WAYS_OF_AXES]
    if len(ways) < MIN_WAYS_OF_AXES or _carried(ways)[0] < MAX_MISS:
        return None
    misses = {axes: _carried([_along(way, axes) for way in ways]) for axes in PERMUTATIONS}
    best, second = sorted(misses, key=lambda axes: misses[axes][0])[:2]
    miss, size = misses[best]
    if miss > MAX_CARRIED or misses[second][0] < MIN_MISS_RATIO * miss:
        return None
    return Turning(size, FIRST_SIGMA, best)


def _carried(ways: Sequence[Way]) -> tuple[float, float]:
    """The rms miss of the directions, rad, in the usual unit or count size of the least, rad/s."""
    turns = np.median([np.linalg.norm(rates, axis=1).sum() * step for *_ends, rates, step in ways])
    sizes = [size for size in USUAL_SIZES if size * turns < MAX_CARRIED_TURN]
    if not sizes:
        return np.inf, 1.0
    totals = [sum(_miss(way, size) for way in ways) for size in sizes]
    best = int(np.argmin(totals))
    return float(np.sqrt(totals[best] / len(ways))), sizes[best]


def _usual(ways: Sequence[Way]) -> Turning | None:
    """Of the usual units and count sizes that which carries the directions from rest to rest."""
    if not ways:
        return None
    miss, size = _carried(ways)
    return Turning(size, FIRST_SIGMA, AS_NAMED) if miss <= MAX_MISS else None


def _refined(first: Turning, ways: Sequence[Way]) -> Turning:
    """The factor that carries the directions from rest to rest, where that is the surer one."""
    ways = sorted(ways, key=lambda way: len(way[2]))[:MAX_WAYS]
    factors = first.factor * np.arange(1 - RANGE, 1 + RANGE, STEP)
    misses = np.array([[_miss(way, each) for each in factors] for way in ways])
    total = np.sum(np.minimum(misses, MAX_MISS**2), axis=0)
    best = int(np.argmin(total))
    curve = np.polyfit(factors[max(best - 2, 0) : best + 3], total[max(best - 2, 0) : best + 3], 2)
    if curve[0] <= 0:
        return first
    residual = float(total[best]) / max(2 * len(ways) - 1, 1)
    sigma = float(np.sqrt(residual / curve[0]))
    value = float(np.clip(-curve[1] / (2 * curve[0]), factors[0], factors[-1]))
    refined = replace(first, factor=value, sigma=max(sigma / value, STEP))
    return min(first, refined, key=lambda each: each.sigma)


def _miss(way: Way, factor: float) -> float:
    """The square of the angle by which a motion misses the direction after it, rad²."""
    before, after, rates, step = way
    there = integrate(factor * rates, np.full(len(rates), step)).whole @ before
    return float(np.arccos(np.clip(there @ after, -1, 1)) ** 2)


# ---- Units and count sizes.

MAX_UNIT_ERROR = 0.1  # of a reading in a unit: bias and scale factor
MAX_COUNT_ERROR = 0.1  # of a usual count size
MIN_STRAIGHT = 0.9  # share of a rotation about one axis
MAX_OFF_WHOLE = 0.06  # of a turn by hand, and of its gyro, to the whole multiples
MAX_WHOLE = 3.5  # of these multiples in one turn
MIN_OTHER_RANGE, MAX_OFF_RANGE = 1 / 8, 0.15  # factors between ranges; error of one, relative
GYRO_COUNTS_BESIDE = {16384.0: 131.0, 8192.0: 65.5, 4096.0: 32.8, 2048.0: 16.4}  # in 1 g: in 1 °/s
MAX_RAD_S = 40.0  # rad/s: gyros that read more read °/s
GYRO_UNIT = {
    "deg/s": re.compile(r"deg|dps|°|grad[ios]*(?![a-z])", re.IGNORECASE),
    "rad/s": re.compile(r"(?<![a-z])m?rad", re.IGNORECASE),
}
PARTS = {  # of a unit in its name, and how many make one
    1000.0: re.compile(r"(?<![a-z])m(dps|deg|rad)|milli", re.IGNORECASE),
    3600.0: re.compile(r"(deg|grad|°)[ /_]?(p|per[ _])?(h|hr|hour)(?![a-z])", re.IGNORECASE),
}


def parts_named(names: Sequence[object]) -> float | None:
    """How many make one of the unit in these names, such as 1000 of mdps; None: they say none."""
    words = [name for name in names if isinstance(name, str)]
    return next((count for count, p in PARTS.items() if any(map(p.search, words))), None)


@dataclass(frozen=True)
class Scale:
    """Unit of a sensor, counts in it or none, their zero, (3,), and what says so.

    `axes`: what takes the readings to the axes of the other sensor; `shares`: by how much each gyro
    turns gravity along these axes, relative to their mean, with sigma, (3, 2); empty if not seen;
    `increments`: a reading is the integral of the unit over a sample; `doubt`: a question, or none;
    `sigma`: relative, of the size of gyros by the motion.
    """

    unit: str
    counts: float | None
    zero: float
    evidence: str
    guessed: bool
    axes: Permutation = AS_NAMED
    shares: tuple[tuple[float, float], ...] = ()
    increments: bool = False
    doubt: str = ""
    sigma: float = 0.0

    @property
    def size(self) -> float:
        """One count, or one of the unit, in SI."""
        return CHANNEL_UNITS[self.unit] / (self.counts or 1.0)

    @property
    def size_in_degrees(self) -> float:
        """How many counts are in 1 °/s, of gyros."""
        return DEGREE / self.size

    def in_si(self, values: Array) -> Array:
        """Readings (n, 3) in SI, along the axes of the other sensor."""
        if not len(values):
            return values
        values = (values - self.zero) * self.size
        return np.asarray(values[:, list(self.axes.sources)] * np.array(self.axes.signs))


def are_counts(values: Array) -> bool:
    """Whether readings are whole numbers."""
    return bool(np.all(values == np.round(values)) and np.ptp(values) > 20)


def zero_of(values: Array) -> float:
    """The count of nothing: half of the range of unsigned counts, else 0."""
    if not (are_counts(values) and values.min() >= 0 and np.median(values) > 100):
        return 0.0
    bits = np.round(np.log2(np.median(values)))
    return float(2**bits) if abs(np.median(values) / 2**bits - 1) < 0.3 else 0.0


def accel_scale(recordings: Sequence[Divided]) -> Scale:
    """The unit of accelerometers, by their length at rest."""
    values = np.concatenate([own.series.accel for own in recordings])
    zero = zero_of(values)
    found = gravity_in(recordings, zero)
    scale = _unit(found, values, recordings[0].series.accel_hz, zero)
    doubt = found.doubt
    if not doubt and scale.guessed and not scale.increments:
        doubt = _no_unit(values, found.length, {"g": 1.0, "m/s²": STANDARD_GRAVITY})
    return replace(scale, doubt=doubt)


def _unit(found: Gravity, values: Array, rate: float, zero: float) -> Scale:
    """The unit in which gravity has this length; `values`: (n, 3), at `rate`, Hz."""
    length, seen, whole, step = found.length, found.seen, are_counts(values), 1 / rate
    for of_gravity, unit, counts in (
        (STANDARD_GRAVITY, "m/s2", None),
        (1.0, "g", None),
        (1000.0, "g", 1000.0),
        (100 * STANDARD_GRAVITY, "m/s2", 100.0),
    ):
        if abs(length / of_gravity - 1) < MAX_UNIT_ERROR and not (counts is None and whole):
            return Scale(unit, counts, zero, seen, False)
    for of_gravity, unit in ((STANDARD_GRAVITY, "m/s2"), (1.0, "g")):
        if abs(length / (of_gravity * step) - 1) < MAX_UNIT_ERROR and not whole:
            what = _("{seen}: increments over {step} s", seen=seen, step=significant(step))
            return Scale(unit, step, zero, what, True, increments=True)
    power = float(2.0 ** np.round(np.log2(length)))
    usual = abs(length / power - 1) < MAX_COUNT_ERROR
    counts = power if usual else float(f"{length:.4g}")
    what = _("{seen}: counts, {counts} in 1 g", seen=seen, counts=significant(counts, 6))
    return Scale("g", counts, zero, what, True)


def _no_unit(values: Array, readings: float, usual: Mapping[str, float]) -> str:
    """A question where readings are no whole numbers and in no usual unit, else empty.

    `readings`: how many are in what `usual` has of each unit. Counts that were divided by the size
    of another range are off by a power of two.
    """
    if are_counts(values):
        return ""
    first, *_others = usual
    for unit, size in usual.items():
        power = float(2.0 ** np.round(np.log2(readings / size)))
        near = abs(readings / size / power - 1) < MAX_OFF_RANGE
        if near and power != 1.0 and MIN_OTHER_RANGE <= power <= 1 / MIN_OTHER_RANGE:
            return _(
                "they are no whole numbers, and read {ratio} of what they should in {unit}; were "
                "counts divided by the size of another range, off by the factor {power}? The draft "
                "takes them as they read",
                ratio=significant(readings / size),
                unit=unit,
                power=f"{power:g}",
            )
    return _(
        "they are no whole numbers, and read {readings} for 1 {unit}, in no usual unit; in which?",
        readings=significant(readings),
        unit=first,
    )


def _straight_turns(recordings: Sequence[Divided]) -> Array:
    """The largest rotations about one axis, in the unit of the gyros times s."""
    turns = []
    for own in recordings:
        for stretch in own.stretches:
            if stretch.moves and len(own.series.gyro):
                rates = own.rates[stretch.first : stretch.after] - own.level
                net, path = np.linalg.norm(rates.sum(axis=0)), np.linalg.norm(rates, axis=1).sum()
                if net > MIN_STRAIGHT * path:
                    turns.append(net * own.series.bin_seconds())
    every = np.array(turns)
    return np.asarray(every[every > every.max(initial=0.0) / 2])


def turn_misfit(recordings: Sequence[Divided], size: float, whole: float = 2 * np.pi) -> float:
    """How far turns are from whole multiples, relative; infinite where they are too many.

    `size`: rad/s of one of the unit of the gyros; `whole`: rad, of which they are multiples.
    """
    ratios = _straight_turns(recordings) * size / whole
    if not len(ratios) or ratios.max() >= MAX_WHOLE:
        return np.inf
    return float(np.abs(ratios / np.maximum(np.round(ratios), 1) - 1).max())


def _by_turns(recordings: Sequence[Divided], counts: bool, zero: float) -> Scale | None:
    """The unit, or the count size, in which the motions are whole turns; None where in none."""
    tried: list[tuple[str, float | None]] = [("deg/s", None), ("rad/s", None)]
    if counts:
        tried = [("deg/s", each) for each in USUAL_GYRO_COUNTS]
    for whole in (2 * np.pi, np.pi, np.pi / 2):
        what = _("by it turns are multiples of {degrees:.0f}°", degrees=np.degrees(whole))
        for unit, own_counts in tried:
            scale = Scale(unit, own_counts, zero, what, True)
            if turn_misfit(recordings, scale.size, whole) < MAX_OFF_WHOLE:
                return scale
    return None


def gyro_scale(
    recordings: Sequence[Divided],
    turns: Turning | None,
    names: Sequence[object],
    accel: Scale | None = None,
) -> Scale:
    """The unit of gyros: by their names, by the motion, else by how much they read.

    `accel`: the unit of the accelerometers beside them.
    """
    values = np.concatenate([own.series.gyro for own in recordings])
    zero = zero_of(values)
    words = [name for name in names if isinstance(name, str)]
    parts = parts_named(names)
    if turns is not None:
        return _by_motion(recordings, turns, values, parts)
    named = next((unit for unit, p in GYRO_UNIT.items() if any(map(p.search, words))), None)
    if named is not None:
        return Scale(named, parts, zero, _("the unit is that of their names"), False)
    by_turns = _by_turns(recordings, are_counts(values), zero)
    return _by_size(values, zero, accel) if by_turns is None else by_turns


def _by_size(values: Array, zero: float, accel: Scale | None) -> Scale:
    """A guess, where no turn shows the unit: whole numbers are counts, of a size that is asked."""
    largest = float(np.abs(values - zero).max())
    beside = (accel.counts if accel else None) or 0.0
    if are_counts(values) and (beside or largest > MAX_RAD_S):
        counts = GYRO_COUNTS_BESIDE.get(beside, USUAL_GYRO_COUNTS[0])
        usual = ", ".join(f"{each:g}" for each in USUAL_GYRO_COUNTS)
        doubt = _(
            "they read counts, and no turn shows how many are in 1 °/s; which range was set? Usual "
            "are {usual}; {counts} is a guess",
            usual=usual,
            counts=f"{counts:g}",
        )
        what = _("whole numbers, so counts; their size is a guess")
        return Scale("deg/s", counts, zero, what, True, doubt=doubt)
    unit = "deg/s" if largest > MAX_RAD_S else "rad/s"
    what = _(
        "the largest reading is {reading}, so the unit is taken for {unit}",
        reading=significant(largest),
        unit=unit.replace("deg", "°"),
    )
    return Scale(unit, None, zero, what, True)


def _by_motion(
    recordings: Sequence[Divided], turns: Turning, values: Array, parts: float | None
) -> Scale:
    """The unit in which gyros carry gravity's direction as it turns.

    `parts`: how many make one of the unit in their names, such as 1000 of mdps; None: these are it.
    """
    zero, axes, shares = zero_of(values), turns.axes, turns.shares
    seen = _(
        "gravity's direction turns by {factor} rad for each unit of reading and second, "
        "± {percent:.0f} %",
        factor=significant(turns.factor),
        percent=100 * turns.sigma,
    )
    step = 1 / recordings[0].series.gyro_hz
    for of_unit, increments in ((parts, False), (step, True)):
        for unit, size in (("rad/s", 1.0), ("deg/s", DEGREE)):
            error = abs(turns.factor * (of_unit or 1.0) / size - 1)
            if error < 2 * MAX_UNIT_ERROR and (parts or not are_counts(values)):
                return Scale(unit, of_unit, zero, seen, increments, axes, shares, increments)
    per_degree = DEGREE / turns.factor
    most = max(MAX_COUNT_ERROR, 2 * turns.sigma)
    near = [each for each in USUAL_GYRO_COUNTS if abs(each / per_degree - 1) < most]
    off = {each: abs(np.log(each / per_degree)) for each in near}
    if turns.sigma >= FIRST_SIGMA:  # round turns are surer
        off = {each: turn_misfit(recordings, DEGREE / each, np.pi / 2) for each in near}
    counts = min(near, key=lambda each: off[each]) if near else float(f"{per_degree:.3g}")
    what = _("{seen}: counts, {counts} in 1 °/s", seen=seen, counts=significant(counts))
    doubt = _no_unit(values, per_degree, {"°/s": 1.0, "rad/s": DEGREE})
    return Scale("deg/s", counts, zero, what, True, axes, shares, doubt=doubt, sigma=turns.sigma)


# ---- The instrument of a receiver's counts, of those listed: by gravity, rate and whole turns.

INSTRUMENTS = Path(__file__).parents[2] / "data/instruments.yaml"
MAX_COUNT_ERROR_OF_RECEIVER, MAX_RATE_ERROR = 0.1, 0.05  # relative
RECEIVER_AXES = ["z", "-y", "x"]  # of every receiver of NovAtel


@dataclass(frozen=True)
class Receiver:
    """An instrument as the campaign file names it or writes it out."""

    instrument: str | dict[str, Any]
    accel: Scale
    gyro: Scale


def receiver_of(recordings: Sequence[Divided], rate: float) -> Receiver:
    """The instrument of these counts at `rate`, Hz."""
    length = gravity_in(recordings).length
    count = STANDARD_GRAVITY / length / rate
    seen = _("|f| at rest makes one count {count} m/s", count=significant(count))
    listed = YamlFile(INSTRUMENTS).content
    fitting = {}
    for name, entry in listed.items():
        own = entry.get("accelerometer", {}).get("count_m_s")
        same_rate = abs(entry.get("rate_hz", rate) / rate - 1) < MAX_RATE_ERROR
        if own and same_rate and abs(own / count - 1) < MAX_COUNT_ERROR_OF_RECEIVER:
            size = entry["gyro"]["count_rad"]
            fitting[name] = (turn_misfit(recordings, size * rate), own, size)
    if fitting:
        least = min(misfit for misfit, *_sizes in fitting.values())
        best = [name for name, own in fitting.items() if own[0] <= least + 1e-9]
        _misfit, own, size = fitting[best[0]]
        why = _("{seen}, that of {names}", seen=seen, names=", ".join(best))
        return Receiver(
            best[0],
            Scale("m/s2", 1 / (own * rate), 0.0, why, False),
            Scale("rad/s", 1 / (size * rate), 0.0, why, False),
        )
    accel = Scale("m/s2", length / STANDARD_GRAVITY, 0.0, seen, True)
    gyro = gyro_scale(recordings, turning(recordings, accel.zero), [])
    entry = {
        "axes": RECEIVER_AXES,
        "gyro": {"count_rad": float(f"{gyro.size / rate:.4g}")},
        "accelerometer": {"count_m_s": float(f"{count:.4g}")},
    }
    return Receiver(entry, accel, gyro)

"""The size of raw gyro readings, and their axes, by how gravity's direction turns in motion."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from commands.draft.series import Divided, Still, gravity_in
from inertial.arrays import Array
from inertial.estimation.attitude import integrate
from inertial.signal.axis_permutations import AS_NAMED, PERMUTATIONS, Permutation
from inertial.signal.gravity_turned import Turned, turned
from inertial.text.units import DEGREE

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
    totals = [sum(_miss(way, size) for way in ways) for size in USUAL_SIZES]
    best = int(np.argmin(totals))
    return float(np.sqrt(totals[best] / len(ways))), USUAL_SIZES[best]


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

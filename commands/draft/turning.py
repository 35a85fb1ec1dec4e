"""The size of raw gyro readings, and their axes, by how gravity's direction turns in motion."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from commands.draft.gravity import gravity_in
from commands.draft.series import Divided, Still
from inertial.arrays import Array
from inertial.estimation.attitude import integrate
from inertial.signal.axis_permutations import AS_NAMED, Permutation
from inertial.signal.gravity_turned import Turned, turned
from inertial.text.units import DEGREE

USUAL_GYRO_COUNTS = (131.0, 65.5, 32.8, 16.4, 228.6, 114.3, 57.1, 28.6, 14.3)  # in 1 °/s
MIN_TILT = np.radians(20)  # between two static positions, that shows the scale of the gyros
MAX_TILT = np.radians(160)
LARGE = 0.95  # quantile of the rates that is about 1 rad/s
MIN_FACTOR_SIGMA = 10.0  # of the factor by the change of gravity's direction, to be one
FIRST_SIGMA = 0.1  # relative, of a factor by the change of gravity's direction alone
MAX_MISS = np.radians(30)  # of a direction: a motion that misses by more says no more
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
    axes = AS_NAMED if found is None else _of_size_one(found).axes or AS_NAMED
    ways = [way for own in both for way in _ways(own, zero + gravity.centre, axes)]
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


def _ways(own: Divided, unforced: Array, axes: Permutation) -> list[Way]:
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
        rates = rates[:, list(axes.sources)] * np.array(axes.signs)
        if len(rates) > 2:
            ways.append((first, second, rates, 1 / own.series.gyro_hz))
    return ways


def _usual(ways: Sequence[Way]) -> Turning | None:
    """Of the usual units and count sizes that which carries the directions from rest to rest."""
    sizes = [1.0, DEGREE, *(DEGREE / counts for counts in USUAL_GYRO_COUNTS)]
    misses = [sum(_miss(way, size) for way in ways) for size in sizes]
    best = int(np.argmin(misses))
    if not ways or misses[best] > len(ways) * MAX_MISS**2:
        return None
    return Turning(sizes[best], FIRST_SIGMA, AS_NAMED)


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

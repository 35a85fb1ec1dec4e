"""How far each reading of a channel is from its neighbours, and how much they scatter."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.signal.scatter import MAD_TO_SIGMA, QUIET_SHARE, median

MEDIAN_WIDTH = 9  # readings: of these a spike may be up to four


def running_median(values: Array) -> Array:
    """The median of each reading and the four on either side of it, (n,) of (n,), n ≥ 5.

    The ends are continued by turning them about their last reading, which keeps a slope; that
    reading is its own median. Median of nine by three sorted threes: Paeth, Graphics Gems I
    (1990) 171.
    """
    x = np.pad(values, MEDIAN_WIDTH // 2, mode="reflect", reflect_type="odd")
    low, high = np.minimum(x[:-2], x[1:-1]), np.maximum(x[:-2], x[1:-1])
    least, most = np.minimum(low, x[2:]), np.maximum(high, x[2:])
    middle = np.maximum(low, np.minimum(high, x[2:]))
    highest_low = np.maximum(np.maximum(least[:-6], least[3:-3]), least[6:])
    lowest_high = np.minimum(np.minimum(most[:-6], most[3:-3]), most[6:])
    return _middle(highest_low, _middle(middle[:-6], middle[3:-3], middle[6:]), lowest_high)


def _middle(a: Array, b: Array, c: Array) -> Array:
    """The middle one of three."""
    return np.maximum(np.minimum(a, b), np.minimum(np.maximum(a, b), c))


MIN_DEVIATION_SCATTER = 5.0  # scatters by which a reading is off, and not by chance
SCATTER_READINGS = 1024  # readings from which the scatter is taken
MOTION_READINGS = 64  # readings of a block that decides whether the IMU is moved
MIN_MOTION_RATIO = 3.0  # times the scatter of the quiet stretches
MAX_SPIKE_READINGS = 3  # readings of a spike
MIN_SLOPE_SCATTER = 3.0  # scatters between the medians before and after
OFF_SHARE, OFF_OF_WHITE = 0.95, 1.98  # quantile of the distance from the median of nine, in sigma
MIN_COLOUR = 1.3  # ratio of scatters; what is less may be the steps of coarse counts
MIN_BEND_SCATTER = 3.0  # scatters by which twice the median between them is off their sum
MAX_MISSING_INTERVALS = 8  # intervals that are missing: what lies beyond is no neighbour
# Places beyond the readings of a spike, and what a parabola through them reads in their middle.
BESIDE = np.arange(MAX_SPIKE_READINGS, MEDIAN_WIDTH)
AROUND = np.concatenate([-BESIDE, BESIDE])
PARABOLA_AT_MIDDLE = np.linalg.pinv(np.vander(AROUND, 3))[-1]


@dataclass(frozen=True)
class Channel:
    """A channel at the m places of a piece at which it is read.

    change: (m,), how far the reading is from the one before; off: (m,), distance from the running
    median, with its sign; scatter: (m,), sigma of the
    readings around, at least a count; least: (m,), that of fewer readings, where it is less;
    handled: (m,), whether the IMU is moved, or rings; alone: (m,), whether the four readings on
    either side are not all there.
    """

    places: Integers
    change: Array
    off: Array
    scatter: Array
    least: Array
    handled: Booleans
    alone: Booleans

    @classmethod
    def of(cls, places: Integers, values: Array, time: Array, count: float, noise: float) -> Self:
        """A channel that reads `values` at `places`.

        time: (m,), intervals, NaN where there is none; count: its smallest step; noise: sigma of
        a reading in the whole log.
        """
        # Of a ramp's readings their running median leaves nothing; against both neighbours they
        # scatter there as elsewhere.
        rough = np.abs(values[1:-1] - (values[:-2] + values[2:]) / 2) / np.sqrt(1.5)
        rough = np.pad(rough, 1, mode="edge")
        course = running_median(values)
        colour, faintest = _colour(values - course, rough, count)
        rough *= colour
        scatter = _of_readings(
            _around(_scatter(rough, SCATTER_READINGS, faintest), least=True),
            SCATTER_READINGS,
            values,
        )
        near = _scatter(rough, MOTION_READINGS, count)
        least_near = _of_readings(_around(near, least=True), MOTION_READINGS, values)
        least = np.minimum(scatter, least_near)
        off = _off(values, course, least)
        quiet = max(min(float(np.quantile(near, 0.25)), noise), count)
        # One spike of three readings is no motion yet, nor are several that lie apart.
        pairs = _in_blocks(np.minimum(np.abs(off), np.abs(np.roll(off, 1))), MOTION_READINGS)
        third = np.sort(pairs, axis=1)[:, -MAX_SPIKE_READINGS]
        moved = np.maximum(near / MIN_MOTION_RATIO, third / MIN_DEVIATION_SCATTER)
        return cls(
            places,
            np.abs(np.diff(values, prepend=values[0])),
            off,
            scatter,
            least,
            _of_readings(_around(moved, least=False), MOTION_READINGS, values) > quiet,
            _beside_a_hole(places, time),
        )


def _colour(off: Array, rough: Array, count: float) -> tuple[float, float]:
    """How much farther the noise is from its running median than its roughness says, at least 1.

    And the least scatter: a count, or that distance where it is farther. A filter leaves neighbours
    alike, but not readings four places apart. Of the quiet blocks, for in a motion by hand it is
    the motion that is off its median.
    """
    scatter = _scatter(rough, SCATTER_READINGS, count)
    far = _in_blocks(np.abs(off), SCATTER_READINGS)
    place = int(OFF_SHARE * far.shape[1])
    waves = np.partition(far, place, axis=1)[:, place] / OFF_OF_WHITE
    colour = float(np.quantile(waves / scatter, QUIET_SHARE)) if scatter.all() else 1.0
    if colour < MIN_COLOUR:
        return 1.0, count
    return colour, max(count, float(np.quantile(waves, QUIET_SHARE)))


def _off(values: Array, course: Array, least: Array) -> Array:
    """The distance of readings from their running median `course`, or, on a ramp, from the ramp's.

    A spike on a steep ramp moves the median of those beside it by a step of the ramp. So what is
    far off by its scatter, `least`, is compared once more, the slope between the medians before
    and after taken off, and the smaller distance holds. At the corner of a ramp, where what is
    beside lies on one side, it must be off the straight lines through five readings before and
    five after as well; at the turning point of a bend, such as gravity's while the IMU is tilted
    over, where the median lies inside of the bend, off a parabola through six before and six after.
    """
    off = values - course
    half, last = MEDIAN_WIDTH // 2, len(values) - 1
    far = np.flatnonzero(np.abs(off) > MIN_DEVIATION_SCATTER * least)
    before, after = np.maximum(far - half - 1, 0), np.minimum(far + half + 1, last)
    slope = (course[after] - course[before]) / np.maximum(after - before, 1)
    near = np.clip(far[:, None] + np.arange(-half, half + 1), 0, last)
    flat = values[far] - np.median(values[near] - slope[:, None] * (near - far[:, None]), axis=1)
    distances = [off[far], flat]
    for side in (-1, 1):
        beyond = values[np.clip(far[:, None] + side * np.arange(half, MEDIAN_WIDTH), 0, last)]
        steep = np.abs(slope) * (after - before) > MIN_SLOPE_SCATTER * least[far]
        distances.append(np.where(steep, values[far] - _continued(beyond), off[far]))
    bend = np.abs(course[before] - 2 * course[far] + course[after])
    bent = bend > MIN_BEND_SCATTER * least[far]
    bent &= (far >= MEDIAN_WIDTH) & (far <= last - MEDIAN_WIDTH)
    around = values[np.clip(far[:, None] + AROUND, 0, last)]
    distances.append(np.where(bent, values[far] - around @ PARABOLA_AT_MIDDLE, off[far]))
    one_side = np.all(np.sign(distances) == np.sign(off[far]), axis=0)
    off[far] = np.where(one_side, np.sign(off[far]) * np.min(np.abs(distances), axis=0), 0.0)
    return off


def _continued(readings: Array) -> Array:
    """What straight lines through (k, 5) readings, 4 to 8 places away, read at place 0, (k,)."""
    away = np.arange(MEDIAN_WIDTH // 2, MEDIAN_WIDTH)
    middle = away.mean()
    slope = readings @ (away - middle) / ((away - middle) @ (away - middle))
    return np.asarray(readings.mean(axis=1) - slope * middle)


def _in_blocks(readings: Array, length: int) -> Array:
    """Blocks of this length, (k, length); what is left over belongs to the last block."""
    length = min(length, len(readings))
    return readings[: len(readings) // length * length].reshape(-1, length)


def _scatter(rough: Array, length: int, count: float) -> Array:
    """The scatter of each block of this length, (k,), at least a count."""
    return np.maximum(MAD_TO_SIGMA * median(_in_blocks(rough, length)), count)


def _around(blocks: Array, *, least: bool) -> Array:
    """The least, or the most, of each block and the two beside it."""
    choose = np.minimum if least else np.maximum
    padded = np.pad(blocks, 1, mode="edge")
    return np.asarray(choose(choose(padded[:-2], padded[2:]), blocks))


def _of_readings(blocks: Array, length: int, values: Array) -> Array:
    """What holds for blocks as what holds for their readings."""
    return np.asarray(blocks[np.minimum(np.arange(len(values)) // length, len(blocks) - 1)])


def _beside_a_hole(places: Integers, time: Array) -> Booleans:
    """Which readings have others masked, or much missing, within four on either side."""
    apart = np.diff(places)
    holes = np.flatnonzero((apart > np.median(apart)) | (np.diff(time) > MAX_MISSING_INTERVALS)) + 1
    near = holes[:, None] + np.arange(-(MEDIAN_WIDTH // 2), MEDIAN_WIDTH // 2)
    alone = np.zeros(len(places), bool)
    alone[np.clip(near, 0, len(places) - 1)] = True
    return alone

"""Single readings that have nothing to do with those beside them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.special import erfc

from inertial.arrays import Array, Booleans, Integers
from inertial.signal.detector import (
    Description,
    Detector,
    Event,
    Log,
    Piece,
    channel_name,
    names_of_axes,
    names_of_logs,
    read_in,
)
from inertial.signal.runs import joined
from inertial.signal.scatter import MAD_TO_SIGMA, QUIET_SHARE, median
from inertial.text.messages import _
from inertial.text.numbers import counted, significant, whole

# ---- How far each reading of a channel is from its neighbours, and how much they scatter.

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
NEAR_OFF = 0.675  # sigma, for the median of that distance; 0.58 of white noise, so seldom too high
MIN_COLOUR = 1.3  # ratio of scatters; what is less may be the steps of coarse counts
MIN_BEND_SCATTER = 3.0  # scatters by which twice the median between them is off their sum
MAX_MISSING_INTERVALS = 8  # intervals that are missing: what lies beyond is no neighbour
# Places beyond the readings of a spike, and what a parabola through them reads in their middle.
BESIDE = np.arange(MAX_SPIKE_READINGS, MEDIAN_WIDTH)
AROUND = np.concatenate([-BESIDE, BESIDE])
PARABOLA_AT_MIDDLE = np.linalg.pinv(np.vander(AROUND, 3))[-1]
# Places on one side of a reading, and what a parabola through them reads at it.
BEYOND = np.arange(MEDIAN_WIDTH // 2, 2 * MEDIAN_WIDTH)
PARABOLA_AT_END = np.linalg.pinv(np.vander(BEYOND, 3))[-1]


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
    five after as well, and off parabolas through fourteen, for the pull of a lever arm grows with
    the square of the time; at the turning point of a bend, such as gravity's while the IMU is
    tilted over, where the median lies inside of the bend, off a parabola through six before and six
    after.
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
        longer = values[np.clip(far[:, None] + side * BEYOND, 0, last)]
        for read in (_continued(beyond), longer @ PARABOLA_AT_END):
            distances.append(np.where(steep, values[far] - read, off[far]))
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


# ---- Spikes.


MIN_READINGS = 18  # readings of a channel that a spike can be compared with
MIN_SPIKE_SCATTER = 7.5  # scatters: see `chance`
MIN_GROSS_SCATTER = 40.0  # scatters, where the IMU is moved by hand or rings
MIN_CHANGE_RATIO = 4.0  # times the largest change between readings beside it, there
MAX_FAINT_SHARE = 0.01  # of a spike: what is less beside it in other channels is none of a knock's
MAX_HANDLED_SHARE = 0.1  # of the readings; where more are moved or ring, it is a session by hand
SIDE_READINGS = 24  # readings on each side from which the scatter is taken where it changes
MAX_OTHER_SPIKES = 4  # of them may be spikes as well
FIFTH_LARGEST_SIGMA = 1.37  # sigma: the fifth largest of 24 Gaussian readings
# Of that scatter, which comes from few readings, so that noise alone seldom raises it
SIDE_SCATTER_SHARE = 0.75
NEAR_READINGS = 64  # on each side, whose usual distance counts where the noise changes in a turn
MIN_LEAP = 0.75  # of a spike, by which readings leap to it and back; half where a ramp turns back
MIN_NEIGHBOUR_SHARE = 0.1  # of the largest within nine readings: what is less is not judged
CAMPAIGN_READINGS = 1.2e6  # of a campaign like S0's, among which the largest is sought


@dataclass(frozen=True)
class Spike:
    """A spike: number of its readings, and those of its channel in 1 s and in the log."""

    readings: int
    in_second: float
    in_log: int


class Spikes(Detector):
    """One to three readings far off those before and after, and back again.

    Looked at is what is left of the readings without their running median over 9: nothing of a
    ramp, a step or a steady turn. It is measured by the scatter of the 1024 readings around, or of
    the 64 or the 24 on either side where that is larger, and at least by a count: so an oscillation
    or coarse counts are no spikes. Nor is the top of a change of position, to which nothing leaps.
    A knock shakes several channels at once, and rings: it is none either. Where the IMU is moved by
    hand, or rings, a spike must be a gross one of one reading; in a log of which a tenth is so,
    everywhere. The first and the last reading are not judged, nor those beside readings that are
    masked.

    Cause: a reading was spoilt on its way, or the clock of the IMU was set while it turned. It
    moves the mean of its block, and inflates the noise.
    """

    name = "spike"
    source = "robust z: Iglewicz & Hoaglin, How to Detect and Handle Outliers, 1993"
    severity = 1
    alike = "sensor"
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        if not np.isfinite(log.interval):
            return  # consecutive readings may not be neighbours in time
        counts = np.fmax(np.nan_to_num(log.quantum), np.nan_to_num(log.count))
        time = piece.time / log.interval
        channels = {
            i: Channel.of(places, values, time[places], float(counts[i]), float(log.noise[i]))
            for i in range(6)
            for places, values in [piece.channel(i)]
            if len(places) >= MIN_READINGS
        }
        handled = np.zeros(len(piece), bool)
        for channel in channels.values():
            handled[channel.places] |= channel.handled
        # Hands that move it knock against it while it rests as well.
        handled |= np.mean(handled) > MAX_HANDLED_SHARE
        for i, channel in channels.items():
            for start, end, scatters in _spikes(channel, handled):
                first, last = int(channel.places[start]), int(channel.places[end - 1])
                if handled[first] and end - start > 1:
                    continue  # a knock lasts
                if not _leaps(channel, start, end):
                    continue
                loud = max(MIN_DEVIATION_SCATTER, MAX_FAINT_SHARE * scatters)
                if not _shaken(channels, (first, last), i, loud, bool(handled[first])):
                    k = start + int(np.argmax(np.abs(channel.off[start:end])))
                    yield piece.event(
                        first,
                        last + 1,
                        float(channel.off[k]),
                        channel=i,
                        p_value=chance(scatters),
                        facts=Spike(end - start, 1 / log.interval, len(channel.places)),
                    )

    def describe(self, event: Event, name: str) -> Description:
        assert event.channel is not None
        (scale, unit), facts = read_in(event.channel), event.facts
        many = facts.readings > 1
        moves = scale * event.size * facts.readings
        return Description(
            _(
                "{name}: {readings} of {channel} {value} off the neighbours by {size} {unit}, "
                "at line {line}.",
                name=name,
                readings=counted(facts.readings, "reading"),
                channel=channel_name(event.channel),
                value=_("are") if many else _("is"),
                size=_signed(scale * event.size),
                unit=unit,
                line=event.line,
            ),
            _(
                "Used, {value} would move a mean: that of 1 s by {signed} {unit}, and that of "
                "all {in_log} readings by {signed_2} {unit}.",
                value=_("they") if many else _("it"),
                signed=_signed(moves / facts.in_second),
                unit=unit,
                in_log=whole(facts.in_log),
                signed_2=_signed(moves / facts.in_log),
            ),
            _("{value} masked.", value=_("The readings are") if many else _("The reading is")),
        )

    def describe_many(self, events: Sequence[tuple[str, Event]]) -> Description:
        name, largest = max(events, key=lambda pair: abs(pair[1].size))
        one = self.describe(largest, name)
        assert largest.channel is not None
        scale, unit = read_in(largest.channel)
        return Description(
            _(
                "{count} spikes of the {axes} in {logs}, of up to {size} {unit}. The largest: "
                "{one}",
                count=len(events),
                axes=names_of_axes(events),
                logs=names_of_logs(events),
                size=significant(scale * abs(largest.size), 3),
                unit=unit,
                one=one.sentence,
            ),
            one.consequence,
            _("They are masked: in a rest left out, in a turn interpolated."),
        )


def _signed(value: float) -> str:
    return ("+" if value > 0 else "") + significant(value, 3)


def chance(scatters: float) -> float:
    """The chance of a reading so far off among all of a campaign, if they are Gaussian.

    A reading less a median in which it has no part has 1.09 sigma; the scatter is the least of
    three from 1024 readings each, 4 % too small.
    """
    return float(min(CAMPAIGN_READINGS * erfc(scatters * 0.96 / 1.09 / np.sqrt(2)), 1.0))


def _spikes(channel: Channel, handled: Booleans) -> Iterator[tuple[int, int, float]]:
    """Readings of a channel, and by how many scatters the farthest of them is off."""
    off = np.abs(channel.off)
    far = np.flatnonzero((off > MIN_SPIKE_SCATTER * channel.scatter) & ~channel.alone)
    if not len(far):
        return
    around = np.clip(far[:, None] + np.arange(-NEAR_READINGS, NEAR_READINGS + 1), 0, len(off) - 1)
    scatter = np.maximum.reduce(
        [
            channel.scatter[far],
            SIDE_SCATTER_SHARE * _beside(off, far, MAX_OTHER_SPIKES) / FIFTH_LARGEST_SIGMA,
            np.median(off[around], axis=1) / NEAR_OFF,
        ]
    )
    moved = np.maximum(
        MIN_GROSS_SCATTER * scatter, MIN_CHANGE_RATIO * _beside(channel.change, far, 0)
    )
    # A large spike bends the lines by which what lies beside it is judged.
    near = np.clip(far[:, None] + np.arange(-MEDIAN_WIDTH, MEDIAN_WIDTH + 1), 0, len(off) - 1)
    far_beside = off[near].max(axis=1)
    certain = off[far] > MIN_NEIGHBOUR_SHARE * far_beside
    certain &= off[far] > np.where(handled[channel.places[far]], moved, MIN_SPIKE_SCATTER * scatter)
    far, scatter = far[certain], scatter[certain]
    for start, end in joined(_with_others(off, far, scatter), 0):
        own = (far >= start) & (far < end)
        if own.any() and end - start <= MAX_SPIKE_READINGS:
            yield start, end, float((off[far] / scatter)[own].max())


def _leaps(channel: Channel, start: int, end: int) -> bool:
    """Whether readings leap to these from the one before, and back to the one after.

    Where the rate rises and falls again at once, the highest is off the median of those around it
    by twice of what it is off its neighbours.
    """
    edges = np.array([start, end - 1])
    change = channel.change[[start, min(end, len(channel.change) - 1)]]
    return bool(np.all(change >= MIN_LEAP * np.abs(channel.off[edges])))


def _beside(readings: Array, far: Integers, spared: int) -> Array:
    """The largest readings on either side of each of these, so many spared, (k,)."""
    shifts = np.arange(MAX_SPIKE_READINGS, MAX_SPIKE_READINGS + SIDE_READINGS)
    sides = []
    for places in (far[:, None] - shifts, far[:, None] + shifts + 1):
        there = (places >= 0) & (places < len(readings))
        beside = np.where(there, readings[np.clip(places, 0, len(readings) - 1)], 0.0)
        kept = SIDE_READINGS - 1 - spared
        sides.append(np.partition(beside, kept, axis=1)[:, kept])
    return np.asarray(np.maximum(*sides))


def _with_others(off: Array, far: Integers, scatter: Array) -> Integers:
    """These readings, and those next to them that are off as well."""
    near = far[:, None] + np.arange(-MAX_SPIKE_READINGS, MAX_SPIKE_READINGS + 1)
    there = (near >= 0) & (near < len(off))
    large = off[np.clip(near, 0, len(off) - 1)] > MIN_DEVIATION_SCATTER * scatter[:, None]
    return np.unique(np.append(near[there & large], far))


def _single(off: Booleans) -> Booleans:
    """Which of these stand alone, neither neighbour being off."""
    beside = np.pad(off, 1)
    return np.asarray(off & ~beside[:-2] & ~beside[2:])


def _shaken(
    channels: dict[int, Channel], places: tuple[int, int], i: int, loud: float, handled: bool
) -> bool:
    """Whether more is off at or beside the places, first and last, than this spike of channel i.

    `loud`: scatters by which a reading is off.
    One record alone may be spoilt in several channels, but not while the IMU is moved. Nor does
    another channel count in which single readings are grossly off: what is knocked rings.
    """
    first, last = places
    for j, channel in channels.items():
        start, end = np.searchsorted(
            channel.places, [first - MAX_SPIKE_READINGS, last + MAX_SPIKE_READINGS + 1]
        )
        near = slice(max(start - SIDE_READINGS, 0), end + SIDE_READINGS)
        usual = MAD_TO_SIGMA * float(np.median(np.abs(channel.off[near]))) if end > start else 0.0
        least = np.maximum(channel.least[start:end], usual)
        off = np.abs(channel.off[start:end]) > loud * least
        if j != i and not handled:
            off &= ~(_single(off) & (np.abs(channel.off[start:end]) > MIN_GROSS_SCATTER * least))
        here = (channel.places[start:end] >= first) & (channel.places[start:end] <= last)
        spared = MAX_SPIKE_READINGS if j == i else 0
        if j != i and first == last and not handled:
            off &= ~here
        if np.count_nonzero(off) > spared:
            return True
    return False

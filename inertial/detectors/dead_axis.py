"""A channel that does not change."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import comb, erf

from inertial.arrays import Array, Booleans, Integers
from inertial.sensors import COLUMNS
from inertial.signal.detector import (
    Description,
    Detector,
    Event,
    Log,
    Piece,
    channel_name,
    names_of_axes,
    occurrences,
    read_in,
)
from inertial.signal.rests_and_motions import MIN_HAND_RATE
from inertial.signal.runs import readings_of
from inertial.signal.scatter import (
    BLOCK,
    MAD_TO_SIGMA,
    MIN_NOISE_COUNTS,
    in_blocks,
    median,
    roughness,
    smallest_step,
)
from inertial.text.messages import _, listed
from inertial.text.numbers import significant, whole

# ---- Rotation about a changing axis, seen by two gyros: whether the third may stand still in it.

APART = 8  # readings, from one to the next of three of which the changes are compared
MIN_RATIO = 10.0  # times noise, or a count, by which the rates change sideways in a free rotation
WITHIN_COUNT = 1 / np.sqrt(2 * np.pi)  # of σ counts: σ times the chance to be in the middle one
MAX_STILL_COUNTS = 1.5  # between the readings of a block: one at most


@dataclass(frozen=True)
class FreeRotation:
    """Blocks of readings in which the other two gyros are turned about a changing axis.

    chance: (k,), that of the third one to stay within one count in a block, 1 where they are not;
    still: (k,), where it does.
    """

    chance: Array
    still: Booleans

    @classmethod
    def beside(cls, axis: int, rates: Array, noise: Array, count: float) -> "FreeRotation":
        """As seen beside an axis, 0 to 2.

        A rate that differs by σ counts as freely as the other two do is within half a count with
        the chance 1 / (σ √(2π)) at a time, and for a whole block with less.

        rates: (n, 3), rad/s, NaN where not recorded; noise: (3,), rad/s, NaN of an axis that
        never changes; count: rad/s
        """
        others = np.delete(np.arange(3), axis)
        across = _sideways(rates[:, others])
        least = MIN_RATIO * np.nanmax([count, *noise[others]])
        blocks = rates[: len(across) * BLOCK].reshape(-1, BLOCK, 3)
        extent = np.fmax.reduce(blocks, axis=1) - np.fmin.reduce(blocks, axis=1)
        free = (across > least) & (extent[:, others] > MIN_HAND_RATE).all(axis=1)
        chance = np.ones(len(across))
        chance[free] = WITHIN_COUNT * count / across[free]
        return cls(chance, extent[:, axis] <= MAX_STILL_COUNTS * count)

    def chance_of(self, first: int, after: int) -> float:
        """The chance to stay within one count in the readings [first, after).

        In no block less than the share in which the axis stood still in such a rotation elsewhere:
        a mechanism may turn about all axes but this one.
        """
        start = np.arange(len(self.chance)) * BLOCK
        inside = (start >= first) & (start + BLOCK + 2 * APART <= after)
        elsewhere = (self.chance < 1) & ((start + BLOCK <= first) | (start >= after))
        share = float(self.still[elsewhere].mean()) if elsewhere.any() else 0.0
        return float(np.prod(np.maximum(self.chance[inside], share)))


def _sideways(rates: Array) -> Array:
    """By how much two rates change across their change just before, by blocks, (k,), rad/s.

    About one axis, however it lies and whatever the biases, two rates keep the ratio of their
    changes, and nothing is left across it but noise. It is the median of a block, so that where one
    turn ends as another begins does not count. Readings that are not there count as unchanged.

    rates: (n, 2), rad/s
    """
    change = np.nan_to_num(rates[APART:] - rates[:-APART])
    before, after = change[:-APART], change[APART:]
    length = np.maximum(np.hypot(*before.T), np.hypot(*after.T))
    area = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
    across = in_blocks(np.divide(area, length, out=np.zeros_like(area), where=length > 0))
    return median(across) if len(across) else np.empty(0)


# ---- Channels that do not change.


MAX_CHANCE = 1e-4  # chance of so long a run of equal readings in a log
MIN_RUN = 4  # equal readings; fewer may be spikes
MIN_LEAP_RATIO = 20.0  # times the changes beside a run, by which the readings leap to it and back
MAX_LEAP_CHANCE = 1e-6  # chance that they do so by themselves
MIN_ROUGH_TURNS = 1.5  # counts: readings that alternate between two counts have 1.05
SMOOTH = 6  # order of the differences that are left of a smooth motion
SIDE_READINGS = 8  # readings before a run and after it
MIN_FAR = 0.8  # of the largest reading of the log: a filter overshoots what is cut off before it
MIN_COMMON_RUN = 1000  # equal readings of all axes, where nothing is known of their noise


@dataclass(frozen=True)
class Stillness:
    """A constant channel: its reading, whether throughout the log, and for how many s.

    far: whether no reading of the log is much larger.
    """

    level: float
    always: bool
    seconds: float
    far: bool


class DeadAxis(Detector):
    """A channel that reads the same for longer than its noise allows.

    How much noise it has is seen in the rest of the log, or, where it never changes, in the other
    axes of the same sensor, without what is smooth in them: they may be turned. With noise of
    σ counts a reading falls into the count in the middle with the chance p = erf(1 / (√8 σ)), and L
    in a row into the same one with p^L (1 + σ √(2π/L)), times all readings of the log; with no less
    than q^L where a share q of the other readings repeats the one before, as in steady turns. Fewer
    suffice where they leap to a value far away and back.

    Where the noise is less than 0.6 counts an axis may well stand still: that is `quantisation`,
    and nothing is said here, unless it is a gyro that does so while the other two are turned about
    a changing axis, see `FreeRotation`. Nothing is said of a sensor none of whose axes changes.

    Cause: a sensor, its wire or its converter failed, or the driver writes an old value. Bias and
    scale factor of the axis are wrong, and every cross term with it.
    """

    name = "dead_axis"
    source = "the chance that two Gaussian readings fall into one count"
    unit = "samples"
    severity = 3
    masks = True
    alike = "records"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        channels = [_Channel.of(*readings_of(piece, log, i)) for i in range(6)]
        for i, own in enumerate(channels):
            chance = _chances(piece, channels, i, 6 * log.records)
            named = ~(chance > MAX_CHANCE) & (own.length >= MIN_RUN)
            for k in np.flatnonzero(named).tolist():
                number = int(own.length[k])
                yield piece.event(
                    *own.records(k),
                    float(number),
                    channel=i,
                    p_value=float(chance[k]) if np.isfinite(chance[k]) else None,
                    facts=Stillness(
                        float(own.values[own.start[k]]),
                        bool(log.least[i] == log.most[i]),
                        number * log.interval,
                        abs(own.values[own.start[k]]) > MIN_FAR * max(-log.least[i], log.most[i]),
                    ),
                )

    def describe(self, event: Event, name: str) -> Description:
        assert event.channel is not None
        facts, (scale, unit) = event.facts, read_in(event.channel)
        level, number = f"{significant(scale * facts.level, 6)} {unit}", whole(event.size)
        means = _("Their mean is {level}, whatever the IMU did", level=level)
        if event.channel >= 3 and np.isfinite(facts.seconds):
            angle = significant(scale * facts.level * facts.seconds, 3)
            means = _(
                "They add {angle}° in {seconds:.2f} s, whatever the IMU did",
                angle=angle,
                seconds=facts.seconds,
            )
        return Description(
            _(
                "{name}: {channel_name} reads {level} ",
                name=name,
                channel_name=channel_name(event.channel),
                level=level,
            )
            + (
                _("in all {number} readings of the log.", number=number)
                if facts.always
                else _(
                    "{number} times in a row, from line {line} on.", number=number, line=event.line
                )
            ),
            _(
                "{means}: bias, scale factor and cross terms of this axis would be wrong.",
                means=means,
            ),
            _("The readings are masked; what cannot do without them must be recorded again.")
            + _other_cause(facts),
        )

    def describe_many(self, events: Sequence[tuple[str, Event]]) -> Description:
        channels = {event.channel for _name, event in events}
        if len(channels) == 1:
            return super().describe_many(events)
        name, largest = max(events, key=lambda pair: pair[1].size)
        of_one = [pair for pair in events if pair[1].channel == largest.channel]
        by_sensor = [
            [pair for pair in events if pair[1].channel in range(6)[columns]]
            for columns in COLUMNS.values()
        ]
        sentence = _(
            "{name}: {axes} stand still together, {number} times in a row, from line {line} on.",
            name=name,
            axes=listed([names_of_axes(own) for own in by_sensor if own]),
            number=whole(largest.size),
            line=largest.line,
        )
        if len(of_one) > 1:
            sentence = f"{sentence} {occurrences(of_one)}"
        return Description(
            sentence,
            _(
                "What they read then is no motion: bias, scale factors and cross terms of these "
                "axes would be wrong."
            ),
            _(
                "The readings are masked; what cannot do without them must be recorded again. "
                "Axes that stop together have one cause: the logger, the link, or a fill value."
            )
            + _other_cause(largest.facts),
        )


def _other_cause(facts: Stillness) -> str:
    """What else reads the same, and its cure."""
    if not facts.level:
        return _(
            " Exactly 0 is also what a firmware writes below a threshold, or while it "
            "takes the IMU to be at rest: switch that off."
        )
    if facts.always:
        return _(
            " It may also be the limit of the range, exceeded throughout the log: then record it "
            "within the range."
        )
    if facts.far:
        return _(
            " It may also be the end of the range, before a filter: then turn more slowly, or "
            "choose a wider range."
        )
    return ""


@dataclass(frozen=True, eq=False)
class _Channel:
    """A channel with its runs of equal readings.

    places: (m,), where in the piece; values: (m,); start, end: (k,), first reading of a run and the
    one after it; count: its smallest step; noise: in counts, NaN where it never changes.
    """

    places: Integers
    values: Array
    start: Integers
    end: Integers
    count: float
    noise: float

    @classmethod
    def of(cls, places: Integers, values: Array) -> "_Channel":
        """By where it is recorded, and what it reads there."""
        start, end = _runs(values)
        return cls(places, values, start, end, smallest_step(values), _noise(values, start, end))

    @property
    def jitter(self) -> float:
        """Its noise in counts without what is smooth in it: it may be all that moves."""
        return min(self.noise, roughness(self.values, SMOOTH) / self.count)

    @property
    def length(self) -> Integers:
        """Of the runs, (k,)."""
        return self.end - self.start

    def records(self, k: int) -> tuple[int, int]:
        """The first place in the piece of a run, and the one after its last."""
        return int(self.places[self.start[k]]), int(self.places[self.end[k] - 1]) + 1

    def equal_elsewhere(self, k: int) -> float:
        """The share of the readings outside a run that are equal to the one before."""
        outside = len(self.values) - int(self.length[k])
        return (outside - len(self.length) + 1) / outside if outside else 0.0

    def chance_by_noise(self, usual: float, readings: int) -> Array:
        """The chance of each run by noise, (k,), of so many readings; usual: noise, counts."""
        leapt = _leapt_to(self.values, self.start, self.end)
        tests = readings * np.where(leapt, MAX_LEAP_CHANCE, 1.0)
        chance = tests * _chance(self.length, usual)
        for k in np.flatnonzero(chance < MAX_CHANCE).tolist():
            beside = _quieter(self.values, int(self.start[k]), int(self.end[k]), usual)
            alike = self.equal_elsewhere(k) ** self.length[k]
            chance[k] = tests[k] * max(_chance(self.length[k : k + 1], beside)[0], alike)
        return np.asarray(chance)


def _chances(piece: Piece, channels: Sequence[_Channel], i: int, readings: int) -> Array:
    """The chance of each run of channel i, (k,), in so many readings of a log.

    NaN, not known, where its whole sensor stands still and the other one does not.
    """
    axes = COLUMNS["accel" if i < 3 else "gyro"]
    own, changing = channels[i], [each for each in channels[axes] if np.isfinite(each.noise)]
    if not changing:
        loudest = max(np.nan_to_num([channel.noise for channel in channels]))
        still = len(own.values) >= MIN_COMMON_RUN and loudest > MIN_NOISE_COUNTS
        return np.full(len(own.length), np.nan if still else 1.0)
    usual = own.noise if own in changing else min(each.jitter for each in changing)
    chance = own.chance_by_noise(usual, readings)
    long = np.flatnonzero((own.length > BLOCK) & (chance > MAX_CHANCE)).tolist()
    if i >= 3 and long:
        turned = _turned(piece, i - axes.start, channels[axes])
        for k in long:
            chance[k] = min(chance[k], readings * turned.chance_of(*own.records(k)))
    return chance


def _turned(piece: Piece, axis: int, gyros: Sequence[_Channel]) -> FreeRotation:
    """Where the other gyros are turned freely, for a gyro by its number, 0 to 2."""
    counts = np.array([gyro.count for gyro in gyros])
    noise = counts * np.array([gyro.noise for gyro in gyros])
    count = float(counts[np.isfinite(counts)].max())
    return FreeRotation.beside(axis, piece.values[:, COLUMNS["gyro"]], noise, count)


def _chance(length: Integers, rough: float) -> Array:
    """The chance that a run of so many equal readings begins at a reading.

    rough: counts, of the channel, of which carried counts are 1/2; where it is not known the
    chance is one.
    """
    if rough < MIN_NOISE_COUNTS:
        return np.ones(len(length))
    noise = np.sqrt(rough**2 - 1 / 4)
    middle = erf(1 / (np.sqrt(8) * noise))
    return np.asarray(middle**length * (1 + noise * np.sqrt(2 * np.pi / length)))


def _quieter(values: Array, start: int, end: int, usual: float) -> float:
    """The roughness beside a run, if it is less than the usual one of the log, in counts.

    Most of a log may be louder than that: it may oscillate, or a rest may be short. Another run
    beside it does not count.
    """
    count, rough = smallest_step(values), [usual]
    for width in (end - start, BLOCK):
        for side in (values[max(start - width, 0) : start + 1], values[end - 1 : end + width]):
            change = np.abs(np.diff(side)) / count
            by_one = 0 < change.max(initial=0.0) < MAX_STILL_COUNTS  # from count to count
            if len(change) >= width and (by_one or (width == BLOCK and change.any())):
                rough.append(float(np.sqrt(np.mean(change**2) / 2)))
    return min(rough)


def _leapt_to(values: Array, start: Integers, end: Integers) -> Booleans:
    """Which runs lie far from the readings before and from those after, (k,)."""
    change = np.abs(np.diff(values))
    leapt = np.zeros(len(start), bool)
    far = MIN_LEAP_RATIO * smallest_step(values)
    inside = (
        (end - start >= MIN_RUN) & (start >= SIDE_READINGS) & (end <= len(values) - SIDE_READINGS)
    )
    for k in np.flatnonzero(inside):
        first, after = int(start[k]), int(end[k])
        leap = min(change[first - 1], change[after - 1])
        if leap > far:
            beside = (
                change[first - SIDE_READINGS : first - 1],
                change[after : after + SIDE_READINGS - 1],
            )
            leapt[k] = leap > MIN_LEAP_RATIO * max(side.max() for side in beside)
    return leapt


def _runs(values: Array) -> tuple[Integers, Integers]:
    """Runs of equal readings: first place and place after the last, (k,) each."""
    edges = np.flatnonzero(np.diff(values, prepend=np.nan, append=np.nan) != 0)
    return edges[:-1], edges[1:]


def _noise(values: Array, start: Integers, end: Integers) -> float:
    """The roughness of a channel in counts, without its longest run; NaN where it has no other.

    Or, where that is clearly more, what is left of a smooth motion of it between all its long runs:
    a channel that stands still in every rest has its noise in the turns alone.
    """
    if len(start) < 2:
        return np.nan
    count, length = smallest_step(values), end - start
    longest = int(np.argmax(length))
    rest = np.delete(values, slice(start[longest], end[longest]))
    usual = roughness(rest) / count
    long = np.flatnonzero(length > BLOCK)
    stretches = zip([0, *end[long]], [*start[long], len(values)], strict=True)
    between = [
        _typical(values[first:after]) / count for first, after in stretches if after - first > BLOCK
    ]
    least = min(between, default=0.0)
    return max(usual, least) if least > MIN_ROUGH_TURNS else usual


def _typical(values: Array) -> float:
    """The scatter of readings in a smooth motion, of which ramps begin and end here and there."""
    change = np.abs(np.diff(values, SMOOTH))
    return float(MAD_TO_SIGMA * np.median(change) / np.sqrt(comb(2 * SMOOTH, SMOOTH)))

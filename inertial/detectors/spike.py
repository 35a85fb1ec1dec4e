"""Single readings that have nothing to do with those beside them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

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
from inertial.signal.outliers import (
    MAX_SPIKE_READINGS,
    MEDIAN_WIDTH,
    MIN_DEVIATION_SCATTER,
    Channel,
)
from inertial.signal.runs import joined
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.text.messages import _
from inertial.text.numbers import counted, significant, whole

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
    the 24 on either side where that is larger, and at least by a count: so an oscillation or
    coarse counts are no spikes. Nor is the top of a change of position, to which nothing leaps. A
    knock shakes several channels at once, and rings: it is none either. Where the IMU is moved by
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
    scatter = np.maximum(
        channel.scatter[far],
        SIDE_SCATTER_SHARE * _beside(off, far, MAX_OTHER_SPIKES) / FIFTH_LARGEST_SIGMA,
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

"""Short disturbances: a blow against the case or the table, and glitches of one phase."""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from inertial.arrays import Array, Booleans
from inertial.sensors import COLUMNS
from inertial.signal.detector import (
    Description,
    Detector,
    Event,
    Log,
    Piece,
    names_of_axes,
    names_of_logs,
    read_in,
)
from inertial.signal.phase_folding import Glitch
from inertial.signal.runs import joined, new_readings
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant, whole
from inertial.text.units import STANDARD_GRAVITY

MIN_ROUGH_SIGMA = 8.0  # sigma of noise, by which a second difference is none
MIN_CHANNELS = 4  # that are shaken at once; a table that turns up moves one axis
MIN_RECORDS = 6  # a spoilt record has second differences in three, three of them in five
MAX_SECONDS = 2.0  # s; what lasts longer is a motion or an oscillation, unless it dies away
MAX_RINGING_SECONDS = 8.0  # s, of what dies away
MAX_LEFT_OF_RINGING = 0.5  # in the second half of what lasts so long, of the first
MAX_BREAK = 8  # records within it in which fewer channels are shaken
MIN_SHAKEN_SHARE = 0.5  # of its records
SIDE_RECORDS = 32  # before and after, which are quiet
MAX_QUIET_ROUGH = 3.0  # times the noise of the log: the median of them
# Of the peak, that may remain in a channel afterwards: a turn or a ramp goes on meanwhile
MAX_LEFT_SHARE = 0.3
# Of the way there and back, that may remain of the angle of a gyro: a hand that turns leaves it
MAX_NET_SHARE = 0.5
TAIL_SHARE = 0.5  # of its length, in which what rings below the noise of a record dies away
LEFT_ROUGH = 0.2  # sigma of noise, below which a mean does not show what rings on
MAX_RINGING = 2.0  # lengths of a burst, for which it is taken to ring on
MIN_LEAP = 3 * STANDARD_GRAVITY  # m/s², of |f| by a blow of a record or two
MIN_LEAP_OF_CHANNEL = STANDARD_GRAVITY  # m/s², in more than one channel
MAX_LEAP_RECORDS = 3
MAX_RATE = 0.5  # rad/s, by which a gyro may differ then from what it reads beside it


@dataclass(frozen=True)
class Blow:
    """Duration of an impact, s, and how many channels it shakes."""

    seconds: float
    channels: int


class Impact(Detector):
    """A short burst in most channels at once, after which everything is as before.

    Noise is seen in the second differences, of which a steady turn and a ramp have none; of white
    noise they have √6 σ. In a burst most channels exceed it by far, for more records than a spoilt
    one has, and the magnitude of the specific force changes; before it and after it they do not,
    and what they read then is the same. So it is no spike, no motion, and no oscillation.

    Cause: something struck the case or the table, or a switch or a brake did. The mean of a short
    rest is wrong, and its noise too large.
    """

    name = "impact"
    source = "mikoff, IMU 4: a knock in a rest, which rings for some tenths of a second"
    unit = "m/s²"
    severity = 1
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        noise = np.fmax(log.noise, np.nan_to_num(log.quantum))
        known = [i for i in range(6) if np.isfinite(noise[i]) and noise[i] > 0]
        if not np.isfinite(log.interval) or len(known) < MIN_CHANNELS:
            return
        rough = np.full((len(piece), 6), np.nan)
        for i in known:
            places, values = piece.channel(i)
            if len(places) > 2:
                rough[places[1:-1], i] = np.abs(np.diff(values, 2)) / (np.sqrt(6) * noise[i])
        above = np.nan_to_num(rough) > MIN_ROUGH_SIGMA
        shaken, at_all = np.count_nonzero(above, axis=1) >= MIN_CHANNELS, above.any(axis=1)
        runs = list(joined(np.flatnonzero(at_all), MAX_BREAK))
        firsts = [first for first, _after in runs]
        for start, end in joined(np.flatnonzero(shaken), MAX_BREAK):
            # Where a sensor rings on that is shaken more, the burst lasts as long as that does.
            _first, longest = runs[bisect_right(firsts, start) - 1]
            for own, after in ((shaken, end), (at_all, longest)):
                left = _left(rough[start:after])
                if own is at_all and left > MAX_LEFT_OF_RINGING:
                    continue
                if not _short_and_dense(own, start, after, left, log.interval):
                    continue
                if not _quiet(rough, start, after):
                    continue
                blow = _blow(piece.values, start, after, noise)
                if blow is not None:
                    tail = max(_tail(start, after), _ringing(after - start, left))
                    yield _event(piece, log, start, after + tail, *blow)
                    break

        yield from _single(piece, log)

    def describe(self, event: Event, name: str) -> Description:
        blow: Blow = event.facts
        return Description(
            _(
                "{name}: an impact of {size} m/s² at line {line} shakes {channels} for "
                "{seconds} s.",
                name=name,
                size=significant(event.size, 2),
                line=event.line,
                channels=counted(blow.channels, "channel"),
                seconds=significant(blow.seconds, 2),
            ),
            _(
                "Its records say nothing of the rest or the turn, and are masked. If it turned the "
                "IMU in its fixture, where no position is recorded on both sides of it, the "
                "cross-axis terms have taken that."
            ),
            _("After a blow record a position again that was recorded before it."),
        )


def _single(piece: Piece, log: Log) -> Iterator[Event]:
    """Blows of a record or two: the case is struck while a hand moves it, or sets it down.

    The specific force leaps by several g in more than one channel, and the gyros do not leap: so
    it is no spoilt record.
    """
    values = piece.values
    if len(values) < SIDE_RECORDS or not np.isfinite(log.interval):
        return
    force = np.linalg.norm(values[:, :3], axis=1)
    usual = median_filter(force, SIDE_RECORDS // 2 + 1)
    for start, end in joined(np.flatnonzero(force - usual > MIN_LEAP), 1):
        around = values[[max(start - 2, 0), min(end + 1, len(values) - 1)]]
        leap = np.abs(values[start:end] - np.median(around, axis=0)).max(axis=0)
        turned = np.abs(np.diff(around, axis=0)[0])
        several = np.count_nonzero(leap[:3] > MIN_LEAP_OF_CHANNEL) > 1
        if (
            end - start <= MAX_LEAP_RECORDS
            and several
            and (leap[3:] <= turned[3:] + MAX_RATE).all()
        ):
            size = float((force - usual)[start:end].max())
            first, after = max(start - 1, 0), min(end + 2, len(values))
            yield piece.event(first, after, size, facts=Blow((after - first) * log.interval, 3))


def _event(piece: Piece, log: Log, start: int, end: int, peak: float, channels: int) -> Event:
    start, end = max(start - 1, 0), min(end, len(piece))
    return piece.event(start, end, peak, facts=Blow((end - start) * log.interval, channels))


def _short_and_dense(shaken: Booleans, start: int, end: int, left: float, interval: float) -> bool:
    number = end - start
    longest = (MAX_RINGING_SECONDS if left < MAX_LEFT_OF_RINGING else MAX_SECONDS) / interval
    dense = np.count_nonzero(shaken[start:end]) > MIN_SHAKEN_SHARE * number
    return bool(MIN_RECORDS <= number <= longest and dense)


def _sides(values: Array, start: int, end: int) -> tuple[Array, Array]:
    """The records before a burst and those behind its tail."""
    tail = end + _tail(start, end)
    return values[max(start - 1 - SIDE_RECORDS, 0) : max(start - 1, 0)], values[tail:][
        :SIDE_RECORDS
    ]


def _tail(start: int, end: int) -> int:
    return max(round(TAIL_SHARE * (end - start)), 2)


def _left(rough: Array) -> float:
    """How rough these records, (n, 6), are in their second half, of the first; 1: no less."""
    if not (half := len(rough) // 2):
        return 1.0
    first, second = (
        float(np.median(np.nan_to_num(part).max(axis=1))) for part in (rough[:half], rough[half:])
    )
    return second / first if 0 < second < first else 1.0


def _ringing(records: int, left: float) -> int:
    """For how many records what shook so many rings on below the noise of a record.

    It dies away exponentially, as from their first half to their second, of which that is `left`.
    """
    if left == 1:
        return 0
    on = records / 2 / -np.log(left) * np.log(MIN_ROUGH_SIGMA / LEFT_ROUGH)
    return round(float(min(on, MAX_RINGING * records)))


def _quiet(rough: Array, start: int, end: int) -> bool:
    """Whether all channels are as quiet as usual before a burst and behind it."""
    for side in _sides(rough, start, end):
        read = side[:, np.isfinite(side).any(axis=0)]
        if len(read) < SIDE_RECORDS // 2 or not read.size:
            return False
        if (np.nanmedian(read, axis=0) > MAX_QUIET_ROUGH).any():
            return False
    return True


def _blow(values: Array, start: int, end: int, noise: Array) -> tuple[float, int] | None:
    """The largest change of the specific force, m/s², and how many channels are shaken.

    None where the magnitude of the force does not change, or a channel reads something else
    afterwards.
    """
    before, behind = (_means(side) for side in _sides(values, start, end))
    peak = np.nanmax(np.abs(values[start:end] - before), axis=0, initial=0.0)
    least = MIN_ROUGH_SIGMA * noise
    with np.errstate(invalid="ignore"):
        changed = np.abs(behind - before) > np.fmax(MAX_LEFT_SHARE * peak, least)
    force = np.linalg.norm(values[start:end, :3], axis=1) - np.linalg.norm(before[:3])
    swings = values[start:end, 3:] - before[3:]
    net, way = np.abs(np.nansum(swings, axis=0)), np.nansum(np.abs(swings), axis=0)
    if (net[peak[3:] > least[3:]] > MAX_NET_SHARE * way[peak[3:] > least[3:]]).any():
        return None
    if changed.any() or not np.isfinite(force).any():
        return None
    largest = float(np.nanmax(np.abs(force)))
    if largest < np.nanmax(least[:3]):
        return None
    return largest, int(np.count_nonzero(peak > least))


def _means(side: Array) -> Array:
    """The mean of each channel, NaN where it is not recorded."""
    number = np.isfinite(side).sum(axis=0)
    return np.where(number > 0, np.nansum(side, axis=0) / np.maximum(number, 1), np.nan)


# ---- Readings that are off at one phase of a period.


@dataclass(frozen=True)
class Hit:
    """A reading that is off: what it is part of, and what its description needs.

    noise: of a reading, unit of the channel; readings: of the log.
    """

    glitch: Glitch
    noise: float
    readings: int


class PeriodicGlitch(Detector):
    """A sample that is off whenever its stamp has one phase of a period.

    Each alone may lie within the noise, and logs of a fraction of a second show it if there are
    several. Periods of 0.1 s to 60 s are sought at every phase, in all logs of a clock together:
    a channel that is off by a constant, or a sensor by a share of what it reads, as where the
    interval of that sample is another one. Where most phases are off it is an oscillation. One
    clean campaign in 10,000 shows one.

    Cause: the logger or the clock of the IMU does something else once in every period. The mean of
    every channel concerned, or a scale factor, is off by its share of the samples.
    """

    name = "periodic_glitch"
    source = "WHU, XW-GI7681: stamped .010 of a GPS second, the gyro that turns reads 0.15 % more"
    alike = "sensor"
    severity = 1
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        for glitch in log.glitches:
            own = range(6)[COLUMNS[glitch.sensor]] if glitch.channel is None else [glitch.channel]
            places = np.flatnonzero(_falls_on(glitch, piece, log))
            for start, end in joined(places, 0):
                for i in own:
                    readings = piece.values[start:end, i]
                    if not np.isfinite(readings).all():
                        continue
                    size = glitch.size
                    if glitch.channel is None:
                        size *= float(readings[0]) / (1 + size)
                    hit = Hit(glitch, float(log.noise[i]), log.records)
                    yield piece.event(
                        start, end, size, channel=i, p_value=glitch.p_value, facts=hit
                    )

    def describe(self, event: Event, name: str) -> Description:
        return self.describe_many([(name, event)])

    def describe_many(self, events: Sequence[tuple[str, Event]]) -> Description:
        _name, largest = max(events, key=lambda pair: abs(pair[1].size))
        assert largest.channel is not None
        hit: Hit = largest.facts
        glitch = hit.glitch
        scale, unit = read_in(largest.channel)
        own = [(log, event) for log, event in events if event.facts.glitch == glitch]
        # An instant at the border of two phases falls on one record, in either of them.
        off = len({(log, event.first) for log, event in own})
        share = off / sum({log: event.facts.readings for log, event in own}.values())
        return Description(
            _(
                "At {phase} s of every {period} s{others} the {axes} read {size} {unit} too "
                "much{share}: {count} samples in {logs}.",
                phase=fixed(glitch.phase, 3),
                period=f"{glitch.period:g}",
                others=_or_shorter(glitch),
                axes=names_of_axes(events),
                size=significant(scale * largest.size, 3),
                unit=unit,
                share=_share(glitch),
                count=whole(len({(log, one.first) for log, one in events})),
                logs=names_of_logs(events),
            ),
            _moves(hit, largest.channel, share),
            _(
                "They are masked: in a rest left out, in a turn interpolated. Find out what the "
                "logger or the clock does once in every {period} s.",
                period=f"{glitch.period:g}",
            ),
        )


def _falls_on(glitch: Glitch, piece: Piece, log: Log) -> Booleans:
    """Which records have a reading of this phase, (n,): a reading that is held is off again."""
    off = glitch.falls_on(piece.time)
    own = COLUMNS[glitch.sensor]
    if not log.held[own.start // 3]:
        return off
    new = new_readings(piece.values[:, own])
    number = np.cumsum(new)
    return np.isin(number, number[off & new])


def _or_shorter(glitch: Glitch) -> str:
    if not glitch.others:
        return ""
    periods = _(" or ").join(f"{period:g}" for period in glitch.others)
    return _(" (of {periods} s as well, by what is recorded)", periods=periods)


def _share(glitch: Glitch) -> str:
    if glitch.channel is not None:
        return ""
    return _(", {percent} % of what they read", percent=significant(100 * glitch.size, 2))


def _moves(hit: Hit, channel: int, share: float) -> str:
    """What they would do to the result, and how much that is beside the noise.

    `share`: of the readings of these logs, that are off.
    """
    glitch = hit.glitch
    if glitch.channel is None:
        return _(
            "Used, they would make the scale factors of all axes {ppm} ppm too large.",
            ppm=significant(1e6 * glitch.size * share, 2),
        )
    shift = glitch.size * share
    scale, unit = read_in(channel)
    return _(
        "Used, they would move every mean by {size} {unit}: {sigmas} times the noise of the mean "
        "of this log.",
        size=significant(scale * shift, 2),
        unit=unit,
        sigmas=significant(abs(shift) / hit.noise * float(np.sqrt(hit.readings)), 2),
    )

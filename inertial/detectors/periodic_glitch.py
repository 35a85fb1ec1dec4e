"""Readings that are off at one phase of a period."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Booleans
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
from inertial.text.numbers import fixed, significant, whole


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

"""Samples that were never written."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.stamps import disorders, stamps_of
from inertial.text.messages import _, plural
from inertial.text.numbers import fixed, significant

MIN_GAP_INTERVALS = 1.5  # median intervals: what is no jitter of the stamps any more
SIDE_STAMPS = 4  # stamps on either side that must agree
SIDE_RECORDS = 16  # on either side, of which the rate is taken
MIN_TURN_RATE = np.radians(0.5)  # rad/s: more than any gyro's bias
MAX_RATE_CHANGE = 0.05  # of the rate, across a gap in a steady part


@dataclass(frozen=True)
class Lost:
    """What a gap lacks: seconds; rate before and after it, rad/s, NaN without gyros.

    unread: lines of the log in place of the samples, which hold none that can be read.
    """

    seconds: float
    before: float
    after: float
    unread: int = 0

    @property
    def turning(self) -> bool:
        """Whether the IMU turns before it or after it."""
        return bool(np.fmax(self.before, self.after) > MIN_TURN_RATE)

    @property
    def steady(self) -> bool:
        """Whether it turns at one rate."""
        return abs(self.after - self.before) < MAX_RATE_CHANGE * max(self.before, self.after)


class Gap(Detector):
    """An interval between two records in which at least one sample is missing.

    Cause: the logger lost samples, or the file was not written whole. A sum over the gap lacks what
    was not recorded, so the scale factor of a turn is wrong.
    """

    name = "gap"
    source = "S0, lines 2192 and 2193 of its z counter-clockwise log: 11.98 s are missing"
    unit = "samples"
    severity = 1

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        stamps = stamps_of(piece, log)
        # Stamps that are out of order make no gap, but their records are there.
        ordered = np.ones(len(stamps), bool)
        for disorder in disorders(stamps.time, piece.reached, log.interval):
            ordered[disorder.start : disorder.end] = False
        place, time = np.flatnonzero(ordered), stamps.time[ordered]
        usual = int(np.median(np.diff(piece.line[stamps.place]))) if len(stamps) > 1 else 0
        for k in np.flatnonzero(np.diff(time) > MIN_GAP_INTERVALS * log.interval):
            later = time[k + 1 : k + 1 + SIDE_STAMPS]
            earlier = time[max(k + 1 - SIDE_STAMPS, 0) : k + 1][::-1]
            # A stamp that is late or early by itself makes no gap: those beside it do not agree.
            surely = (later - log.interval * np.arange(len(later))).min()
            surely -= (earlier + log.interval * np.arange(len(earlier))).max()
            missing = round((time[k + 1] - time[k]) / log.interval) - (place[k + 1] - place[k])
            if missing > 0 and surely > MIN_GAP_INTERVALS * log.interval:
                before, after = stamps.place[place[k : k + 2]].tolist()
                unread = int(piece.line[after] - piece.line[before]) - usual
                yield Event(
                    int(piece.record[after]),
                    int(piece.record[after]),
                    int(piece.line[after]),
                    float(time[k]),
                    float(time[k + 1]),
                    float(missing),
                    facts=Lost(
                        missing * log.interval,
                        _rate(piece.values[max(after - SIDE_RECORDS, 0) : after]),
                        _rate(piece.values[after : after + SIDE_RECORDS]),
                        unread if unread >= missing * usual else 0,
                    ),
                )

    def describe(self, event: Event, name: str) -> Description:
        lost: Lost = event.facts
        sentence = plural(
            "{name}: gap of {seconds} s: {count} sample is missing between {from_s} s and {to_s} s;"
            " line {line} is the first after it.",
            "{name}: gap of {seconds} s: {count} samples are missing between {from_s} s and {to_s}"
            " s; line {line} is the first after them.",
            round(event.size),
            name=name,
            seconds=significant(lost.seconds, 3),
            from_s=fixed(event.from_s, 3),
            to_s=fixed(event.to_s, 3),
            line=event.line,
        )
        look = _("Find what loses samples, such as a buffer, a cable or a disk.")
        if lost.unread:
            sentence += " " + plural(
                "In its place the log has {count} line that cannot be read.",
                "In their place the log has {count} lines that cannot be read.",
                lost.unread,
            )
            look = _("Look at these lines of the log, and find what damages them.")
        if not lost.turning and lost.unread:
            return Description(sentence, _("A mean of a rest hardly changes by it."), look)
        if not lost.turning:
            return Description(
                sentence,
                _(
                    "A mean of a rest hardly changes by it. Or no sample is missing, and the clock "
                    "was set forward: readings at rest do not tell these apart."
                ),
                _(
                    "Find what loses samples, such as a buffer, a cable or a disk, or sets the "
                    "clock."
                ),
            )
        if not lost.steady:
            return Description(
                _(
                    "{sentence} The rate is {before} °/s before and {after} °/s after it.",
                    sentence=sentence,
                    before=significant(float(np.degrees(lost.before)), 3),
                    after=significant(float(np.degrees(lost.after)), 3),
                ),
                _(
                    "How far it turned meanwhile is not known by the gyros, nor the attitude after "
                    "it."
                ),
                _("A turn that lacks these samples is left out: record it again."),
            )
        angle = float(np.degrees((lost.before + lost.after) / 2 * lost.seconds))
        return Description(
            _(
                "{sentence} At the rate before and after it the IMU turned by {angle}° during "
                "the gap.",
                sentence=sentence,
                angle=significant(angle, 3),
            ),
            _(
                "The sum of increments over the turn lacks about {angle}°. The joint fit can "
                "interpolate it where the rate is steady for at least 1 s (or the length of the "
                "gap, if shorter) on both sides; whole-turn formulas do not use this turn.",
                angle=significant(angle, 3),
            ),
            look,
        )


def _rate(values: Array) -> float:
    """The magnitude of the mean rate over some records, (n, 6), rad/s; NaN without gyros."""
    rates = values[:, 3:]
    rates = rates[np.isfinite(rates).any(axis=1)]
    there = np.isfinite(rates).all(axis=0) if len(rates) else np.zeros(3, bool)
    return float(np.linalg.norm(rates[:, there].mean(axis=0))) if there.any() else np.nan

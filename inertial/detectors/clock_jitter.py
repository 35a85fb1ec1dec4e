"""Stamps that scatter about an even clock, or are rounded."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Integers
from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.runs import joined
from inertial.signal.stamps import STAMP_DIGIT_S, stamps_of, unit_of
from inertial.text.messages import _
from inertial.text.numbers import significant

# Share of an interval by which stamps may scatter. A rate made from stamp to stamp would then
# scatter by 1.4 %, as much as a bad consumer gyro is off; a receiver's stamps keep to 10⁻⁷.
MAX_JITTER_SHARE = 0.01
STRETCH_STAMPS = 32  # stamps in which the clock is taken as even
MAX_BACKWARD_INTERVALS = 3.0  # intervals: where time goes back by more, the clock was set
MIN_STAMPS = 8  # of them, where a log is shorter
MIN_STRETCHES = 3  # stretches that must scatter: one alone is a jump or a change of the clock
# Stretches between those that scatter, in which rounded stamps may happen to fit
MAX_QUIET_STRETCHES = 10
MIN_ROUNDING_S = 1e-6  # s: to finer steps than that stamps are printed, not rounded


@dataclass(frozen=True)
class _Facts:
    """The scatter as a share of an interval; unit of rounded stamps and the intervals, s.

    unit is 0 where stamps are not rounded.
    """

    share: float
    unit: float
    shorter: float
    longer: float
    mean: float


class ClockJitter(Detector):
    """Stamps that are off an even clock by more than 1 % of an interval, rms.

    In stretches of 32 stamps a straight line is fitted to stamp against number of the sample;
    gaps count as the samples that they lack.

    Cause: stamps are given when a record is written, not when it is sampled, or are rounded. A rate
    made from stamp to stamp scatters, and the time of an event is less sure.
    """

    name = "clock_jitter"
    source = "design study, 41c; rounding to u scatters by u/√12"
    unit = "s"
    severity = 1

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        stamps = stamps_of(piece, log)
        if len(stamps) < MIN_STAMPS:
            return
        step = np.diff(stamps.time)
        off = (step - stamps.apart * log.interval)[stamps.apart > 0]
        if not len(off) or np.ptp(off) <= MAX_JITTER_SHARE * log.interval:
            return  # nothing scatters as much
        length = min(STRETCH_STAMPS, len(stamps))
        # A stamp that is behind the one before by chance is one interval on all the same.
        apart = np.where(
            (stamps.apart == 0) & (step > -MAX_BACKWARD_INTERVALS * log.interval), 1, stamps.apart
        )
        # By the stamps a late one may be two intervals; by the numbers of the records a gap is one.
        ones = np.minimum(apart, 1)
        square = np.fmin(*(_scatter(stamps.time, each, length) for each in (apart, ones)))
        scattered = square > (MAX_JITTER_SHARE * log.interval) ** 2
        often = min(MIN_STRETCHES, int(np.isfinite(square).sum()))
        for first, after in joined(np.flatnonzero(scattered), MAX_QUIET_STRETCHES):
            if np.count_nonzero(scattered[first:after]) < often:
                continue
            start = first * length
            end = len(stamps) if after == len(square) else after * length
            rms = float(np.sqrt(np.median(square[first:after][scattered[first:after]])))
            single = step[start : end - 1][apart[start : end - 1] == 1]
            facts, place = _facts(single, rms, log), stamps.place
            yield piece.event(int(place[start]), int(place[end - 1]) + 1, rms, facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        facts = event.facts
        rms = significant(event.size * 1e3, 2)
        if facts.unit:
            sentence = _(
                "{name}: the stamps are rounded to {significant} ms: {shorter:.4g} ms and "
                "{longer:.4g} ms take turns, where {mean:.5g} ms pass from sample to sample. So "
                "they are off an even clock by {rms} ms, {share} of an interval.",
                name=name,
                significant=significant(facts.unit * 1000.0, 1),
                shorter=facts.shorter * 1000.0,
                longer=facts.longer * 1000.0,
                mean=facts.mean * 1000.0,
                rms=rms,
                share=_percent(facts.share),
            )
        else:
            sentence = _(
                "{name}: the stamps scatter by {rms} ms about an even clock, {share} of an "
                "interval.",
                name=name,
                rms=rms,
                share=_percent(facts.share),
            )
        consequence = _(
            "A rate made from stamp to stamp would scatter by {percent}; the pipeline makes "
            "none. When something happens is known to {rms} ms.",
            percent=_percent(np.sqrt(2) * facts.share),
            rms=rms,
        )
        return Description(
            sentence,
            consequence,
            _(
                "One interval is taken for the whole log, so no parameter depends on the stamps. "
                "Let the logger stamp a sample when it is taken, in µs."
            ),
        )


def _scatter(time: Array, apart: Integers, length: int) -> Array:
    """Mean square of the stamps about straight lines over stretches of `length`, (k,), s².

    NaN where time goes back.
    """
    k = len(time) // length
    forward = np.append(apart > 0, True)[: k * length].reshape(k, length)[:, :-1].all(axis=1)
    number = np.append(0, np.cumsum(apart))[: k * length].reshape(k, length).astype(np.float64)
    stamp = time[: k * length].reshape(k, length)
    number = number - number.mean(axis=1, keepdims=True)
    stamp = stamp - stamp.mean(axis=1, keepdims=True)
    slope = (number * stamp).sum(axis=1) / (number**2).sum(axis=1)
    left = stamp - slope[:, None] * number
    return np.where(forward, (left**2).sum(axis=1) / (length - 2), np.nan)


def _facts(single: Array, rms: float, log: Log) -> _Facts:
    """Facts about stamps with these single intervals, (m,), s."""
    ticks, often = np.unique(np.rint(single / STAMP_DIGIT_S).astype(np.int64), return_counts=True)
    unit = unit_of(np.asarray(ticks * STAMP_DIGIT_S))
    # Rounding alone scatters by unit/√12, a little more or less in a short stretch.
    rounded = unit >= MIN_ROUNDING_S and rms < 1.5 * unit / np.sqrt(12)
    usual = np.sort(ticks[np.argsort(often)[-2:]]) * STAMP_DIGIT_S
    near = single[single > 0.5 * log.interval]  # as far below the usual as single ones go above
    mean = float(near.mean()) if len(near) else log.interval
    return _Facts(rms / mean, unit if rounded else 0.0, float(usual[0]), float(usual[-1]), mean)


def _percent(share: float) -> str:
    return f"{significant(share * 100, 2)} %"

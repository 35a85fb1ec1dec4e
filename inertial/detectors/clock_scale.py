"""Time tags that run fast or slow."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from inertial.arrays import Array, Integers
from inertial.signal.detector import Description, Detector, Event, Given, Log, Piece
from inertial.signal.scatter import in_blocks
from inertial.signal.stamps import (
    MAX_RATE_ERROR,
    STAMP_DIGIT_S,
    StampEvidence,
    Stamps,
    evidence_of_log,
    evidence_of_part,
    stamps_of,
    unit_of,
)
from inertial.signal.steps import changes
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant

# Crystals are cut and trimmed to some 20 to 50 ppm, cheap ones to 100 ppm (Ethernet, IEEE 802.3,
# allows as much); what differs from the stated rate by less is no fault.
MAX_CRYSTAL_ERROR = 1e-4
# Within a log, or from log to log, a crystal keeps to a few ppm: 10 K move it by less than that.
MIN_CHANGE = 5e-6
BLOCK_S = 0.5  # s, of which the mean interval is taken,
BLOCK_UNITS = 1000  # or so many units of the stamps, so that one of them is a part in a thousand
ROUNDING_SIGMA = np.sqrt(2 / 12)  # units: the error of the difference of two rounded stamps
MIN_BLOCKS = 3  # blocks of a stretch
MIN_INTERVALS = 16  # intervals
MIN_SIGMA = 5.0  # sigma of a mean interval
MAX_JUMP_SHARE = 1e-3  # share of intervals that may be jumps of the clock; more are its nature


@dataclass(frozen=True)
class _Part:
    """A stretch of intervals: steps [start, end) between records; mean and its sigma, relative."""

    start: int
    end: int
    mean: float
    sigma: float


@dataclass(frozen=True)
class _Facts:
    """What the description needs: intervals here, of the reference, and of which rates are made, s.

    against: with what it is compared; part: of a log; increments: of a receiver; evidence: of
    the specific force.
    """

    here: float
    usual: float
    used: float
    against: str
    part: bool
    increments: bool
    evidence: StampEvidence


class ClockScale(Detector):
    """A log, or a stretch of it, whose interval by the stamps is not that of the others.

    The intervals of a log are cut into parts whose means differ. A part is compared with what the
    logs of the campaign have in common; where they have nothing, with what most of the log has near
    the stated rate, and a whole log with the stated rate. Increments show whether the stamps are
    off or the sampling: at rest each is gravity times the true interval.

    Cause: the clock that gives the stamps runs fast or slow, or that which takes the samples. Rates
    by the stamps, and with them all scale factors, are off by as much.
    """

    name = "clock_scale"
    source = "design study, 41b"
    unit = "ppm"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        stamps = stamps_of(piece, log)
        steps, series = _intervals(stamps, log.interval)
        if len(series) < MIN_INTERVALS:
            return
        parts = _parts(series, log.interval)
        reference, tolerance, against = _reference(parts, piece, log)
        for part in parts:
            away = part.mean - reference
            if abs(away) <= max(tolerance, MIN_SIGMA * part.sigma) or _jump(
                series, part, reference
            ):
                continue
            first = 0 if part.start == 0 else int(steps[part.start]) + 1
            last = int(steps[part.end - 1]) + 1
            start, end = int(stamps.place[first]), int(stamps.place[last]) + 1
            whole = len(parts) == 1
            if whole and abs(away) > MAX_RATE_ERROR:
                continue  # a rate of its own
            yield piece.event(
                start,
                end,
                away / (1 + reference) * 1e6,
                sensor=_concerned(log) if whole or log.recorded_on is None else None,
                facts=_Facts(
                    here=log.interval * (1 + part.mean),
                    usual=log.interval * (1 + reference),
                    used=log.interval,
                    against=against if whole else _("elsewhere in this log"),
                    part=not whole,
                    increments=log.recorded_on is not None,
                    evidence=evidence_of_log(log, away)
                    if whole
                    else evidence_of_part(piece, log, start, end, away),
                ),
            )

    def detect_between_logs(self, logs: Mapping[str, Log]) -> Iterator[Event]:
        if not logs:
            return
        given = next(iter(logs.values())).given
        usual = given.usual_interval
        if not _agree(given) or not _off_the_stated(usual, given):
            return
        away = usual / given.interval - 1
        evidence = {
            evidence.stamps: evidence
            for log in logs.values()
            for evidence in [evidence_of_log(log, away)]
        }
        evidence.pop(None, None)
        facts = _Facts(
            here=usual,
            usual=given.interval,
            used=usual,
            against=_("by the stated rate"),
            part=False,
            increments=all(log.recorded_on is not None for log in logs.values()),
            evidence=next(iter(evidence.values())) if len(evidence) == 1 else StampEvidence(),
        )
        concerned = {_concerned(log) for log in logs.values()}
        sensor = concerned.pop() if len(concerned) == 1 else None
        yield Event(0, 0, 0, np.nan, np.nan, away * 1e6, sensor=sensor, facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        facts = event.facts
        intervals = _(
            "{here} from record to record, {usual} {against}",
            here=_ms(facts.here),
            usual=_ms(facts.usual),
            against=facts.against,
        )
        size = _ppm(abs(event.size) * 1e-6)
        if facts.evidence.stamps:
            off = _(
                "the stamps run {value} by {size}",
                value=_("fast") if event.size > 0 else _("slow"),
                size=size,
            )
        else:
            off = _(
                "the interval by the stamps is {size} {value}",
                size=size,
                value=_("longer") if event.size > 0 else _("shorter"),
            )
        if not name:
            sentence = _(
                "In most logs of the campaign {off}: {intervals}.", off=off, intervals=intervals
            )
        elif facts.part:
            seconds = _(
                "{from_s} s to {to_s} s", from_s=fixed(event.from_s, 3), to_s=fixed(event.to_s, 3)
            )
            sentence = _(
                "{name}: in {counted} from line {line}, {seconds}, {off}: {intervals}.",
                name=name,
                counted=counted(event.after - event.first, "record"),
                line=event.line,
                seconds=seconds,
                off=off,
                intervals=intervals,
            )
        else:
            sentence = f"{name}: {off}: {intervals}."
        return Description(
            f"{sentence} {_evidence_in_words(facts)}",
            _consequence(event, facts),
            _("Nothing is changed. Compare the clock of the logger with another, such as GPS time.")
            if facts.part
            else _(
                "Nothing is changed. Correct rate_hz of the instrument, or check the clocks of "
                "logger and IMU."
            ),
        )


def _concerned(log: Log) -> str:
    """The sensor whose readings the interval is in.

    Forces by increments, whose angles are sums without it; else angles, which are sums of rates.
    """
    return "gyro" if log.recorded_on is None else "accel"


def _intervals(stamps: Stamps, interval: float) -> tuple[Integers, Array]:
    """The intervals between neighbours, (m,): which they are, and how much longer than usual, 1.

    Single jumps of the clock are left out.
    """
    steps = np.flatnonzero(stamps.apart == 1)
    series = np.diff(stamps.time)[steps] / interval - 1
    if len(series) < MIN_INTERVALS or np.ptp(series) <= MIN_CHANGE:
        return steps, series
    beside = np.stack([np.roll(series, shift) for shift in (-2, -1, 1, 2)])
    least, most = beside.min(axis=0), beside.max(axis=0)
    room = 5 * (most - least) + MIN_CHANGE
    jumps = (series > most + room) | (series < least - room)
    if np.count_nonzero(jumps) <= max(MAX_JUMP_SHARE * len(series), 2):
        steps, series = steps[~jumps], series[~jumps]
    return steps, series


def _parts(series: Array, interval: float) -> list[_Part]:
    """The parts of a log that have each an interval of their own."""
    if np.ptp(series) <= MIN_CHANGE:
        length = max(MIN_INTERVALS, round(BLOCK_S / interval))
        return [_part(series, 0, len(series), length, interval)]
    unit = unit_of(interval * (1 + series))
    length = max(MIN_INTERVALS, round(max(BLOCK_S, BLOCK_UNITS * unit) / interval))
    borders = changes(
        series, length, MIN_BLOCKS, MIN_CHANGE, ROUNDING_SIGMA * unit / (length * interval)
    )
    return [_part(series, start, end, length, interval) for start, end in pairwise(borders)]


def _part(series: Array, start: int, end: int, length: int, interval: float) -> _Part:
    """A part of the intervals; its sigma from means of blocks, within which errors cancel."""
    own = series[start:end]
    blocks = in_blocks(own, length).mean(axis=1)
    few = len(blocks) < MIN_BLOCKS
    scatter = own.std() / np.sqrt(len(own)) if few else blocks.std() / np.sqrt(len(blocks))
    return _Part(
        start, end, float(own.mean()), max(float(scatter), STAMP_DIGIT_S / interval / len(own))
    )


def _reference(parts: Sequence[_Part], piece: Piece, log: Log) -> tuple[float, float, str]:
    """With what the parts are compared: interval and tolerance, relative to the log's; and what."""
    given = log.given
    if _agree(given):
        tolerance = max(MIN_CHANGE, 6 * given.unlike)
        return given.usual_interval / log.interval - 1, tolerance, _("in the other logs")
    if len(parts) == 1 and not np.isfinite(given.usual_interval):
        here = log.interval * (1 + parts[0].mean)
        if _off_the_stated(here, given):
            return given.interval / log.interval - 1, MAX_CRYSTAL_ERROR, _("by the stated rate")
    if log.records > len(piece):
        return 0.0, MIN_CHANGE, _("at the beginning of this log")
    stated = given.interval / log.interval
    near = [
        part for part in parts if abs((1 + part.mean) / stated - 1) < MAX_CRYSTAL_ERROR
    ] or parts

    def alike(candidate: _Part) -> int:
        own = [part for part in near if abs(part.mean - candidate.mean) <= MIN_CHANGE]
        return sum(part.end - part.start for part in own)

    return max(near, key=alike).mean, MIN_CHANGE, _("elsewhere in this log")


def _agree(given: Given) -> bool:
    """Whether the logs of the campaign have an interval in common, as crystals would."""
    return bool(6 * given.unlike < MAX_CRYSTAL_ERROR)


def _off_the_stated(interval: float, given: Given) -> bool:
    """Whether an interval is not the stated one; one that is far off is another rate altogether."""
    if not np.isfinite(given.interval):
        return False
    rate = f"{1 / given.interval:.10g}"
    digits = len(rate.partition(".")[2])
    # A rate of 83.3 Hz is stated to half a unit of its last digit.
    rounded = 0.5 * 10.0**-digits * given.interval if digits else 0.0
    away = abs(interval / given.interval - 1)
    return (
        max(MAX_CRYSTAL_ERROR, rounded) < away
        and abs(given.interval / interval - 1) <= MAX_RATE_ERROR
    )


def _jump(series: Array, part: _Part, reference: float) -> bool:
    """Whether two intervals make all the difference."""
    away = np.sort(np.sign(part.mean - reference) * (series[part.start : part.end] - reference))
    return bool(away[:-2].sum() < 0.5 * away.sum())


def _evidence_in_words(facts: _Facts) -> str:
    evidence = facts.evidence
    if evidence.stamps is None:
        return _("Readings alone do not show whether the stamps or the sampling is off.")
    change = f"{significant(evidence.change * 1e6, 2)} ± {significant(evidence.sigma * 1e6, 2)} ppm"
    off = _("the stamps are off, not the sampling")
    if not facts.part:
        off = off if evidence.stamps else _("the stamps are right")
        return _(
            "At rest the specific force is {change} off gravity, so {off}.", change=change, off=off
        )
    if evidence.stamps:
        return _(
            "The specific force per record does not change with it ({change}), so {off}.",
            change=change,
            off=off,
        )
    return _(
        "The specific force per record changes as much ({change}), so the sampling is "
        "off, not the stamps.",
        change=change,
    )


def _consequence(event: Event, facts: _Facts) -> str:
    used = _ms(facts.used)
    if facts.increments and abs(facts.usual / facts.used - 1) > MIN_CHANGE / 2:
        wrong = facts.usual / facts.used - 1
        return _(
            "Rates are made with {used}. Where the stamps are wrong, every rate that is "
            "made with it is off by {wrong}, and the scale factors of the accelerometers, "
            "as far as they rest on it. Angles, which are sums of increments, stand.",
            used=used,
            wrong=_ppm(wrong),
        )
    if facts.increments:
        after = abs(event.size) * 1e-6 * (event.to_s - event.from_s) * 1e3
        rates = _("Rates are made with {used}, the interval of the log, and stand", used=used)
        if facts.evidence.stamps is False:
            uneven = _ppm(facts.here / facts.used - 1)
            rates = _(
                "Rates are made with {used} throughout; in this stretch they are off by {uneven}",
                used=used,
                uneven=uneven,
            )
        return _(
            "{rates}. Angles, which are sums of increments, stand. After the stretch the "
            "stamps are {after} ms off.",
            rates=rates,
            after=significant(after, 2),
        )
    throughout = _ppm(facts.used / facts.usual - 1)
    if facts.part:
        return _(
            "The specific force stands. An angle is a sum of rates, over {used} each: where "
            "the stamps are right, it is off by {ppm} in this stretch; where they are "
            "wrong, by {throughout} throughout.",
            used=used,
            ppm=_ppm(facts.used / facts.here - 1),
            throughout=throughout,
        )
    return _(
        "Where the stamps are wrong, an angle that is a sum of rates over time is off "
        "by {throughout}, and a rate that is made of increments by as much the other "
        "way; the specific force of columns stands.",
        throughout=throughout,
    )


def _ppm(share: float) -> str:
    return f"{significant(share * 1e6, 3)} ppm"


def _ms(seconds: float) -> str:
    return f"{seconds * 1e3:.7g} ms"

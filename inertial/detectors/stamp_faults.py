"""Time stamps: of arrival, going back, standing still or jumping."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import date

import numpy as np

from inertial.arrays import Array
from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.runs import runs
from inertial.signal.stamps import MAX_RATE_ERROR, disorders, kinds, stamps_of, unit_of
from inertial.text.messages import _, plural
from inertial.text.numbers import counted, fixed, significant


class ArrivalStamps(Detector):
    """A log whose samples got the times of a regular clock, because their stamps are uneven.

    Cause: a host stamps samples when they arrive, one by one or many at once, or coarsely. A rate
    made from stamp to stamp is nonsense, and short gaps are not seen.
    """

    name = "arrival_stamps"
    source = "recordings of hobby IMUs by USB: four samples share a packet, stamps 2 ms apart"
    unit = "s"
    severity = 1

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        if np.isfinite(log.stamp_scatter):
            yield log.event(
                log.stamp_scatter, facts=(log.interval, log.interval_sigma, log.shortest_gap)
            )

    def describe(self, event: Event, name: str) -> Description:
        interval, sigma, gap = event.facts
        return Description(
            _(
                "{name}: the stamps are those of arrival, not of sampling: about a regular clock "
                "they scatter by {scatter} ms, {share} of a sample interval.",
                name=name,
                scatter=significant(event.size * 1e3, 2),
                share=f"{significant(event.size / interval * 100, 2)} %",
            ),
            _(
                "The samples have the times of a regular clock instead: one every {interval} ms, "
                "the slope of stamp against sample number, gaps left out. It is uncertain by {ppm} "
                "ppm, which the sigmas of the gyros' scale factors contain. Gaps of less than "
                "{gap} ms are not seen; a turn lacks what it turned meanwhile.",
                interval=significant(interval * 1e3, 5),
                ppm=significant(sigma / interval * 1e6, 2),
                gap=significant(gap * 1e3, 2),
            ),
            _("Let the IMU stamp or count its samples, and log that."),
        )


# s, after which counters of logs begin again: ms of 16 and 32 bits, µs and ns of 32 bits, the
# seconds of a minute, an hour, a day and a GPS week.
PERIODS = (2**16 * 1e-3, 2**32 * 1e-3, 2**32 * 1e-6, 2**32 * 1e-9, 60.0, 3600.0, 86400.0, 604800.0)
MAX_OFF_PERIOD = 0.5  # intervals, by which a step back and the interval after it may miss one


@dataclass(frozen=True)
class _Facts:
    """What is told of a step back.

    `before`: s, time before it; `ahead`: whether the stamps are ahead; `replayed`: the share that
    is a replay; `period`: s, of a counter that begins again; None where it is no such step.
    """

    before: float
    ahead: bool
    replayed: float
    period: float | None


def _period_of(step: float, interval: float) -> float | None:
    """The period, s, of the counter that steps back so far where it begins again."""
    off = {period: abs(step + interval - period) for period in PERIODS}
    nearest = min(off, key=off.__getitem__)
    return nearest if off[nearest] < MAX_OFF_PERIOD * interval else None


class TimeBackwards(Detector):
    """A stretch of records from where time goes back to where it has passed its former maximum.

    Where stamps jump ahead first and come back after fewer records than that, these are the
    stretch. `from_s` and `to_s` are both the stamp behind the step, for which time it was in
    between is unknown; the records give its duration.

    Cause: logs were joined, the clock was set, a counter began again, or a stamp was spoilt. When
    these records were taken is not known.
    """

    name = "time_backwards"
    source = "design study, 41c"
    unit = "s"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        # Nothing is left of a record that repeats an earlier one.
        replayed = np.asarray(np.isnan(piece.values).all(axis=1))
        for disorder in disorders(piece.time, piece.reached, log.interval):
            if replayed[disorder.start : disorder.end].all():
                continue  # `duplicate` says it
            step = disorder.end if disorder.ahead and disorder.end < len(piece) else disorder.start
            before = max(piece.reached, float(piece.time[:step].max(initial=-np.inf)))
            share = float(replayed[disorder.start : disorder.end].mean())
            period = None if disorder.ahead else _period_of(disorder.size, log.interval)
            facts = _Facts(before, disorder.ahead, share, period)
            event = piece.event(disorder.start, disorder.end, disorder.size, facts=facts)
            stamp = float(piece.time[step])
            # Where it begins in an earlier piece this is its continuation.
            yield event if step == 0 else replace(event, from_s=stamp, to_s=stamp)

    def describe(self, event: Event, name: str) -> Description:
        facts, records = event.facts, counted(event.after - event.first, "record")
        if facts.ahead:
            sentence = _(
                "{name}: the stamps of {records} from line {line} are {size:.6f} s ahead; then "
                "time goes back to {from_s} s.",
                name=name,
                records=records,
                line=event.line,
                size=event.size,
                from_s=fixed(event.from_s, 3),
            )
        else:
            sentence = _(
                "{name}: at line {line} time goes back by {size:.6f} s, from {before} s to "
                "{from_s} s; the stamps of {records} are then below those before.",
                name=name,
                line=event.line,
                size=event.size,
                before=fixed(facts.before, 3),
                from_s=fixed(event.from_s, 3),
                records=records,
            )
        look = _("Look for logs that were joined, a clock that was set, or records out of order.")
        if facts.period:
            sentence += " " + _(
                "So does a counter that begins again after {period} s.",
                period=f"{facts.period:.10g}",
            )
            look = _(
                "State wraps_at, the ticks after which the counter begins again, with the time in "
                "the format."
            )
        masked = (
            _("What repeats earlier ones is masked") if facts.replayed else _("Nothing is masked")
        )
        return Description(
            sentence,
            _(
                "Means and sums do not use the stamps and stand. When these records were taken "
                "is unknown by {size:.3g} s: so is what depends on it, a drift of a bias and "
                "the order of the manoeuvres.",
                size=event.size,
            ),
            _(
                "{masked}; a turn whose duration is in doubt for it is left out. {look}",
                masked=masked,
                look=look,
            ),
        )


class TimeStandsStill(Detector):
    """A record with the stamp of the one before, and other readings.

    Cause: the clock of the logger hung, or counts in steps longer than a sample. When the record
    was taken is not known, nor whether time passed with it.
    """

    name = "time_stands_still"
    source = "design study, 41c"
    unit = "records"
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        still = np.zeros(len(piece), bool)
        for places, _channels in kinds(piece):
            still[places[1:]] = np.diff(piece.time[places]) == 0
        for start, end in runs(still):
            yield piece.event(start, end, float(end - start), facts=log.interval)

    def describe(self, event: Event, name: str) -> Description:
        return Description(
            plural(
                "{name}: {count} record from line {line} has the stamp of the record before,"
                " {stamp} s, but other readings.",
                "{name}: {count} records from line {line} have the stamp of the record before,"
                " {stamp} s, but other readings.",
                int(event.size),
                name=name,
                line=event.line,
                stamp=fixed(event.from_s, 3),
            ),
            _(
                "Whether {time} s passed meanwhile is not known, so the angle of a turn is"
                " uncertain by the rate times this time; the mean of a rest is not affected.",
                time=f"{event.size * event.facts:.3g}",
            ),
            _("These records are masked. Check the clock of the logger."),
        )


MIN_STEP_SHARE = 0.02  # of an interval: smaller steps have no effect
MIN_STEP_UNITS = 0.9  # of the stamps behind it: smaller steps are their rounding
MIN_STEP_SIGMA = 10.0  # times what the stamps beside it scatter by, rms
SIDE_STAMPS = 32  # stamps on either side
MIN_SIDE_STAMPS = 8  # of them, where the log begins or ends
MIN_EVEN_STEPS = 4  # steps alike and evenly apart, which are the rounding of stamps
MIN_EVEN_SHARE = 0.85  # of the steps, and of the distances between them
MAX_UNEVEN = 0.1  # of their size, and of the records from one to the next
MAX_RETURN_SHARE = 0.5  # of the step, by which the stamps beside it may take it back


class ClockStep(Detector):
    """One interval between two records that is shorter or longer, and is not made good again.

    A stamp that is late by itself is made good by the next one; what is longer by a whole interval
    is a gap, and what goes back is time that goes back.

    Cause: the clock of the receiver or logger was set, or it began to follow another clock. Times
    are off by the step; angles and means are sums of samples and stay.
    """

    name = "clock_step"
    source = "design study, 5: a clock step is in no catalogue of effects, and must not be silent"
    unit = "s"
    severity = 1

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        events = list(self._steps(piece, log))
        if not _of_rounding(events):
            yield from events

    def _steps(self, piece: Piece, log: Log) -> Iterator[Event]:
        stamps = stamps_of(piece, log)
        off = np.diff(stamps.time) - stamps.apart * log.interval
        off[stamps.apart != 1] = np.nan
        for k in np.flatnonzero(np.abs(off) > MIN_STEP_SHARE * log.interval):
            before, behind = off[max(k - SIDE_STAMPS, 0) : k], off[k + 1 : k + 1 + SIDE_STAMPS]
            if min(np.isfinite(before).sum(), np.isfinite(behind).sum()) < MIN_SIDE_STAMPS:
                continue
            scatter = float(np.sqrt(np.nanmean(np.append(before, behind) ** 2)))
            taken_back = abs(float(np.nansum(before[-2:]) + np.nansum(behind[:2])))
            step = float(off[k])
            unit = unit_of(stamps.time[k + 1 :])
            if abs(step) < MIN_STEP_UNITS * unit:
                continue
            if abs(step) > MIN_STEP_SIGMA * scatter and taken_back < MAX_RETURN_SHARE * abs(step):
                place = int(stamps.place[k + 1])
                yield Event(
                    int(piece.record[place]),
                    int(piece.record[place]) + 1,
                    int(piece.line[place]),
                    float(stamps.time[k]),
                    float(stamps.time[k + 1]),
                    abs(step),
                    facts=step > 0,
                )

    def describe(self, event: Event, name: str) -> Description:
        later = "later" if event.facts else "earlier"
        size = significant(event.size * 1e3, 3)
        return Description(
            _(
                "{name}: from line {line} on, at {to_s} s, all stamps are {size} ms {later} "
                "than those of an even clock, and no sample is missing.",
                name=name,
                line=event.line,
                to_s=fixed(event.to_s, 3),
                size=size,
                later=later,
            ),
            _("What is taken against time is off by that much; angles and means hardly change."),
            _("All samples are used. Let the clock settle before recording."),
        )


def _of_rounding(events: Sequence[Event]) -> bool:
    """Whether steps are alike and evenly apart: no multiple of the stamps' unit is the interval."""
    if len(events) < MIN_EVEN_STEPS:
        return False
    sizes = np.array([event.size * (1 if event.facts else -1) for event in events])
    return all(map(_mostly_even, (sizes, np.diff([event.first for event in events]))))


def _mostly_even(values: Array) -> bool:
    """Whether all but a few are alike: the unit of stamps may change where they gain a digit."""
    usual = float(np.median(values))
    return float(np.mean(np.abs(values - usual) < MAX_UNEVEN * abs(usual))) > MIN_EVEN_SHARE


# ---- What a campaign states of time stamps and they contradict: their rate, their unit, their day.

FACTORS = (2, 4, 5, 10)  # of rates that instruments offer
TIME_UNITS = ("s", "ms", "µs", "ns")  # each a thousandth of the one before


def _units_apart(log: Log) -> int:
    """By how many of TIME_UNITS the stamps are smaller than stated, 0 where by none."""
    longer = log.interval / log.given.interval
    if not np.isfinite(longer) or longer <= 0:
        return 0
    thousands = round(np.log10(longer) / 3)
    off = abs(longer / 1000.0**thousands - 1) > MAX_RATE_ERROR
    return 0 if off or abs(thousands) >= len(TIME_UNITS) else thousands


class WrongTimeUnit(Detector):
    """The mean interval of a log is a thousand times the stated one, or a thousandth, or so on.

    Cause: the column of the time is in milliseconds, say, and the format states seconds. Rates are
    read as they are, and every angle, which is a rate times a time, is off by that factor.
    """

    name = "wrong_time_unit"
    source = "milliseconds that were read as seconds: 359922° in a turn of 360°"
    unit = "1"
    severity = 3

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        if thousands := _units_apart(log):
            facts = (thousands, log.interval, log.given.interval, log.given.instrument)
            yield log.event(1000.0**thousands, facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        thousands, step, interval, instrument = event.facts
        coarse, fine = TIME_UNITS[0], TIME_UNITS[abs(thousands)]
        stated, likely = (coarse, fine) if thousands > 0 else (fine, coarse)
        return Description(
            _(
                "{name}: by the stamps a sample is taken every {step} s, by the stated rate every "
                "{interval} s: as if the time were in {likely} where {stated} is stated.",
                name=name,
                step=significant(step),
                interval=significant(interval),
                likely=likely,
                stated=stated,
            ),
            _("Angles of turns, durations and drifts are off by this factor."),
            _(
                "Nothing is changed. Correct the unit of the time in the format, or rate_hz of "
                "{instrument}.",
                instrument=instrument,
            ),
        )


class RateOff(Detector):
    """The mean interval of a log, gaps left out, is not one over the stated rate.

    Cause: the rate was set otherwise, records are left out, or another instrument is named. Where
    stamps are recorded nothing is wrong; where they are counted, rates are off by this factor.
    """

    name = "rate_off"
    source = "design study, 41e: 200 against 100 Hz"
    unit = "1"
    severity = 1

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        factor = log.given.interval / log.interval
        if np.isfinite(factor) and abs(factor - 1) > MAX_RATE_ERROR and not _units_apart(log):
            facts = (1 / log.interval, 1 / log.given.interval, log.given.instrument)
            yield log.event(factor, facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        rate, stated, instrument = event.facts
        return Description(
            _(
                "{name}: {rate} samples per second by the stamps, but {stated} are stated: {size}.",
                name=name,
                rate=significant(rate),
                stated=significant(stated),
                size=_factor(event.size),
            ),
            _(
                "None where the stamps are right: sums over time, and rates of increments, are "
                "made with the log's own interval. Where they are wrong, both are off by this "
                "factor."
            ),
            _(
                "Nothing is changed. Correct rate_hz of {instrument}, or check whether it is "
                "the instrument that recorded this, and whether samples are left out.",
                instrument=instrument,
            ),
        )


def _factor(factor: float) -> str:
    """The factor in words, with its round number if it has one."""
    for whole in FACTORS:
        if abs(factor / whole - 1) < MAX_RATE_ERROR:
            return f"×{whole}"
        if abs(factor * whole - 1) < MAX_RATE_ERROR:
            return _("÷{whole}, as if only one record in {whole} were written", whole=whole)
    return _("factor {factor}", factor=significant(factor))


MAX_ZONE_DAYS = 1  # day: between UTC and the laboratory's own time
ROLLOVER_DAYS = 1024 * 7  # days after which a receiver counts the GPS weeks from 0 again


class WrongDay(Detector):
    """The UTC date of the first stamp is not the stated date, by more than a time zone makes.

    Cause: the log belongs to another session, or the date was written down wrong. If the log does,
    all results are those of another campaign.
    """

    name = "wrong_day"
    source = "S0: GPS week 2283 is 8 October 2023, where 18 October is stated; design study, 41h"
    unit = "days"

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        recorded, stated = _day(log.recorded_on), _day(log.given.date)
        if recorded is None or stated is None:
            return
        apart = (stated - recorded).days
        if abs(apart) > MAX_ZONE_DAYS:
            yield log.event(float(abs(apart)), facts=(recorded, stated))

    def describe(self, event: Event, name: str) -> Description:
        recorded, stated = event.facts
        days = counted(int(event.size), "day")
        when = "before" if recorded < stated else "after"
        why = ""
        if abs(event.size - ROLLOVER_DAYS) <= MAX_ZONE_DAYS:
            why = _(" That is 1024 weeks, after which receivers count from 0 again.")
        elif event.size == 10:
            why = _(" One wrong digit would make that.")
        return Description(
            _(
                "{name}: its stamps give {isoformat} (UTC), {days} {when} the stated "
                "{isoformat_2}.{why}",
                name=name,
                isoformat=recorded.isoformat(),
                days=days,
                when=when,
                isoformat_2=stated.isoformat(),
                why=why,
            ),
            _(
                "If the log is of another session, its biases are those of another switch-on; "
                "if the date was written down wrong, nothing changes but the order of the "
                "history."
            ),
            _("The log is used. Correct the date of the campaign, or put the right log there."),
        )


def _day(text: str | None) -> date | None:
    """An ISO date; none where it is unknown."""
    try:
        return date.fromisoformat(text or "")
    except ValueError:
        return None

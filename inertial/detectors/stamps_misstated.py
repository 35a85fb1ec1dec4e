"""What a campaign states of time stamps and they contradict: their rate, their unit, their day."""

from collections.abc import Iterator
from datetime import date

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log
from inertial.signal.stamps import MAX_RATE_ERROR
from inertial.text.messages import _
from inertial.text.numbers import counted, significant

FACTORS = (2, 4, 5, 10)  # of rates that instruments offer
TIME_UNITS = ("s", "ms", "µs", "ns")  # each a thousandth of the one before


def _units_apart(log: Log) -> int:
    """By how many of TIME_UNITS the stamps are smaller than stated, 0 where by none."""
    longer = log.step / log.given.interval
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
            facts = (thousands, log.step, log.given.interval, log.given.instrument)
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
        factor = log.given.interval / log.step
        if np.isfinite(factor) and abs(factor - 1) > MAX_RATE_ERROR and not _units_apart(log):
            facts = (1 / log.step, 1 / log.given.interval, log.given.instrument)
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

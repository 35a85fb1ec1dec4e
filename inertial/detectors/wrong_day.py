"""A log that was recorded on another day than the campaign states."""

from collections.abc import Iterator
from datetime import date

from inertial.signal.detector import Description, Detector, Event, Log
from inertial.text.messages import _
from inertial.text.numbers import counted

MAX_ZONE_DAYS = 1  # day: between UTC and the laboratory's own time
ROLLOVER_DAYS = 1024 * 7  # days after which a receiver counts the GPS weeks from 0 again


class WrongDay(Detector):
    """The UTC date of the first stamp is not the stated date, by more than a time zone makes."""

    name = "wrong_day"
    cause = _("the log belongs to another session, or the date was written down wrong")
    source = "S0: GPS week 2283 is 8 October 2023, where 18 October is stated; design study, 41h"
    costs = _("all results are those of another campaign, if the log is")
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

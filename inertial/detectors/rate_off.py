"""Another sample rate than the stated one."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log
from inertial.signal.stamps import MAX_RATE_ERROR
from inertial.text.messages import _
from inertial.text.numbers import significant

FACTORS = (2, 4, 5, 10)  # of rates that instruments offer


class RateOff(Detector):
    """The mean interval of a log, gaps left out, is not one over the stated rate."""

    name = "rate_off"
    cause = _("the rate was set otherwise, records are left out, or another instrument is named")
    source = "design study, 41e: 200 against 100 Hz"
    costs = _("nothing where stamps are recorded; where they are counted, rates by this factor")
    unit = "1"
    severity = 1

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        factor = log.given.interval / log.step
        if np.isfinite(factor) and abs(factor - 1) > MAX_RATE_ERROR:
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
    return f"factor {significant(factor)}"

"""Stamps of the arrival of samples, late by what they waited, or in bursts."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log
from inertial.text.messages import _
from inertial.text.numbers import significant


class ArrivalStamps(Detector):
    """A log whose samples got the times of a regular clock, because their stamps are uneven."""

    name = "arrival_stamps"
    cause = _("a host stamps samples when they arrive, one by one or many at once, or coarsely")
    source = "recordings of hobby IMUs by USB: four samples share a packet, stamps 2 ms apart"
    costs = _("a rate made from stamp to stamp is nonsense; short gaps are not seen")
    unit = "s"
    severity = 1

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        if np.isfinite(log.stamp_scatter):
            yield log.event(log.stamp_scatter, facts=(log.interval, log.shortest_gap))

    def describe(self, event: Event, name: str) -> Description:
        interval, gap = event.facts
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
                "the slope of stamp against sample number, gaps left out. Gaps of less than "
                "{gap} ms are not seen; a turn lacks what it turned meanwhile.",
                interval=significant(interval * 1e3, 5),
                gap=significant(gap * 1e3, 2),
            ),
            _("Let the IMU stamp or count its samples, and log that."),
        )

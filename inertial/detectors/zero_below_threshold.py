"""A channel that reads zero in place of all that is small."""

from collections.abc import Iterator, Sequence

import numpy as np

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
from inertial.signal.runs import joined
from inertial.text.messages import _
from inertial.text.numbers import counted, significant

# Times the threshold: noise lifts a reading over it or lets it fall below, and what is left of
# readings beside it has a mean of its own
MAX_BESIDE = 2.0
MAX_BREAK = 8  # readings at the most between two stretches that are one


class ZeroBelowThreshold(Detector):
    """A channel that reads exactly 0 in place of every reading smaller than a threshold.

    Its readings show it: zeros, and none between them and the threshold, of which `Log.threshold`
    tells. A rest is lost, and so is the mean of whatever is beside the threshold, for noise that
    falls below is cut off; a faster turn is not.

    Cause: a firmware that takes what is small for no motion (dead zone, zero-rate band), so that an
    angle that it sums up does not drift.
    """

    name = "zero_below_threshold"
    source = "IEEE Std 528-2019, 'threshold'; firmware of game controllers and drones"
    unit = "samples"
    severity = 3
    masks = True
    alike = "sensor"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        for i in np.flatnonzero(np.isfinite(log.threshold)).tolist():
            places, values = piece.channel(i)
            small = np.abs(values) < MAX_BESIDE * log.threshold[i]
            for start, end in joined(np.flatnonzero(small), MAX_BREAK):
                zeros = np.count_nonzero(values[start:end] == 0)
                yield piece.event(
                    int(places[start]),
                    int(places[end - 1]) + 1,
                    float(zeros),
                    channel=i,
                    facts=float(log.threshold[i]),
                )

    def censors(self, event: Event) -> bool:
        return True

    def describe(self, event: Event, name: str) -> Description:
        return self.describe_many([(name, event)])

    def describe_many(self, events: Sequence[tuple[str, Event]]) -> Description:
        channel = events[0][1].channel
        assert channel is not None
        scale, unit = read_in(channel)
        threshold = max(event.facts for _name, event in events)
        return Description(
            _(
                "In place of all readings of less than {threshold} {unit}, of either sign, {axes} "
                "read exactly 0: {counted} in {logs}.",
                threshold=significant(scale * threshold, 3),
                unit=unit,
                axes=names_of_axes(events),
                counted=counted(round(sum(event.size for _name, event in events)), "reading"),
                logs=names_of_logs(events),
            ),
            _(
                "What is read at rest is lost, with the bias that it would show, and so is the "
                "mean of readings beside the threshold, for noise that falls below it is cut off."
            ),
            _(
                "Readings of less than twice that, {twice} {unit}, are masked, and no mean is used "
                "in which there are any. Switch off the threshold (dead zone, zero-rate band) of "
                "the firmware, and record again.",
                twice=significant(MAX_BESIDE * scale * threshold, 3),
                unit=unit,
            ),
        )

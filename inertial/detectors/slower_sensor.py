"""A sensor that measures less often than its log has records."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inertial.sensors import COLUMNS, PLURAL
from inertial.signal.detector import Description, Detector, Event, Log
from inertial.signal.runs import records_of_a_reading
from inertial.text.enumeration import listed
from inertial.text.messages import _
from inertial.text.numbers import significant

SAME_SHARE = 0.02  # of records held, of two sensors with one cause


@dataclass(frozen=True)
class _Slower:
    """Which sensors, accel and gyro, or one of them; s, of a record."""

    sensors: tuple[str, ...]
    step: float


class SlowerSensor(Detector):
    """A sensor that gives fewer readings than its log has records, so that each is there again.

    Throughout the log, in a tenth of the records or more, and with counts so fine that its axes
    hardly ever repeat a reading one by one: see `ChannelStatistics`.

    Cause: the logger asks more often than the sensor measures. A reading that is held until the
    next one counts for the time between them, so means and sums over time are right.
    """

    name = "slower_sensor"
    source = "sample-and-hold: the mean of a held signal is that of its readings"
    unit = "records"
    severity = 1
    alike = "sensor"

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        slower = [name for name, share in zip(COLUMNS, log.held, strict=True) if share]
        together = len(slower) == 2 and abs(np.diff(log.held)[0]) < SAME_SHARE
        for sensors in [slower] if together else [[name] for name in slower]:
            share = float(log.held[list(COLUMNS).index(sensors[0])])
            yield log.event(
                records_of_a_reading(share),
                sensor=None if together else sensors[0],
                facts=_Slower(tuple(sensors), log.step),
            )

    def describe(self, event: Event, name: str) -> Description:
        known = np.isfinite(event.facts.step)
        rate = 1 / event.facts.step if known else np.nan
        at = _(
            ": {readings} readings a second in {records} records",
            readings=significant(rate / event.size, 3),
            records=significant(rate, 3),
        )
        return Description(
            _(
                "{name}: each reading of the {sensors} is there {times} times{at}.",
                name=name,
                sensors=listed([PLURAL[sensor] for sensor in event.facts.sensors]),
                times=significant(event.size, 3),
                at=at if known else "",
            ),
            _(
                "Means and sums over time stay right, for a reading counts for the time until the "
                "next; records are not independent of each other, which the noise contains."
            ),
            _(
                "Nothing is changed. Log at the rate of the sensor, or when it has new data, to "
                "save the space."
            ),
        )

"""Readings from which the mean of the log, or of its beginning, was subtracted."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtr

from inertial.arrays import Array
from inertial.sensors import COLUMNS
from inertial.signal.detector import Description, Detector, Event, Log
from inertial.text.messages import _
from inertial.text.numbers import counted, p_is, significant

MAX_CHANCE = 1e-9  # of means so close to zero, of all durations and both sensors
MAX_BEGINNING = 60  # windows of 1 s


@dataclass(frozen=True)
class _Facts:
    """Of how many logs, and over how many s of the beginning; None for the whole log."""

    logs: int
    seconds: int | None


class BiasRemoved(Detector):
    """Means closer to zero than the noise of the readings lets any mean be.

    The mean of n readings scatters by σ/√n about the bias, and so is hardly ever zero to much less
    than that. Over the axes of all logs the squares of means in units of σ/√n are chi-squared; so
    small a sum is no chance, whatever the bias is. Other lengths of the beginning that overlap with
    the true one still are smaller than they should.

    Cause: a sketch or a firmware takes the first seconds of each log as zero, or a script subtracts
    the mean. What is left is the error of that mean, another one in each log, and of the earth's
    rate what the other attitudes differ by.
    """

    name = "bias_removed"
    source = "chi-squared, lower tail: the mean of noise is as large as the noise of a mean"
    unit = "1"
    severity = 3
    alike = "sensor"

    def detect_between_logs(self, logs: Mapping[str, Log]) -> Iterator[Event]:
        timed = [log for log in logs.values() if np.isfinite(log.step) and len(log.windows.time)]
        for sensor, axes in COLUMNS.items():
            own = [log for log in timed if np.isfinite(log.windows.mean[:, axes]).all()]
            if not own:
                continue
            shortest = min(len(log.windows.time) for log in own)
            lengths: list[int | None] = [None, *range(1, min(shortest, MAX_BEGINNING) + 1)]
            chances = [_chance(own, axes, length) for length in lengths]
            best = int(np.argmin(chances))
            chance = len(lengths) * len(COLUMNS) * chances[best]
            if chance < MAX_CHANCE:
                facts = _Facts(len(own), lengths[best])
                size = float(len(own))
                yield Event(
                    *(0, 0, 0, np.nan, np.nan, size),
                    p_value=chance,
                    severity=1 if facts.seconds else 3,
                    sensor=sensor,
                    facts=facts,
                )

    def describe(self, event: Event, name: str) -> Description:
        facts = event.facts
        sensors = _("accelerometers") if event.sensor == "accel" else _("gyros")
        where = (
            _("over the whole of {logs}", logs=counted(facts.logs, "log"))
            if facts.seconds is None
            else _(
                "over about the first {seconds} s of {logs}",
                seconds=significant(facts.seconds, 2),
                logs=counted(facts.logs, "log"),
            )
        )
        return Description(
            _(
                "The means of the {sensors} {where} are closer to zero than their noise lets them "
                "be ({p_value}): they were subtracted from the readings.",
                sensors=sensors,
                where=where,
                p_value=p_is(event.p_value),
            ),
            _(
                "The bias is not in the log, but what these means are off by, which differs from "
                "log to log; a motion within them, and the earth's rate, are subtracted too."
            ),
            _(
                "Record without it: switch off the zeroing of the firmware, or use the readings "
                "before the script. Where the biases of the logs differ by it, the result says so "
                "and its sigmas contain it."
            ),
        )


def _chance(logs: Sequence[Log], axes: slice, length: int | None) -> float:
    """The chance that the means over the first windows of all logs, or over all, are so small."""
    squares: list[Array] = []
    for log in logs:
        mean = log.windows.mean[:length, axes]
        of_mean = log.windows.variance[:length, axes].mean(axis=0) * log.step / len(mean)
        if (of_mean > 0).all():
            squares.append(mean.mean(axis=0) ** 2 / of_mean)
    if not squares:
        return 1.0
    return float(chdtr(np.size(squares), np.sum(squares)))

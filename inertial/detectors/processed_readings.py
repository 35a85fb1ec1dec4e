"""Readings that are not as they were measured: without their mean, of one magnitude, or copied."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.special import chdtr

from inertial.arrays import Array
from inertial.sensors import COLUMNS
from inertial.signal.detector import Description, Detector, Event, Log, Piece, channel_name
from inertial.signal.scale_factor import quiet_force
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.text.messages import _
from inertial.text.numbers import counted, p_is, significant, whole

# ---- Readings from which the mean of the log, or of its beginning, was subtracted.

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
        timed = [
            log for log in logs.values() if np.isfinite(log.interval) and len(log.windows.time)
        ]
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
        of_mean = log.windows.variance[:length, axes].mean(axis=0) * log.interval / len(mean)
        if (of_mean > 0).all():
            squares.append(mean.mean(axis=0) ** 2 / of_mean)
    if not squares:
        return 1.0
    return float(chdtr(np.size(squares), np.sum(squares)))


# ---- Accelerometers whose readings have all the same magnitude.

MIN_WINDOWS = 20  # at rest
MIN_TURNED = np.deg2rad(45.0)  # between two attitudes: in one alone an axis may stand still
MAX_SCATTER = 0.03  # of the magnitude, in that of the components


class NormalisedForce(Detector):
    """The magnitude of the specific force does not scatter, while its components do.

    By the means of rests in several attitudes. A sensor has as much noise along gravity as across
    it, and bias and scale factors make the magnitude another in each attitude.

    Cause: the “gravity” of a phone or of an attitude filter is logged, which is a direction times a
    constant. It tells nothing of bias and scale factors.
    """

    name = "normalised_force"
    source = "Android, TYPE_GRAVITY: the direction of gravity, of the magnitude 9.80665 m/s²"
    unit = "m/s²"
    sensor = "accel"
    severity = 3

    def detect_between_logs(self, logs: Mapping[str, Log]) -> Iterator[Event]:
        read = [log for log in logs.values() if len(quiet_force(log)) and not log.increments]
        own = [quiet_force(log) for log in read]
        if sum(map(len, own)) < MIN_WINDOWS:
            return
        force = np.concatenate(own)
        magnitude = np.linalg.norm(force, axis=1)
        usual = float(np.median(magnitude))
        scatter = MAD_TO_SIGMA * float(np.median(np.abs(magnitude - usual)))
        changes = np.concatenate([np.diff(each, axis=0) for each in own]) / np.sqrt(2)
        of_means = MAD_TO_SIGMA * float(np.median(np.median(np.abs(changes), axis=0)))
        samples = np.median([log.records / len(log.windows.mean) for log in read])
        of_noise = np.median([log.noise[:3] for log in read]) / np.sqrt(samples)
        along = force @ force[0] / (magnitude * magnitude[0])
        turned = along.min() < np.cos(MIN_TURNED)
        if turned and scatter < MAX_SCATTER * min(of_means, of_noise):
            yield Event(0, 0, 0, np.nan, np.nan, usual, sensor=self.sensor)

    def describe(self, event: Event, name: str) -> Description:
        return Description(
            _(
                "The readings of the accelerometers have the magnitude {force} m/s² in all "
                "attitudes, without noise: they are a direction that was multiplied by a constant.",
                force=significant(event.size, 6),
            ),
            _("Bias and scale factors of the accelerometers are not in the logs."),
            _(
                "The directions are used. Log the specific force, which phones call acceleration, "
                "not gravity, and record again."
            ),
        )


# ---- Two axes of a sensor that read the same.

MIN_RECORDS = 1000
FIRST = 64  # records, by which most pairs are told apart at once
MIN_CHANGES = 100  # readings that differ from the one before


class CopiedChannel(Detector):
    """An axis that reads what another one reads, or the reverse, record by record.

    Noise of two axes is not the same a hundred times in a row; which of the two is the copy no
    reading tells, so neither is used.

    Cause: a column is written twice, or two axes are read from one register.
    """

    name = "copied_channel"
    source = "independent noise of the axes of a triad"
    unit = "records"
    severity = 3
    masks = True
    alike = "sensor"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        for axes in COLUMNS.values():
            for pair in combinations(range(axes.start, axes.stop), 2):
                first = np.abs(piece.values[:FIRST, pair])
                if not np.array_equal(first[:, 0], first[:, 1], equal_nan=True):
                    continue
                values = piece.values[:, pair]
                values = values[np.isfinite(values).all(axis=1)]
                if len(values) < MIN_RECORDS:
                    continue
                one, other = values.T
                reversed_ = bool((one == -other).all())
                if not reversed_ and not (one == other).all():
                    continue
                if np.count_nonzero(np.diff(one)) >= MIN_CHANGES:
                    for channel, copied in (pair, pair[::-1]):
                        facts = copied, reversed_
                        size = float(len(values))
                        yield piece.event(0, len(piece), size, channel=channel, facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        assert event.channel is not None
        copied, reversed_ = event.facts
        what = (
            _("the reverse of {other}", other=channel_name(copied))
            if reversed_
            else _("the same as {other}", other=channel_name(copied))
        )
        return Description(
            _(
                "{name}: {channel} reads {what}, in all of {records} records.",
                name=name,
                channel=channel_name(event.channel),
                what=what,
                records=whole(event.after - event.first),
            ),
            _("One of the two axes is not in the log: all that depends on it would be wrong."),
            _(
                "Both are masked, for which of them is the copy no reading tells. Look at the "
                "columns of the format, and at the registers that the logger reads; record again."
            ),
        )


# ---- A log that holds the readings of another.

MIN_COPIED_WINDOWS = 5  # s: noise is not the same so often


class CopiedLog(Detector):
    """Two logs whose means over each second are equal to the last digit, in all channels.

    Cause: one file was copied, or exported, under two names. The manoeuvres of one of them were not
    recorded; where the plan has the same in both, the readings count twice.
    """

    name = "copied_log"
    source = "independent noise of two recordings"
    unit = "records"
    severity = 2

    def detect_between_logs(self, logs: Mapping[str, Log]) -> Iterator[Event]:
        copies: dict[str, str] = {}
        for (first, one), (second, other) in combinations(logs.items(), 2):
            if second not in copies and _alike(one, other):
                copies[second] = first
                size = float(min(one.records, other.records))
                yield other.event(size, log=second, facts=first)

    def describe(self, event: Event, name: str) -> Description:
        return Description(
            _(
                "{name} holds the readings of {other}: {count} records are the same.",
                name=name,
                other=event.facts,
                count=whole(event.size),
            ),
            _(
                "One of the two was not recorded. A manoeuvre that is not as planned is left out; "
                "what fits the plan in both counts twice, and its sigmas are too small."
            ),
            _("Nothing is changed. Find the right file, or take one of the two out of the plan."),
        )


def _alike(one: Log, other: Log) -> bool:
    """Whether all that both have recorded is the same; not of readings that never change."""
    length = min(len(one.windows.mean), len(other.windows.mean)) - 1  # the last may be cut off
    return (
        length >= MIN_COPIED_WINDOWS
        and np.array_equal(one.windows.mean[0], other.windows.mean[0], equal_nan=True)
        and np.array_equal(one.windows.mean[:length], other.windows.mean[:length], equal_nan=True)
        and bool(np.nansum(one.windows.variance[:length]) > 0)
    )

"""Accelerometers and gyros in a log each, joined on one clock.

Stamps that are the same in both logs join their readings; nothing is computed. At the same rate a
sample gets the reading that is always as late or as early. At different rates a sample of the
slower sensor keeps its stamp and its reading, and of the faster one it gets the mean over its
sample interval: the integral of the readings, each of which holds from half an interval before its
stamp to half an interval after, over the same of the slower one. A sum over samples is then that of
the readings themselves, so an angle stays what it is; and every reading enters with its own weight,
so the noise of a mean over many samples is that of the readings, where interpolation would lose
some. Only neighbours share readings: single samples scatter less than white noise of that level
would.

Intervals are those of a regular clock: stamps, which may scatter, are a straight line against the
sample number in each stretch without a gap; those of arrival were replaced before. Samples of the
slower sensor without readings of the other one are left out, as if they had not been recorded: a
gap.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from inertial.arrays import Array, Integers
from inertial.formats.account import DECODED, NOT_SELECTED, Account, RefusedLine
from inertial.formats.columns.column_layout import has_stamps
from inertial.sensors import FILE_KEYS
from inertial.tables import AXES
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from stages.decode.column_log import ColumnLog
from stages.decode.decoded import Decoded
from stages.decode.no_samples import no_samples

MAX_READINGS = 10_000_000  # of a log, held in memory: 480 MB
SLOWER = 1.01  # times the interval of the accelerometers: the gyros are the slower sensor
GAP_INTERVALS = 1.5  # median intervals between stamps of a regular clock that are a gap
SAME_INTERVALS = 1e-3  # intervals: stamps that are closer together are the same
MIN_COVERAGE = 0.5  # of a sample interval that the other sensor's readings cover


@dataclass(frozen=True)
class _Readings:
    """All n readings of one sensor: time by the common clock, s; values, (n, 3), SI.

    line, offset : (n,), of their lines in the file
    """

    time: Array
    values: Array
    line: Integers
    offset: Integers
    refused: list[RefusedLine]
    account: Account

    @classmethod
    def of(cls, log: ColumnLog, sensor: str, offset: float) -> "_Readings":
        none = np.zeros(0, np.int64)
        times, values = [np.zeros(0)], [np.zeros((0, 3))]
        lines, offsets = [none], [none]
        refused, account, count = list[RefusedLine](), Account(), 0
        for piece in log.decoded(0):
            times.append(piece.samples["time"])
            values.append(np.column_stack([piece.samples[f"{sensor}_{axis}"] for axis in AXES]))
            lines.append(piece.samples["line"])
            offsets.append(piece.samples["offset"])
            refused += piece.refused
            account.add_account(piece.account)
            count += len(times[-1])
            if count > MAX_READINGS:
                raise Refusal(
                    log.path.name,
                    "",
                    _("more than {most} readings", most=MAX_READINGS),
                    _("fewer, for logs of accelerometers and gyros that are joined"),
                    _("write both sensors into one log, or cut the logs into several"),
                )
        time = np.concatenate(times) + log.began(0, absolute=True) + offset
        places = np.concatenate(lines), np.concatenate(offsets)
        return cls(time, np.concatenate(values), *places, refused, account)


def of_both_sensors(layout: Mapping[str, Any], file: str) -> dict[str, Any] | None:
    """The layout of a log whose rows hold either sensor, as of a log of each; None of others."""
    if not (
        has_stamps(layout.get("time"))
        and all("rows" in layout.get(key, {}) for key in FILE_KEYS.values())
    ):
        return None
    own = {key: value for key, value in layout.items() if key != "gyro"}
    gyro = {key: value for key, value in layout.items() if key not in ("accelerometer", "label")}
    return own | {"gyro_log": {"file": file, "layout": gyro, "offset": 0.0}}


class JoinedLog:
    """The log of the accelerometers with that of the gyros; named after the former.

    Records count the samples of the slower sensor; lines and offsets are those of the
    accelerometers' log, in which the nearest reading stands. Both may be one file, whose rows hold
    either sensor.

    Raises
    ------
    Refusal
        where the log of the gyros gives no sample, or the two have no time in common
    """

    clock = "own"

    def __init__(self, name: str, path: Path, layout: Mapping[str, Any], gyro_path: Path) -> None:
        stated = layout["gyro_log"]
        self.name, self.path, self.gyro_path = name, path, gyro_path
        logs = {
            "accel": ColumnLog(name, path, layout),
            "gyro": ColumnLog(gyro_path.name, gyro_path, stated["layout"]),
        }
        offsets = {"accel": 0.0, "gyro": float(stated["offset"])}
        both = {sensor: _Readings.of(log, sensor, offsets[sensor]) for sensor, log in logs.items()}
        self.gyros = both["gyro"]
        if not len(self.gyros.time):
            first = next(iter(self.gyros.refused), None)
            raise no_samples(gyro_path.name, stated["layout"], self.gyros.account, first)
        slower, faster = "accel", "gyro"
        intervals = {sensor: _usual_interval(readings.time) for sensor, readings in both.items()}
        if intervals["gyro"] > SLOWER * intervals["accel"]:
            slower, faster = "gyro", "accel"
        self._log, self._faster = logs[slower], faster
        self._refused, self._account = both["accel"].refused, both["accel"].account
        self._offset = offsets[slower]
        self._values = _joined(both[slower].time, both[faster])
        self._places = _nearest_lines(both[slower].time, both["accel"])
        self._kept = np.asarray(np.isfinite(self._values).any(axis=1))
        self._in_one_file = gyro_path == path
        if self._in_one_file:
            for kind, name, lines, size in self.gyros.account:
                if kind == DECODED:
                    self._account.add(DECODED, name, lines, size)
                    self._account.add(NOT_SELECTED, name, -lines, -size)
        if left := int(np.count_nonzero(~self._kept)):
            both[slower].account.add(DECODED, "", -left, 0)
            both[slower].account.add(NOT_SELECTED, "", left, 0)
        self.interval = self._log.interval
        self.arrival = self._log.arrival
        if len(self._kept) and not self._kept.any():
            raise Refusal(
                gyro_path.name,
                "gyro.log",
                _("time {span}", span=_span(both["gyro"].time)),
                _("that of {log}: {span}", log=path.name, span=_span(both["accel"].time)),
                _("correct the units of time, or add offset_s to gyro: what its time lacks"),
            )

    def decoded(self, origin: int) -> Iterator[Decoded]:
        """The joined log, piece by piece; `origin` is none of its business."""
        refused, account = self._refused, self._account
        first = 0
        for piece in self._log.decoded(origin):
            rows = slice(first, first + len(piece.samples["record"]))
            if self._in_one_file:  # rows of the other sensor are no records of this one
                piece.samples["record"] = np.arange(rows.start, rows.stop)
            values, kept, first = self._values[rows], self._kept[rows], rows.stop
            samples = {
                name: column if column is None else column[kept]
                for name, column in piece.samples.items()
            }
            samples |= {f"{self._faster}_{axis}": values[kept, i] for i, axis in enumerate(AXES)}
            samples |= {name: place[rows][kept] for name, place in self._places.items()}
            yield Decoded(samples, refused, account)
            refused, account = [], Account()

    def began(self, origin: int, *, absolute: bool) -> float:
        """What its samples' time 0 is by its own clock, which is the encoder's too, s."""
        return self._log.began(origin, absolute=absolute) + self._offset


def _joined(time: Array, others: _Readings) -> Array:
    """The other sensor's readings at the samples of one, (n, 3); NaN where there are none."""
    if np.array_equal(time, others.time):
        return others.values
    joined = np.full((len(time), 3), np.nan)
    samples, readings = _advancing(time), _advancing(others.time)
    if len(samples) < 2 or len(readings) < 2:
        return joined
    time, other_time, values = time[samples], others.time[readings], others.values[readings]
    interval, most = _usual_interval(time), max(len(time), len(other_time))
    of, away = _nearest(time, other_time)
    same = np.abs(away) < SAME_INTERVALS * interval
    if np.count_nonzero(same) > most / 2:
        joined[samples[same]] = values[of[same]]
    elif abs(_usual_interval(other_time) / interval - 1) * most < 1:
        other_time, time = _regular(other_time)[0], _regular(time)[0]
        away = _nearest(time, other_time)[1]
        beside = away[np.abs(away) < interval]
        phase = np.median(beside) if len(beside) else 0.0
        of, away = _nearest(time, other_time - phase)
        near = np.abs(away) < interval / 2
        joined[samples[near]] = values[of[near]]
    else:
        joined[samples] = _means(time, other_time, values)
    return joined


def _nearest_lines(time: Array, readings: _Readings) -> dict[str, Integers]:
    """The lines of the readings that are nearest to these times, and their offsets, (n,) each."""
    places = {"line": readings.line, "offset": readings.offset}
    if time is readings.time:
        return places
    ascending = _advancing(readings.time)
    of, _away = _nearest(time, readings.time[ascending])
    return {name: place[ascending[of]] for name, place in places.items()}


def _advancing(time: Array) -> Integers:
    """Where time advances beyond all that came before, (m,)."""
    former = np.maximum.accumulate(np.append(-np.inf, time[:-1])) if len(time) else time
    return np.flatnonzero(time > former)


def _nearest(time: Array, others: Array) -> tuple[Integers, Array]:
    """Which of the others, (m,), ascending, is nearest to each time, and how much later, (n,)."""
    of = np.searchsorted((others[1:] + others[:-1]) / 2, time)
    return of, others[of] - time


def _means(time: Array, other_time: Array, readings: Array) -> Array:
    """The means of readings, (m, 3), over the intervals of samples, (n, 3); NaN without readings.

    Sums up to the ends of the readings' intervals are linear between these.
    """
    middles, widths = _regular(other_time)
    ends = np.column_stack([middles - widths / 2, middles + widths / 2]).ravel()
    ends = np.maximum.accumulate(ends)
    there = np.isfinite(readings)
    weight = np.where(there, np.diff(ends)[::2, None], 0.0)
    middles, widths = _regular(time)
    from_s, to_s = middles - widths / 2, middles + widths / 2
    means = np.full((len(time), 3), np.nan)
    for axis in range(3):
        weighted = weight[:, axis] * np.where(there[:, axis], readings[:, axis], 0.0)
        covered, integral = (
            np.interp(to_s, ends, sums) - np.interp(from_s, ends, sums)
            for sums in (_sums(weight[:, axis]), _sums(weighted))
        )
        enough = covered > MIN_COVERAGE * widths
        means[enough, axis] = integral[enough] / covered[enough]
    return means


def _sums(parts: Array) -> Array:
    """The sum before and after each part, (2n,)."""
    after = np.cumsum(parts)
    return np.column_stack([after - parts, after]).ravel()


def _regular(time: Array) -> tuple[Array, Array]:
    """The times of the samples by a regular clock, and its intervals, (n,) each, s.

    `time` ascends. A stretch of one sample has the interval of the others.
    """
    step = np.diff(time)
    if not len(step):
        return time, np.zeros(len(time))
    longest = GAP_INTERVALS * float(np.median(step))
    edges = [0, *(np.flatnonzero(step > longest) + 1).tolist(), len(time)]
    regular, interval = time.copy(), np.full(len(time), np.nan)
    for first, after in pairwise(edges):
        if after - first > 1:
            number = np.arange(after - first) - (after - first - 1) / 2
            part = time[first:after]
            slope = number @ part / (number @ number)
            regular[first:after] = part.mean() + slope * number
            interval[first:after] = slope
    return regular, np.where(np.isnan(interval), np.nanmedian(interval), interval)


def _usual_interval(time: Array) -> float:
    """The interval of most samples, s; NaN where there are not two."""
    return float(np.median(_regular(time[_advancing(time)])[1])) if len(time) > 1 else np.nan


def _span(time: Array) -> str:
    return f"{time.min():.6g} … {time.max():.6g} s" if len(time) else "–"

"""Reader of a log of columns: one data row per sample, in text or in a container.

The content decides which, never the name of the file. Numbers have the units of the file.
`text_reader` and `container` say which rows are refused.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from inertial.arrays import Array, Integers
from inertial.formats.account import Account, RefusedLine
from inertial.formats.columns import text_reader
from inertial.formats.columns.column_layout import ISO_8601, ticks_per_second
from inertial.formats.columns.data_rows import Reading, Rows
from inertial.formats.columns.text_lines import CHUNK_BYTES
from inertial.formats.containers import container
from inertial.formats.file_type import FileType, file_type_of, refuse_no_log
from inertial.tables.errors import Refusal
from inertial.text.messages import _

__all__ = ["Reading", "Rows", "read"]

DAY = 86_400 * 10**9  # ns


def read(
    path: Path, layout: Mapping[str, Any], chunk_bytes: int = CHUNK_BYTES
) -> Iterator[Reading]:
    """The log at `path` in this layout, chunk by chunk; text about `chunk_bytes` at a time.

    Raises
    ------
    Refusal
        where the layout names a column that is missing, or is there twice; where the file is
        no log; where a container is damaged or needs too much memory
    """
    refuse_no_log(path)
    if (file_type := file_type_of(path)) is FileType.TEXT:
        readings = text_reader.read(path, layout, chunk_bytes)
    else:
        readings = container.read(path, layout, _opening(file_type))
    time = layout.get("time") or {}
    if (wraps_at := time.get("wraps_at")) is not None:
        readings = _unwrapped(readings, wraps_at)
    elif time.get("unit") == ISO_8601:
        readings = _over_midnight(readings)
    yield from readings


def _unwrapped(readings: Iterable[Reading], wraps_at: int) -> Iterator[Reading]:
    """The same with ticks that go on where a counter began again after `wraps_at` ticks."""
    last: Array = np.zeros(0)
    for reading in readings:
        if (ticks := reading.records.ticks) is not None and len(ticks):
            last = np.unwrap(np.append(last, ticks), period=wraps_at)[len(last) :]
            reading = replace(reading, records=replace(reading.records, ticks=last))
            last = last[-1:]
        yield reading


def _over_midnight(readings: Iterable[Reading]) -> Iterator[Reading]:
    """The same with times of the day, in ns and without a date, that go on over midnight.

    There they go back by nearly a day; what goes back by less than half of one does not go on.
    """
    last: Array | Integers = np.zeros(0, np.int64)
    days = 0  # so far
    for reading in readings:
        ticks = reading.records.ticks
        if ticks is not None and len(ticks):
            from_last = np.append(last if len(last) else ticks[:1], ticks)
            alone = ((from_last >= 0) & (from_last < DAY)).all()
            begun = (np.diff(from_last) < -DAY // 2) & alone
            since = days + np.cumsum(begun)
            last, days = ticks[-1:], int(since[-1])
            reading = replace(reading, records=replace(reading.records, ticks=ticks + DAY * since))
        yield reading


def names_in(path: Path) -> list[str] | None:
    """The names of the columns of a container; None of a text, whose header only a layout tells."""
    refuse_no_log(path)
    if (file_type := file_type_of(path)) is FileType.TEXT:
        return None
    return container.names_in(path, _opening(file_type))


def _opening(file_type: FileType) -> container.Opening:
    """The function that opens a container.

    Its library is imported only where a log needs it: importing all of them takes longer than
    reading most logs.
    """
    match file_type:
        case FileType.PARQUET:
            from inertial.formats.containers.arrow_tables import opened_parquet as opened
        case FileType.ARROW_FILE | FileType.ARROW_STREAM:
            from inertial.formats.containers.arrow_tables import opened_arrow as opened
        case FileType.HDF5:
            from inertial.formats.containers.hdf5_file import opened
        case FileType.MATLAB_5:
            from inertial.formats.containers.matlab5_file import opened
        case FileType.ROS_1:
            from inertial.formats.containers.ros1_bag import opened
        case FileType.ROS_2:
            from inertial.formats.containers.ros2_bag import opened
        case FileType.MCAP:
            from inertial.formats.containers.mcap_bag import opened
        case FileType.ULOG:
            from inertial.formats.containers.ulog_file import opened
        case FileType.NUMPY | FileType.NUMPY_ARCHIVE:
            from inertial.formats.containers.numpy_file import opened
    return opened


# ---- The angle of the table from the log of its encoder, beside the IMU's log.
#
# Between two readings the angle is interpolated linearly. In gaps, before the first reading and
# after the last one there is no angle. Stamps of an even clock are rounded to their count, by which
# the angle of a turn would jump where its interval is no whole number of counts: there the clock is
# used.

MAX_READINGS = 20_000_000  # held in memory: 320 MB
MIN_COUNT = 1e-6  # intervals: less are those of floating-point numbers
MAX_OFF_COUNT = 0.05  # counts of its stamps, by which differences of rounded ones may be off
MAX_GAP_INTERVALS = 5.5  # median intervals between two readings that are interpolated


class Encoder:
    """Its readings: time, s, ascending, and angle, in the unit of the log, continuous over turns.

    `turn`: the angle of a whole turn.

    Raises
    ------
    Refusal
        where it cannot be read, or has more readings than memory should hold
    """

    def __init__(self, path: Path, layout: Mapping[str, Any], turn: float) -> None:
        self.account, self.refused = Account(), list[RefusedLine]()
        ticks, angles, count = list[Array](), list[Array](), 0
        for reading in read(path, layout):
            self.account.add_account(reading.account)
            self.refused += reading.refused
            rows = reading.records
            if rows.ticks is not None and rows.table_angle is not None:
                ticks.append(rows.ticks.astype(np.float64))
                angles.append(rows.table_angle)
                count += len(rows.ticks)
            if count > MAX_READINGS:
                raise Refusal(
                    path.name,
                    "",
                    _(
                        "more than {max_readings} readings of the encoder",
                        max_readings=MAX_READINGS,
                    ),
                    "fewer",
                    _("thin them out: between two readings the table turns evenly"),
                )
        time = np.concatenate([np.zeros(0), *ticks]) / ticks_per_second(layout)
        later = np.diff(time, prepend=-np.inf) > 0  # of equal times the first counts
        self.time = _unrounded(time[later])
        self.angle = np.unwrap(np.concatenate([np.zeros(0), *angles])[later], period=turn)

    def angle_at(self, time: Array) -> Array:
        """The angle at these times of its clock, (n,), NaN where it is not known."""
        if len(self.time) < 2:
            return np.full(len(time), np.nan)
        step = np.diff(self.time)
        angle = np.interp(time, self.time, self.angle, left=np.nan, right=np.nan)
        between = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(step) - 1)
        angle[step[between] > MAX_GAP_INTERVALS * np.median(step)] = np.nan
        return np.asarray(angle)


def _unrounded(time: Array) -> Array:
    """Times, (n,), s, of the even clock that they are rounded from; as they are without one.

    Its steps rounded to counts q are two neighbours, and a line through all of them is off by less
    than q in all.
    """
    step = np.diff(time)
    if not len(step):
        return time
    number = np.append(0.0, np.cumsum(np.rint(step / np.median(step))))
    single = step[np.diff(number) == 1]
    if not len(single):
        return time
    low, high = float(single.min()), float(single.max())
    count = high - low
    if count < MIN_COUNT * low:
        return time
    near = np.minimum(single - low, high - single) < MAX_OFF_COUNT * count
    even = np.polynomial.Polynomial.fit(number, time, 1)(number)
    rounded = bool(near.all()) and np.ptp(time - even) < (1 + MAX_OFF_COUNT) * count
    return np.asarray(even) if rounded else time

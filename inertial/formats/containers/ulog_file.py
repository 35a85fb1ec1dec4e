"""A PX4 ULog: the messages of one topic as a table; a message is a row.

The columns have the names of the fields: timestamp, µs since the start of the autopilot;
accelerometer_m_s2[0] and gyro_rad[2] of sensor_combined, which is read where the layout names no
topic; x, y, z of sensor_accel and sensor_gyro. Of several instances of a topic the one that is
named is read, sensor_gyro_1, else the first. The axes are PX4's: x forward, y right, z down.

A ULog has no checksums. Where it is damaged pyulog goes on after the damage, and one refused row
says so; likewise where the log breaks off in a message, as it does when the power is cut.

Source: https://docs.px4.io/main/en/dev_log/ulog_file_format.html
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from functools import lru_cache, partial
from io import BufferedReader, FileIO, StringIO
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pyulog import ULog

from inertial.formats.columns.column_values import NumberValues
from inertial.formats.containers.container import BATCH_ROWS, Batch, Table
from inertial.tables.errors import Refusal
from inertial.text.messages import _

COMBINED = "sensor_combined"
MAX_FIELDS = 1 << 16  # of a topic: the length of a message has 16 bits
MAX_SECONDS, LEAST_BYTES_PER_SECOND = 60.0, 2e5  # pyulog reads 2e7 bytes of a whole log in a second

_HEAD_BYTES = 3  # of a message: its length and its kind
_NO_SAMPLE = np.iinfo(np.int32).max  # accelerometer_timestamp_relative where there is no new sample
_LISTED = ("sensor_", "vehicle_imu", "vehicle_acceleration", "vehicle_angular_velocity")

Fields = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Topics:
    """What was read of a log: the fields of each topic, and what is wrong with the file."""

    fields: Mapping[str, Fields]  # by topic with the number of its instance: sensor_gyro_1
    damage: Sequence[str]


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The ULog at `path` as a table of the messages of one topic.

    Raises
    ------
    Refusal
        where it does not hold that topic
    """
    named, state = layout.get("topic", COMBINED), path.stat()
    topics = _read(path, named, state.st_size, state.st_mtime_ns)
    fields = topics.fields.get(named) or topics.fields.get(f"{named}_0")
    if fields is None:
        raise _no_such_topic(path, named, _read(path, None, state.st_size, state.st_mtime_ns))
    yield Table(list(fields), partial(_batches, fields, topics.damage))


def _batches(fields: Fields, damage: Sequence[str], indices: Sequence[int]) -> Iterator[Batch]:
    values = list(fields.values())
    for first in range(0, len(values[0]), BATCH_ROWS):
        columns = {index: values[index][first : first + BATCH_ROWS] for index in indices}
        count = min(BATCH_ROWS, len(values[0]) - first)
        yield Batch(count, {index: NumberValues(some) for index, some in columns.items()})
    if damage:
        nothing = NumberValues(np.full(len(damage), np.nan))
        yield Batch(len(damage), dict.fromkeys(indices, nothing), dict(enumerate(damage)))


@lru_cache(1)  # a log is opened twice: for its clock, and for its samples
def _read(path: Path, topic: str | None, size: int, _changed: int) -> Topics:
    """The topic of this name, with all its instances, or all topics.

    Raises
    ------
    ValueError
        where the file defines messages larger than a message can be
    """
    with redirect_stdout(StringIO()):  # pyulog prints what it finds wrong
        with _File(path, size) as file:
            _refuse_excessive_fields(ULog(file, parse_header_only=True).message_formats)
        # A name may end in the number of an instance.
        names = None if topic is None else [topic, topic.rpartition("_")[0]]
        with _File(path, size) as file:
            log = ULog(file, message_name_filter_list=names)
    fields = {f"{data.name}_{data.multi_id}": data.data for data in log.data_list}
    for combined in fields.values():
        _remove_repeated_samples(combined)
    damage = []
    if log.file_corruption:
        damage.append(_("the log is damaged: messages may be missing, and numbers may be wrong"))
    if file.broken_at is not None:
        damage.append(
            _(
                "the log breaks off in the message at byte {byte} of {size}",
                byte=file.broken_at,
                size=size,
            )
        )
    return Topics(fields, damage)


def _remove_repeated_samples(fields: Fields) -> None:
    """NaN for the accelerometers of sensor_combined where they have no sample of their own."""
    stamps = fields.get("accelerometer_timestamp_relative")
    if stamps is not None and (repeated := stamps == _NO_SAMPLE).any():
        for name in fields:
            if name.startswith("accelerometer_m_s2["):
                fields[name] = np.where(repeated, np.nan, fields[name])


class _File(BufferedReader):
    """A log that knows where its last message breaks off, and is not read for ever."""

    def __init__(self, path: Path, size: int) -> None:
        super().__init__(FileIO(path))
        self._until = monotonic() + MAX_SECONDS + size / LEAST_BYTES_PER_SECOND
        self.broken_at: int | None = None
        self._last: tuple[int | None, int] = _HEAD_BYTES, 0  # requested and read

    def read(self, size: int | None = -1, /) -> bytes:
        """As any file; pyulog reads the head of each message, then the rest of it."""
        if monotonic() > self._until:
            raise TimeoutError(_("reading it takes longer than any whole log of its size"))
        data = super().read(size)
        self._last = size, len(data)
        return data

    def close(self) -> None:
        """Where the last message begins, unless it was the head of one that is not there."""
        if not self.closed and self._last != (_HEAD_BYTES, 0):
            self.broken_at = self.tell() - self._last[1]
        super().close()


def _refuse_excessive_fields(formats: Mapping[str, Any]) -> None:
    """Refuse formats within formats of which a few bytes define any number of fields."""
    counts: dict[str, int] = {}

    def count(name: str) -> int:
        if name not in counts and name in formats:
            counts[name] = 0
            for kind, size, _name in formats[name].fields:
                counts[name] += max(size, 1) * max(count(kind), 1)
        return counts.get(name, 1)

    for name in formats:
        if (fields := count(name)) > MAX_FIELDS:
            raise ValueError(
                _(
                    "{fields} fields in a message of {name}, at most {most} fit into one",
                    fields=fields,
                    name=name,
                    most=MAX_FIELDS,
                )
            )


def _no_such_topic(path: Path, named: str, topics: Topics) -> Refusal:
    names = sorted(topics.fields)
    shown = [name for name in names if name.startswith(_LISTED)] or names
    return Refusal(
        path.name,
        "topic",
        _("no messages of the topic '{named}'", named=named),
        _("one of {value}", value=", ".join(shown) or "its topics, of which it has none"),
        _("name the topic of the IMU in the format's key topic"),
    )

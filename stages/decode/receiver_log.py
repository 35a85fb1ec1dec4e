"""A log of a NovAtel receiver."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Array
from inertial.formats.file_type import FileType, file_type_of, refuse_no_log
from inertial.formats.gps_time import NANOSECONDS, utc
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from stages.decode.decoded import Decoded, first_of, interval_of, on_axis

if TYPE_CHECKING:
    from inertial.formats.novatel import novatel_reader


NO_EPOCH = {"epoch_gps": None, "recorded_on": None}  # of a log whose clock is its own


class ReceiverLog:
    """A log of a NovAtel receiver: GPS time, and increments in counts.

    Raises
    ------
    Refusal
        where the file is something else, such as a compressed log
    """

    clock = "GPS"
    arrival = None  # a receiver stamps a sample when it is taken

    def __init__(self, name: str, path: Path, layout: Mapping[str, Any]) -> None:
        _refuse_other_than_messages(path)
        self.name = name
        self.path = path
        self._axes: dict[str, list[str]] = layout["axes"]  # of a sensor's fields, such as z, -y, x
        self._counts = {
            "accel": float(layout["accelerometer_count"]),  # m/s
            "gyro": float(layout["gyro_count"]),  # rad
        }
        stamps = (reading.records.stamp for reading in _messages(path))
        first = first_of(stamps)
        interval = interval_of(first)
        # ns since the start of GPS time
        self.first = int(first[0]) if len(first) else None
        # s: increments become rates with it, so it turns them back into increments.
        self.interval = None if interval is None else interval / NANOSECONDS

    def decoded(self, origin: int) -> Iterator[Decoded]:
        """The log, piece by piece, with time since `origin`, ns of GPS time."""
        for reading in _messages(self.path):
            records = reading.records
            samples = {
                "record": records.record,
                "offset": records.offset,
                "line": records.line,
                # Whole numbers up to the difference: nothing of a nanosecond is lost.
                "time": (records.stamp - origin) / NANOSECONDS,
                "status": records.status,
                **self._rates(records.counts),
            }
            types = np.bincount(records.imu[records.imu > 0])
            types_in_messages = frozenset(np.flatnonzero(types).tolist())
            yield Decoded(samples, reading.refused, reading.account, types_in_messages)

    def _rates(self, counts: NDArray[np.int32]) -> dict[str, Array]:
        if self.interval is None:
            return {}
        fields = [(sensor, axis) for sensor in ("accel", "gyro") for axis in self._axes[sensor]]
        size = {sensor: count / self.interval for sensor, count in self._counts.items()}
        return dict(
            on_axis(sensor, axis, counts[:, i].astype(np.float64) * size[sensor])
            for i, (sensor, axis) in enumerate(fields)
        )

    def began(self, origin: int, *, absolute: bool) -> float:
        """What its samples' time 0 is by the encoder's clock, s: GPS time, or 0."""
        return origin / NANOSECONDS if absolute else 0.0

    def epoch(self, origin: int) -> dict[str, Any]:
        """Where time 0 lies in GPS time, and the day of the first sample."""
        if self.first is None:
            return NO_EPOCH
        return {
            "epoch_gps": origin / NANOSECONDS,
            "recorded_on": utc(self.first).date().isoformat(),
        }


def _messages(path: Path) -> "Iterator[novatel_reader.Reading]":
    """The messages of a receiver; what reads them is loaded only where there are any."""
    from inertial.formats.novatel import novatel_reader

    return novatel_reader.read(path)


def _refuse_other_than_messages(path: Path) -> None:
    refuse_no_log(path)
    if (file_type := file_type_of(path)) is not FileType.TEXT:
        raise Refusal(
            path.name,
            "",
            _("a file of {value}", value=file_type.value),
            _("messages of a NovAtel receiver, text or binary, as the instrument's format says"),
            _("name the right log, or give its manoeuvres a format of kind columns"),
        )

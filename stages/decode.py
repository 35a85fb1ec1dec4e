"""The logs become samples in SI units, body axes and one clock; no byte is left unaccounted for.

Nothing is repaired here. A line that cannot be trusted is refused with the reason; what the samples
themselves are worth is the business of `quality`.
"""

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from stages.campaign.units import CHANNEL_UNITS
from stages.contracts.errors import Refusal
from stages.contracts.parquet import BATCH_ROWS
from stages.contracts.stage import Stage
from stages.contracts.tables import ACCOUNTS, AXES, CLOCKS, LOGS, REFUSED, SAMPLES
from stages.formats import columns
from stages.formats.account import Account, RefusedLine
from stages.formats.ahead import ahead
from stages.formats.arrow_arrays import (
    array_of_numbers,
    array_of_texts,
    batch_of_rows,
    repeated_text,
)
from stages.formats.column_layout import ticks_per_second
from stages.formats.content import Content, content_of, refuse_compressed
from stages.formats.gps_time import NANOSECONDS, utc

if TYPE_CHECKING:
    from stages.formats import novatel

ICE_POINT = 273.15  # K
ANGLE_UNITS = {"deg": math.radians(1), "rad": 1.0}
LOOK_AHEAD = 1000  # samples, where there are as many, of which the interval is the median

Reals = NDArray[np.float64]
Pieces = Iterator[tuple[str, pa.RecordBatch]]


def decode(logs: Iterable[pa.RecordBatch], raw: list[Path]) -> Pieces:
    """The tables samples, refused, accounts and clocks in pieces, log after log.

    Time is GPS time since the first sample of the campaign for the logs of a receiver; for a log of
    columns it is the time since its own first sample. Increments become rates with the log's own
    median sample interval; a log that has too few samples for one has no rates.

    Raises
    ------
    Refusal
        where a log is missing, or has not the columns that its layout names
    """
    opened = [_open(row, raw) for batch in logs for row in batch.to_pylist()]
    stamps = [log.first for log in opened if isinstance(log, ReceiverLog) and log.first is not None]
    origin = min(stamps, default=0)
    for log in opened:
        size = log.path.stat().st_size
        yield from _pieces_of(log, origin)
        _refuse_grown(log.path, size)


@dataclass(frozen=True)
class Decoded:
    """What a piece of a log gives: n samples, the lines that were refused, and the account."""

    samples: dict[str, Any]  # columns of the table samples by name, (n,) each, SI
    refused: list[RefusedLine]
    account: Account
    imu_types: frozenset[int] = frozenset()  # that the messages tell, by NovAtel's list


class ReceiverLog:
    """A log of a NovAtel receiver: GPS time, and increments in counts.

    Raises
    ------
    Refusal
        where the file is something else, such as a compressed log
    """

    clock = "GPS"

    def __init__(self, name: str, path: Path, layout: Mapping[str, Any]) -> None:
        _refuse_other_than_messages(path)
        self.name = name
        self.path = path
        self._axes: list[str] = layout["axes"]  # such as z, -y, x: the order and sign of the fields
        self._counts = {
            "accel": float(layout["accelerometer_count"]),  # m/s
            "gyro": float(layout["gyro_count"]),  # rad
        }
        stamps = (reading.records.stamp for reading in _messages(path))
        first, median, _ = _look_ahead(stamps)
        # ns since the start of GPS time
        self.first = None if first is None else int(first)
        self.interval = None if median is None else median / NANOSECONDS  # s
        # Increments become rates with this interval, so it turns them back into increments.
        self.step = self.interval

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
            told = frozenset(np.unique(records.imu[records.imu > 0]).tolist())
            yield Decoded(samples, reading.refused, reading.account, told)

    def _rates(self, counts: NDArray[np.int32]) -> dict[str, Reals]:
        if self.interval is None:
            return {}
        rates: dict[str, Reals] = {}
        fields = [(sensor, axis) for sensor in ("accel", "gyro") for axis in self._axes]
        for field, (sensor, axis) in enumerate(fields):
            sign = -1 if axis.startswith("-") else 1
            increment = (sign * self._counts[sensor]) * counts[:, field].astype(np.float64)
            rates[f"{sensor}_{axis[-1]}"] = increment / self.interval
        return rates

    def epoch(self, origin: int) -> dict[str, Any]:
        """Where time 0 lies in GPS time, and the day of the first sample."""
        if self.first is None:
            return {"epoch_gps": None, "recorded_on": None}
        return {
            "epoch_gps": origin / NANOSECONDS,
            "recorded_on": utc(self.first).date().isoformat(),
        }


class ColumnLog:
    """A log of columns, text or not: its own time or none, and values in units or counts."""

    def __init__(self, name: str, path: Path, layout: Mapping[str, Any]) -> None:
        self.name = name
        self.path = path
        self._layout = layout
        time = layout.get("time")
        self.clock = "none" if time is None else "own"
        self._ticks = 1.0 if time is None else ticks_per_second(layout)
        self._first, self.interval, self.step = self._beginning()

    def _beginning(self) -> tuple[float, float | None, float | None]:
        """The time of the first sample in ticks; median and mean sample interval, s."""
        time = self._layout.get("time")
        if time is None:
            return 0.0, None, None
        if time.get("column") is None:  # rows are counted from the first, though it be refused
            return 0.0, 1 / self._ticks, 1 / self._ticks
        readings = columns.read(self.path, self._layout)
        first, median, mean = _look_ahead(self._ticks_of_one_sensor(readings))
        if median is None or mean is None:
            return first or 0.0, None, None
        return first or 0.0, median / self._ticks, mean / self._ticks

    def _ticks_of_one_sensor(self, readings: Iterable[columns.Reading]) -> Iterator[Reals]:
        """The times of one sensor, for two may come in rows of their own."""
        for reading in readings:
            rows = reading.records
            sensor = rows.accelerometer if "accelerometer" in self._layout else rows.gyro
            if rows.ticks is not None:
                yield rows.ticks[np.isfinite(sensor).any(axis=1)]

    def decoded(self, origin: int) -> Iterator[Decoded]:
        """The log, piece by piece; `origin` is none of its business."""
        for reading in columns.read(self.path, self._layout):
            rows = reading.records
            samples = {
                "record": rows.record,
                "offset": rows.offset,
                "line": rows.line,
                "mean_of": rows.mean_of,
                "label": rows.label,
                **self._triad("accel", "accelerometer", rows.accelerometer),
                **self._triad("gyro", "gyro", rows.gyro),
            }
            if rows.ticks is not None:
                samples["time"] = (rows.ticks - self._first) / self._ticks
            if rows.table_angle is not None:
                unit = ANGLE_UNITS[self._layout["table_angle"]["unit"]]
                samples["table_angle"] = rows.table_angle * unit
            if rows.temperature is not None:
                above = ICE_POINT if self._layout["temperature"]["unit"] == "degC" else 0.0
                samples["temperature"] = rows.temperature + above
            yield Decoded(samples, reading.refused, reading.account)

    def _triad(self, sensor: str, key: str, values: Reals) -> dict[str, Reals]:
        triad = self._layout.get(key)
        if triad is None:
            return {}
        size = CHANNEL_UNITS[triad["unit"]] / (triad.get("counts_per_unit") or 1)
        return {f"{sensor}_{axis}": values[:, place] * size for place, axis in enumerate(AXES)}

    def epoch(self, origin: int) -> dict[str, Any]:
        """Nothing: its clock is its own."""
        return {"epoch_gps": None, "recorded_on": None}


def _open(row: Mapping[str, str], raw: list[Path]) -> ReceiverLog | ColumnLog:
    """The log of one row of the table logs."""
    paths = {path.name: path for path in raw if path.is_file()}
    if row["file"] not in paths:
        raise Refusal(
            row["file"],
            "",
            "no such file",
            f"the log of the campaign beside {', '.join(sorted(paths)) or 'its campaign.yaml'}",
            "put it into the campaign's folder, or correct its name in campaign.yaml",
        )
    layout = json.loads(row["layout"])
    kind = ReceiverLog if layout["kind"] == "rawimus" else ColumnLog
    return kind(row["log"], paths[row["file"]], layout)


def _messages(path: Path) -> "Iterator[novatel.Reading]":
    """The messages of a receiver; what reads them is loaded only where there are any."""
    from stages.formats import novatel

    return novatel.read(path)


def _refuse_other_than_messages(path: Path) -> None:
    refuse_compressed(path)
    if (content := content_of(path)) is not Content.TEXT:
        raise Refusal(
            path.name,
            "",
            f"a file of {content.value}",
            "messages of a NovAtel receiver, text or binary, as the instrument's format says",
            "name the right log, or give its manoeuvres a format of kind columns",
        )


def _refuse_grown(path: Path, size: int) -> None:
    """A log that is still written to would be another one in every run."""
    if (now := path.stat().st_size) != size:
        raise Refusal(
            path.name,
            "",
            f"{now} bytes, {now - size} more than when it was opened",
            "a log that is finished",
            "copy it when the recording has ended, and run again",
        )


def _look_ahead(
    times: Iterable[NDArray[np.int64] | Reals],
) -> tuple[float | None, float | None, float | None]:
    """The first time of a log, and the time from sample to sample, by its first pieces.

    That is the median, and the mean of those steps that are no gaps: stamps of a
    millisecond make the median jump, not the mean.
    """
    seen: list[NDArray[Any]] = []
    for some in times:
        seen.append(some)
        if sum(len(part) for part in seen) > LOOK_AHEAD:
            break
    together = np.concatenate(seen) if seen else np.array([])
    steps = np.diff(together)
    forward = steps[steps > 0]
    if not len(forward):
        return (together[0].item() if len(together) else None, None, None)
    median = float(np.median(forward))
    return together[0].item(), median, float(np.mean(forward[forward < 1.5 * median]))


def _pieces_of(log: ReceiverLog | ColumnLog, origin: int) -> Pieces:
    """All four tables of one log."""
    account = Account()
    records = 0
    ends: list[float | None] = []
    imu_types: frozenset[int] = frozenset()
    for decoded in ahead(log.decoded(origin)):
        account.add_account(decoded.account)
        imu_types |= decoded.imu_types
        if decoded.refused:
            lines = [{"log": log.name, **asdict(line)} for line in decoded.refused]
            yield "refused", batch_of_rows(lines, REFUSED.schema)
        samples = _sample_rows(log.name, decoded.samples)
        for start in range(0, len(samples), BATCH_ROWS):
            yield "samples", samples.slice(start, BATCH_ROWS)
        if len(samples):
            records += len(samples)
            ends = [*ends[:1], samples["time"][0].as_py(), samples["time"][-1].as_py()]
    sums = [
        {"log": log.name, "kind": kind, "name": name, "lines": lines, "bytes": size}
        for kind, name, lines, size in account
    ]
    yield "accounts", batch_of_rows(sums, ACCOUNTS.schema)
    clock = {
        "log": log.name,
        "clock": log.clock,
        **log.epoch(origin),
        "from_s": ends[0] if ends else None,
        "to_s": ends[-1] if ends else None,
        "records": records,
        "interval": log.interval,
        "step": log.step,
        "imu_types": " ".join(map(str, sorted(imu_types))) or None,
    }
    yield "clocks", batch_of_rows([clock], CLOCKS.schema)


def _sample_rows(log: str, samples: Mapping[str, Any]) -> pa.RecordBatch:
    """The samples in the columns of the table; what the log does not record is null."""
    rows = len(samples["record"])
    filled: dict[str, pa.Array] = {"log": repeated_text(log, rows)}
    for name, values in samples.items():
        if isinstance(values, list):
            filled[name] = array_of_texts(values).dictionary_encode()
        elif values is not None:
            filled[name] = array_of_numbers(values)
    arrays = [
        filled[column.name] if column.name in filled else pa.nulls(rows, column.type)
        for column in SAMPLES.columns
    ]
    return pa.RecordBatch.from_arrays(arrays, schema=SAMPLES.schema)


STAGE = Stage(
    decode,
    reads={"logs": LOGS},
    streams=("logs",),
    files=("raw",),
    writes={"samples": SAMPLES, "refused": REFUSED, "accounts": ACCOUNTS, "clocks": CLOCKS},
)

if __name__ == "__main__":
    STAGE.command_line()

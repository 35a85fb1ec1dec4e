"""A recording of the simulated laboratory as the stage `decode` reads it, without bytes on disk.

The two readers of logs, `novatel_reader.read` and `column_reader.read`, hand over
the laboratory's counts instead; every other line of the stages is the same. What a receiver
writes, checksums and text, is left out: tests of bytes do that.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from inertial.formats.account import DECODED, Account
from inertial.formats.columns import column_reader
from inertial.formats.novatel import novatel_reader
from inertial.tables.parquet import BATCH_ROWS
from laboratory.folder import campaign_yaml
from laboratory.recording import Recording
from laboratory.records import Records

# As RAWIMUSA sends them, z, −y, x, accelerometers first; the laboratory counts x, y, z.
SENT, SIGNS = [2, 1, 0, 5, 4, 3], [1, -1, 1, 1, -1, 1]
LINE_BYTES = 90  # of a line that was never written: only sizes of files follow from it
ICE_POINT = 273.15  # K
PLACEHOLDER = b"counts in memory\n"  # of a log: an empty file is refused


@dataclass(frozen=True)
class MemoryStream:
    """A table in memory that stages read batch by batch, like `parquet.Stream`."""

    table: pa.Table

    def __iter__(self) -> Iterator[pa.RecordBatch]:
        yield from self.table.to_batches(BATCH_ROWS)

    def columns(self, names: list[str]) -> Iterator[pa.RecordBatch]:
        """The same, of some columns only."""
        yield from self.table.select(names).to_batches(BATCH_ROWS)

    def rows(self, first: int, after: int, names: list[str]) -> Iterator[pa.RecordBatch]:
        """Some columns of the rows [first, after)."""
        yield from self.table.select(names).slice(first, after - first).to_batches()


@contextmanager
def recorded(recording: Recording, folder: Path) -> Iterator[Path]:
    """The folder of a campaign whose logs hold nothing, while the readers know their counts."""
    folder.mkdir(parents=True)
    (folder / "campaign.yaml").write_bytes(campaign_yaml(recording.campaign))
    for log in recording.records:
        (folder / log).write_bytes(PLACEHOLDER)
    kept = novatel_reader.read, column_reader.read
    novatel_reader.read = _reader(recording, kept[0], _rawimusa)
    column_reader.read = _reader(recording, kept[1], _of_columns)
    try:
        yield folder
    finally:
        novatel_reader.read, column_reader.read = kept


def _reader(
    recording: Recording, otherwise: Callable[..., Any], told: Callable[..., Any]
) -> Callable[..., Any]:
    def read(path: Path, *layout: Any) -> Iterator[Any]:
        if path.name not in recording.records or path.read_bytes() != PLACEHOLDER:
            yield from otherwise(path, *layout)
        else:
            yield told(recording, recording.records[path.name])

    return read


def _rawimusa(recording: Recording, records: Records) -> novatel_reader.Reading:
    number = np.arange(len(records), dtype=np.int64)
    increments = novatel_reader.Increments(
        record=number,
        offset=number * LINE_BYTES,
        line=number + 1,
        stamp=records.stamps,
        status=np.full(len(records), int(recording.receiver.status, 16), np.uint32),
        counts=(records.counts[:, SENT] * SIGNS).astype(np.int32),
        imu=np.full(len(records), -1, np.int16),
    )
    return novatel_reader.Reading(increments, [], _account("RAWIMUSA", len(records)))


def _of_columns(recording: Recording, records: Records) -> column_reader.Reading:
    number = np.arange(len(records), dtype=np.int64)
    angle = records.table_angle
    rows = column_reader.Rows(
        record=number,
        offset=number * LINE_BYTES,
        line=number + 2,  # behind the header
        ticks=(records.stamps - recording.start) / 1e9,
        mean_of=None,
        accelerometer=records.counts[:, :3].astype(np.float64),
        gyro=records.counts[:, 3:].astype(np.float64),
        table_angle=None if angle is None else np.degrees(angle).round(7).astype(np.float64),
        temperature=np.array([float(f"{t:.3f}") for t in records.temperature - ICE_POINT]),
        label=None,
    )
    return column_reader.Reading(rows, [], _account("", len(records)))


def _account(name: str, lines: int) -> Account:
    account = Account()
    account.add(DECODED, name, lines, lines * LINE_BYTES)
    return account

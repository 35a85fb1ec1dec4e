"""Reader of a log of columns: one data row per sample, in text or in a container.

The content decides which, never the name of the file. Numbers have the units of the file.
`text_reader` and `container` say which rows are refused.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.formats.columns import text_reader
from inertial.formats.columns.data_rows import Reading, Rows
from inertial.formats.columns.text_lines import CHUNK_BYTES
from inertial.formats.containers import container
from inertial.formats.file_type import FileType, file_type_of, refuse_no_log

__all__ = ["Reading", "Rows", "read"]


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
    wraps_at = (layout.get("time") or {}).get("wraps_at")
    yield from readings if wraps_at is None else _unwrapped(readings, wraps_at)


def _unwrapped(readings: Iterable[Reading], wraps_at: int) -> Iterator[Reading]:
    """The same with ticks that go on where a counter began again after `wraps_at` ticks."""
    last: Array = np.zeros(0)
    for reading in readings:
        if (ticks := reading.records.ticks) is not None and len(ticks):
            last = np.unwrap(np.append(last, ticks), period=wraps_at)[len(last) :]
            reading = replace(reading, records=replace(reading.records, ticks=last))
            last = last[-1:]
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

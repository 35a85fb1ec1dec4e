"""A log of columns: one data row per sample, in text or in a container, told by its content.

Numbers come out as they stand in the file. `text_columns` and `containers` say which rows are
refused.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from stages.formats import containers, text_columns
from stages.formats.content import Content, content_of, refuse_compressed
from stages.formats.pieces import PIECE_BYTES
from stages.formats.rows import Reading, Rows

__all__ = ["Reading", "Rows", "read"]


def read(
    path: Path, layout: Mapping[str, Any], piece_bytes: int = PIECE_BYTES
) -> Iterator[Reading]:
    """The log at `path` in this layout, piece by piece; text about `piece_bytes` at a time.

    Raises
    ------
    Refusal
        where the layout names a column that is not there, or is there twice; where the file is
        compressed; where a container is damaged
    """
    refuse_compressed(path)
    opening = _opening(content_of(path))
    if opening is None:
        yield from text_columns.read(path, layout, piece_bytes)
    else:
        yield from containers.read(path, layout, opening)


def _opening(content: Content) -> containers.Opening | None:
    """How a container is opened; None for text.

    Its library is imported only where a log needs it: all of them together take longer than most
    logs do.
    """
    match content:
        case Content.PARQUET:
            from stages.formats import parquet_columns

            return parquet_columns.opened
        case Content.ARROW_FILE | Content.ARROW_STREAM:
            from stages.formats import arrow_columns

            return arrow_columns.opened
        case Content.HDF5:
            from stages.formats import hdf5_columns

            return hdf5_columns.opened
        case Content.MATLAB_5:
            from stages.formats import matlab5_columns

            return matlab5_columns.opened
        case Content.ROS_1:
            from stages.formats import ros1_bag

            return ros1_bag.opened
        case Content.ROS_2:
            from stages.formats import ros2_bag

            return ros2_bag.opened
        case Content.MCAP:
            from stages.formats import mcap

            return mcap.opened
        case Content.TEXT:
            return None

"""How large the chunks of an HDF5 matrix get, looked at before they are unpacked.

The library unpacks a chunk for as long as there is something to unpack, whatever its size should
be. So a chunk that is stored in more than a little is unpacked once into nothing before.
"""

import zlib
from pathlib import Path

import h5py
import numpy as np

from inertial.tables.errors import Refusal
from stages.formats.limits import LARGEST_GROWTH, LARGEST_PIECE, refuse_growth, refuse_piece

_DEFLATE, _SHUFFLE, _CHECKSUM = 1, 2, 3  # the library's own numbers of what it does to a chunk
_HARMLESS = {(), (_DEFLATE,), (_SHUFFLE,), (_SHUFFLE, _DEFLATE)}  # with or without a checksum
_MORE = 8  # byte, more than a checksum has
_LITTLE = LARGEST_PIECE // LARGEST_GROWTH  # byte; cannot get too large


def refuse_large_chunks(path: Path, matrix: h5py.Dataset) -> None:
    """Look at every chunk of a matrix in the file at `path`.

    Raises
    ------
    Refusal
        where it lies in another file, is packed in a way of its own, or claims too much
    """
    if matrix.external or matrix.is_virtual:
        raise Refusal(
            path.name,
            matrix.name,
            "a matrix whose values lie in another file",
            "values in the log itself",
            "write the log anew as one file",
        )
    size = int(np.prod(matrix.shape, dtype=object)) * matrix.dtype.itemsize
    refuse_growth(path, matrix.name, size, matrix.id.get_storage_size())
    if not matrix.chunks:
        return
    chunk_size = int(np.prod(matrix.chunks, dtype=object)) * matrix.dtype.itemsize
    refuse_piece(path, matrix.name, chunk_size)
    filters = _filters(path, matrix)
    for number in range(matrix.id.get_num_chunks() if _DEFLATE in filters else 0):
        stored = matrix.id.get_chunk_info(number)
        if stored.size > _LITTLE and not stored.filter_mask:
            packed = matrix.id.read_direct_chunk(stored.chunk_offset)[1]
            unpacked = len(zlib.decompressobj().decompress(packed, chunk_size + _MORE))
            if unpacked >= chunk_size + _MORE:
                raise Refusal(
                    path.name,
                    matrix.name,
                    f"a chunk that unpacks to more than the {chunk_size} bytes that it has",
                    "what the file says of it",
                    "copy the log anew from where it was recorded; this file is damaged or no log",
                )


def _filters(path: Path, matrix: h5py.Dataset) -> tuple[int, ...]:
    """What was done to each chunk, in order, checksums left out."""
    made = matrix.id.get_create_plist()
    all_filters = [made.get_filter(number)[0] for number in range(made.get_nfilters())]
    filters = tuple(number for number in all_filters if number != _CHECKSUM)
    if filters not in _HARMLESS:
        raise Refusal(
            path.name,
            matrix.name,
            f"values packed by the filters {', '.join(map(str, all_filters))}",
            "none, or deflate (gzip) with or without shuffle",
            "write the log anew with compression gzip, or without",
        )
    return filters

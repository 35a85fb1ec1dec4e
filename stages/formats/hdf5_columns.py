"""Columns of the matrices in an HDF5 file, such as one of MATLAB 7.3, called as in `matrices`.

MATLAB writes a matrix with its sides exchanged; as the samples lie along the longer side, that only
matters where both are the same. Groups are what structures are in MATLAB. Only what lies in the
file itself is followed: no links to names, to other files, to data outside.

Source: https://support.hdfgroup.org/documentation/hdf5/latest/_f_m_t3.html
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from stages.formats.containers import PORTION_ROWS, Portion, Table
from stages.formats.fields import Field, NumberField
from stages.formats.hdf5_sizes import refuse_large_chunks
from stages.formats.matrices import DEEPEST, MatrixColumn, columns_of, samples_of

_CACHE = (
    1 << 26
)  # byte per matrix: its columns are read one by one, each chunk should be unpacked once
_MATLAB = "MATLAB_class"  # what MATLAB notes with each variable


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The HDF5 file at `path` as a table.

    Raises
    ------
    Refusal
        where a matrix claims more than the file can hold, or columns differ in length
    """
    with h5py.File(path, "r", locking=False, rdcc_nbytes=_CACHE) as file:
        columns = [column for found in _matrices(file, "", DEEPEST, set()) for column in found]
        yield Table([column.name for column in columns], partial(_portions, path, file, columns))


def _matrices(
    group: h5py.Group, before: str, depth: int, seen: set[int]
) -> Iterator[list[MatrixColumn]]:
    """The columns of each matrix in the group; `before` are the names of the groups around it.

    A group that was `seen`, by its place in the file, is not opened again: one may hold itself.
    """
    seen.add(h5py.h5o.get_info(group.id).addr)
    for name in group:
        # What begins with # are MATLAB's own notes.
        if name.startswith("#") or not isinstance(group.get(name, getlink=True), h5py.HardLink):
            continue
        inside = group[name]
        if isinstance(inside, h5py.Group):
            if depth and h5py.h5o.get_info(inside.id).addr not in seen:
                yield from _matrices(inside, f"{before}{name}.", depth - 1, seen)
        elif isinstance(inside, h5py.Dataset) and inside.dtype.kind in "iuf":
            yield list(_columns(inside, before + name))


def _columns(matrix: h5py.Dataset, name: str) -> Iterator[MatrixColumn]:
    shape: tuple[int, ...] = matrix.shape or ()
    if _MATLAB in matrix.attrs and len(shape) == 2 and shape[0] == shape[1] > 1:
        # Each row of MATLAB's is a sample, which here is a column.
        for place in range(shape[0]):
            yield MatrixColumn(f"{name}.{place + 1}", matrix.name, shape[1], 1, place)
    else:
        yield from columns_of(matrix.name, shape, name)


def _portions(
    path: Path, file: h5py.File, columns: Sequence[MatrixColumn], indices: Sequence[int]
) -> Iterator[Portion]:
    wanted = {index: columns[index] for index in indices}
    samples = samples_of(path, wanted)
    matrices = {name: file[name] for name in {column.matrix for column in wanted.values()}}
    for matrix in matrices.values():
        refuse_large_chunks(path, matrix)
    # Whole chunks at a time, that none is unpacked twice.
    chunks = [_chunk(matrices[column.matrix], column.along) for column in wanted.values()]
    step = max([chunk * max(PORTION_ROWS // chunk, 1) for chunk in chunks], default=PORTION_ROWS)
    for first in range(0, samples, step):
        fields: dict[int, Field] = {}
        for index, column in wanted.items():
            some = slice(first, min(first + step, samples))
            where = (some, column.place) if column.along == 0 else (column.place, some)
            matrix = matrices[column.matrix]
            fields[index] = NumberField(np.asarray(matrix[where[: matrix.ndim]]))
        yield Portion(min(step, samples - first), fields)


def _chunk(matrix: h5py.Dataset, along: int) -> int:
    """How many samples are stored together."""
    return int(matrix.chunks[along]) if matrix.chunks else 1

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

from inertial.formats.columns.column_values import ColumnValues, NumberValues
from inertial.formats.containers.container import BATCH_ROWS, Batch, Table, refuse_excessive_rows
from inertial.formats.containers.matrices import MAX_DEPTH, MatrixColumn, columns_of, samples_of
from inertial.tables.errors import Refusal
from inertial.text.messages import _

# Per matrix: its columns are read one by one, and each chunk should be unpacked once.
_CACHE_BYTES = 1 << 26
_MATLAB = "MATLAB_class"  # the attribute that MATLAB writes with each variable


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The HDF5 file at `path` as a table.

    Raises
    ------
    Refusal
        where columns differ in length, or values lie outside the file
    """
    with h5py.File(path, "r", locking=False, rdcc_nbytes=_CACHE_BYTES) as file:
        columns = [c for matrix in _matrices(file, "", MAX_DEPTH, set()) for c in matrix]
        yield Table([column.name for column in columns], partial(_batches, path, file, columns))


def _matrices(
    group: h5py.Group, before: str, depth: int, visited: set[int]
) -> Iterator[list[MatrixColumn]]:
    """The columns of each matrix in the group; `before` are the names of the groups around it.

    A group that was `visited`, by its place in the file, is not opened again: one may hold itself.
    """
    visited.add(h5py.h5o.get_info(group.id).addr)
    for name in group:
        # Names with # are MATLAB's own.
        if name.startswith("#") or not isinstance(group.get(name, getlink=True), h5py.HardLink):
            continue
        inside = group[name]
        if isinstance(inside, h5py.Group):
            if depth and h5py.h5o.get_info(inside.id).addr not in visited:
                yield from _matrices(inside, f"{before}{name}.", depth - 1, visited)
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


def _batches(
    path: Path, file: h5py.File, columns: Sequence[MatrixColumn], indices: Sequence[int]
) -> Iterator[Batch]:
    required = {index: columns[index] for index in indices}
    samples = samples_of(path, required)
    refuse_excessive_rows(path, samples)
    matrices = {name: file[name] for name in {column.matrix for column in required.values()}}
    for matrix in matrices.values():
        _refuse_external(path, matrix)
    # Whole chunks at a time, that none is unpacked twice.
    chunks = [_chunk(matrices[column.matrix], column.along) for column in required.values()]
    step = max([chunk * max(BATCH_ROWS // chunk, 1) for chunk in chunks], default=BATCH_ROWS)
    for first in range(0, samples, step):
        values: dict[int, ColumnValues] = {}
        for index, column in required.items():
            some = slice(first, min(first + step, samples))
            values[index] = NumberValues(np.asarray(matrices[column.matrix][column.where(some)]))
        yield Batch(min(step, samples - first), values)


def _refuse_external(path: Path, matrix: h5py.Dataset) -> None:
    if matrix.external or matrix.is_virtual:
        raise Refusal(
            path.name,
            matrix.name,
            _("a matrix whose values lie in another file"),
            _("values in the log itself"),
            _("write the log anew as one file"),
        )


def _chunk(matrix: h5py.Dataset, along: int) -> int:
    """How many samples are stored together."""
    return int(matrix.chunks[along]) if matrix.chunks else 1

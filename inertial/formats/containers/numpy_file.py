"""Columns of the array in a NumPy file, .npy, or of the arrays in an archive of them, .npz.

Their names are those of `matrices`, an archive's arrays being the matrices. The columns of the one
array of an .npy go by number alone; those of a structured array have the names of its fields: `gx`,
or in an archive `imu.gx`; a field of three numbers is a matrix, `gyro.1`. Numbers only: no pickled
object is loaded.

Source: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
from numpy.lib import format as numpy_format
from numpy.typing import NDArray

from inertial.formats.containers.container import Table
from inertial.formats.containers.matrices import MAX_DEPTH, Matrices, batches, columns_of
from inertial.formats.file_type import FileType, file_type_of

Array = NDArray[Any]


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The file at `path` as a table: an .npy is mapped, of an .npz the required arrays are loaded.

    Raises
    ------
    Refusal
        where columns differ in length
    """
    if file_type_of(path) is FileType.NUMPY:
        plain = dict(_plain(np.load(path, mmap_mode="r", allow_pickle=False), ""))
        yield _table(path, {name: array.shape for name, array in plain.items()}, lambda _: plain)
        return
    with ZipFile(path) as archive:
        members = [name for name in archive.namelist() if name.endswith(".npy")]
        shapes = {member: _shapes(archive, member) for member in members}

        def load(names: set[str]) -> dict[str, Array]:
            arrays: dict[str, Array] = {}
            for member in members:
                if names & set(shapes[member]):
                    with archive.open(member) as file:
                        array = numpy_format.read_array(file, allow_pickle=False)
                    arrays |= _plain(array, member.removesuffix(".npy"))
            return arrays

        yield _table(path, {name: s for each in shapes.values() for name, s in each.items()}, load)


def _shapes(archive: ZipFile, member: str) -> dict[str, tuple[int, ...]]:
    """The shapes of the plain arrays in a member of the archive, by its header alone."""
    with archive.open(member) as file:
        first = numpy_format.read_magic(file) == (1, 0)
        read = numpy_format.read_array_header_1_0 if first else numpy_format.read_array_header_2_0
        shape, _order, dtype = read(file)
    if dtype.hasobject:
        return {}
    empty = np.broadcast_to(np.empty((), dtype), shape)  # of this shape, without its memory
    return {name: array.shape for name, array in _plain(empty, member.removesuffix(".npy"))}


def _plain(array: Array, name: str, depth: int = MAX_DEPTH) -> Iterator[tuple[str, Array]]:
    """The arrays of numbers in an array, by name; a structured one has one in each field."""
    if array.dtype.kind in "iufb":
        yield name, array
    for field in (array.dtype.names or ()) if depth else ():
        yield from _plain(array[field], f"{name}.{field}" if name else field, depth - 1)


def _table(
    path: Path,
    shapes: Mapping[str, tuple[int, ...]],
    load: Callable[[set[str]], Matrices],
) -> Table:
    columns = [column for name, shape in shapes.items() for column in columns_of(name, shape)]
    names = [column.name.removeprefix(".") or "1" for column in columns]
    return Table(names, partial(batches, path, columns, load))

"""Columns of the matrices in a MATLAB file of version 5 (`save -v6` or `-v7`).

Their names are those of `matrices`. Numbers only: of words, cells, functions and objects nothing is
read. A variable passes through memory as a whole, and only the required ones do.

Source: https://www.mathworks.com/help/pdf_doc/matlab/matfile_format.pdf
"""

import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat, whosmat

from inertial.formats.containers.container import Table
from inertial.formats.containers.matrices import (
    MAX_DEPTH,
    Matrices,
    MatrixColumn,
    batches,
    columns_of,
)
from inertial.tables.errors import Refusal
from inertial.text.messages import _

_INTEGERS = {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
_NUMBERS = {"double", "single", "logical"} | _INTEGERS


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The MATLAB file at `path` as a table.

    A structure is opened only where the layout names a field of it: `imu.gyro.3`.

    Raises
    ------
    Refusal
        where columns differ in length, or a variable is an object of MATLAB
    """
    required = list(_texts_in(layout))
    variables = _variables(path)
    columns: list[MatrixColumn] = []
    fields: dict[str, NDArray[Any]] = {}
    for name, shape, kind in variables:
        if kind in _NUMBERS:
            columns += columns_of(name, shape)
        elif kind == "struct" and any(text.startswith(f"{name}.") for text in required):
            inside = dict(_fields(_load(path, [name])[name], name, MAX_DEPTH))
            fields |= inside
            for field, matrix in inside.items():
                columns += columns_of(field, matrix.shape)

    def load(names: set[str]) -> Matrices:
        return fields | _load(path, sorted(names - set(fields)))

    yield Table([column.name for column in columns], partial(batches, path, columns, load))


def _variables(path: Path) -> list[tuple[str, tuple[int, ...], str]]:
    """Name, shape and class of each variable."""
    try:
        return list(whosmat(str(path), appendmat=False))
    except TypeError as error:  # of a variable without a shape
        raise Refusal(
            path.name,
            "",
            _("a variable that is an object of MATLAB, such as a table or a timeseries"),
            _("matrices of numbers, with a column for each axis"),
            _("save its columns as matrices: force = t.Variables; save('log.mat', 'force')"),
        ) from error


def _load(path: Path, variables: list[str]) -> dict[str, NDArray[Any]]:
    """The variables of these names; what is wrong with one is an error, not a warning."""
    if not variables:
        return {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        loaded = loadmat(str(path), appendmat=False, variable_names=variables)
    return {name: np.atleast_2d(loaded[name]) for name in variables}


def _fields(structure: NDArray[Any], name: str, depth: int) -> Iterator[tuple[str, NDArray[Any]]]:
    """The matrices in a structure, by their names with all before them."""
    if structure.dtype.names is None:
        if structure.dtype.kind in "iufb":
            yield name, structure
    elif structure.size == 1 and depth:
        for field in structure.dtype.names:
            value = structure.flat[0][field]
            if isinstance(value, np.ndarray):
                yield from _fields(value, f"{name}.{field}", depth - 1)


def _texts_in(layout: object) -> Iterator[str]:
    """Every text in the layout."""
    if isinstance(layout, str):
        yield layout
    elif isinstance(layout, Mapping):
        for key, value in layout.items():
            yield from _texts_in(key)
            yield from _texts_in(value)
    elif isinstance(layout, Sequence):
        for value in layout:
            yield from _texts_in(value)

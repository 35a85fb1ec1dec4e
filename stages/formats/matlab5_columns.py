"""Columns of the matrices in a MATLAB file of version 5 (`save -v6` or `-v7`).

Their names are those of `matrices`. Numbers only: of words, cells, functions and objects nothing is
read. A variable passes through memory as a whole, and only the wanted ones do; `matlab5_sizes`
looks first how large they get.

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

from stages.formats.containers import PORTION_ROWS, Portion, Table
from stages.formats.fields import NumberField
from stages.formats.matlab5_sizes import refuse_large_variables
from stages.formats.matrices import DEEPEST, MatrixColumn, columns_of, samples_of

_WHOLE = {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
_NUMBERS = {"double", "single", "logical"} | _WHOLE

Matrices = dict[str, NDArray[Any]]


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The MATLAB file at `path` as a table.

    A structure is opened only where the layout names a field of it: `imu.gyro.3`.

    Raises
    ------
    Refusal
        where a variable unpacks to more than may be, or columns differ in length
    """
    refuse_large_variables(path)
    wanted = list(_texts_in(layout))
    variables = whosmat(str(path), appendmat=False)
    columns: list[MatrixColumn] = []
    fields: Matrices = {}
    for name, shape, kind in variables:
        if kind in _NUMBERS:
            columns += columns_of(name, shape)
        elif kind == "struct" and any(text.startswith(f"{name}.") for text in wanted):
            inside = dict(_fields(_load(path, [name])[name], name, DEEPEST))
            fields |= inside
            for field, matrix in inside.items():
                columns += columns_of(field, matrix.shape)
    yield Table([column.name for column in columns], partial(_portions, path, columns, fields))


def _portions(
    path: Path, columns: Sequence[MatrixColumn], fields: Matrices, indices: Sequence[int]
) -> Iterator[Portion]:
    wanted = {index: columns[index] for index in indices}
    samples = samples_of(path, wanted)
    variables = {column.matrix for column in wanted.values()} - set(fields)
    matrices = fields | (_load(path, sorted(variables)) if variables else {})
    values = {
        index: np.take(matrices[column.matrix], column.place, 1 - column.along)
        for index, column in wanted.items()
    }
    for first in range(0, samples, PORTION_ROWS):
        some = slice(first, first + PORTION_ROWS)
        count = min(PORTION_ROWS, samples - first)
        yield Portion(count, {index: NumberField(values[index][some]) for index in indices})


def _load(path: Path, variables: list[str]) -> Matrices:
    """The variables of these names; what is wrong with one is an error, not a warning."""
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

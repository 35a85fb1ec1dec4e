"""Columns of a file of named matrices, and what they are called.

The samples lie along the longer side of a matrix, whichever that is; where both are the same, each
row is a sample. A vector of n samples has the name of its variable, `time`. The columns of a matrix
are counted from 1: `gyro.1`, `gyro.2`, `gyro.3`. A field of a 1×1 structure stands behind its name:
`imu.time`, `imu.gyro.3`. Columns go by number in the order of these names.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.formats.columns.column_values import NumberValues
from inertial.formats.containers.container import BATCH_ROWS, Batch
from inertial.tables.errors import Refusal
from inertial.text.messages import _

Matrices = Mapping[str, NDArray[Any]]

MAX_COLUMNS = 1000  # a wider matrix is not one of samples
MAX_DEPTH = 4  # structures within structures


@dataclass(frozen=True)
class MatrixColumn:
    """A column: where it stands in which matrix."""

    name: str
    matrix: str  # the name of the matrix in the file
    samples: int  # how many values it has
    along: int  # the side along which the samples lie, from 0
    place: int | None  # which line along this side it is, from 0; none in a vector

    def where(self, some: slice) -> tuple[int | slice, ...]:
        """The index of some of its samples in the matrix."""
        if self.place is None:
            return (some,)
        return (some, self.place) if self.along == 0 else (self.place, some)


def columns_of(matrix: str, shape: Sequence[int], name: str = "") -> Iterator[MatrixColumn]:
    """The columns of a matrix of this shape, called `name`; a cube has none."""
    name = name or matrix
    if len(shape) == 1:
        yield MatrixColumn(name, matrix, shape[0], 0, None)
    elif len(shape) == 2:
        along = int(shape[1] > shape[0])
        samples, width = shape[along], shape[1 - along]
        if width == 1:
            yield MatrixColumn(name, matrix, samples, along, 0)
        elif width <= MAX_COLUMNS:
            for place in range(width):
                yield MatrixColumn(f"{name}.{place + 1}", matrix, samples, along, place)


def samples_of(path: Path, columns: Mapping[int, MatrixColumn]) -> int:
    """How many samples the required columns have.

    Raises
    ------
    Refusal
        where one has more than another
    """
    lengths = {column.samples: column.name for column in columns.values()}
    if len(lengths) > 1:
        raise Refusal(
            path.name,
            "",
            ", ".join(f"{samples} samples of {name}" for samples, name in lengths.items()),
            _("as many of each"),
            _("name columns that were recorded together"),
        )
    return next(iter(lengths), 0)


def batches(
    path: Path,
    columns: Sequence[MatrixColumn],
    load: Callable[[set[str]], Matrices],
    indices: Sequence[int],
) -> Iterator[Batch]:
    """The required columns some samples at a time; `load` gives the matrices of these names."""
    required = {index: columns[index] for index in indices}
    samples = samples_of(path, required)
    matrices = load({column.matrix for column in required.values()})
    for first in range(0, samples, BATCH_ROWS):
        count = min(BATCH_ROWS, samples - first)
        some = slice(first, first + count)
        values = {
            index: NumberValues(np.asarray(matrices[column.matrix][column.where(some)]))
            for index, column in required.items()
        }
        yield Batch(count, values)

"""The values of one column over some rows of a log, as numbers and as texts."""

import re
from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from inertial.formats.arrow_arrays import numbers_of

Reals = NDArray[np.float64]

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
# Of a buffer, for to make a scalar of a number the library imports pandas.
_NAN = pa.Array.from_buffers(pa.float64(), 1, [None, pa.py_buffer(np.array([np.nan]))])[0]


class ColumnValues(Protocol):
    """One column over n rows."""

    def numbers(self) -> Reals:
        """The numbers; NaN or infinite where there is none, (n,)."""

    def texts(self) -> list[str]:
        """The texts that the plan selects rows by, (n,)."""

    def text(self, row: int) -> str:
        """What stands in one row, for whoever has to correct it."""


class TextValues:
    """A column of a log of text: its numbers are what the texts say."""

    def __init__(self, texts: pa.ChunkedArray) -> None:
        self._texts = texts

    def numbers(self) -> Reals:
        """The numbers that the texts are, NaN where one is none, (n,)."""
        try:
            return numbers_of(pc.cast(self._texts, pa.float64()))
        except pa.ArrowInvalid:  # some are none: one by one
            return np.array(
                [float(text) if _NUMBER.fullmatch(text) else np.nan for text in self.texts()]
            )

    def texts(self) -> list[str]:
        """The texts as they stand in the file, (n,)."""
        texts: list[str] = self._texts.to_pylist()
        return texts

    def text(self, row: int) -> str:
        """One of them."""
        return str(self._texts[row].as_py())


class NumberValues:
    """A column of integers or floats of any width, NaN where there is none."""

    def __init__(self, values: NDArray[Any]) -> None:
        self._values = values

    def numbers(self) -> Reals:
        """The numbers, (n,)."""
        return self._values.astype(np.float64)

    def texts(self) -> list[str]:
        """The numbers in digits, whole ones without a point: 3, not 3.0, (n,)."""
        return [_digits(value) for value in self._values.tolist()]

    def text(self, row: int) -> str:
        """One of them."""
        return _digits(self._values[row].item())


class WordValues:
    """A column of anything else, such as words or dates: never a number, even where it looks so."""

    def __init__(self, words: Sequence[object]) -> None:
        self._words = words

    def numbers(self) -> Reals:
        """None: all NaN, (n,)."""
        return np.full(len(self._words), np.nan)

    def texts(self) -> list[str]:
        """The words, empty where there is none, (n,)."""
        return [self.text(row) for row in range(len(self._words))]

    def text(self, row: int) -> str:
        """One of them."""
        word = self._words[row]
        return "" if word is None else str(word).strip()


def arrow_values(column: pa.ChunkedArray) -> ColumnValues:
    """The values of an Arrow column of any type; null is no number, and no text."""
    kind = column.type
    if pa.types.is_integer(kind) and not column.null_count:
        return NumberValues(numbers_of(column))
    if pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind):
        reals = pc.cast(column, pa.float64(), safe=False)  # beyond 2⁵³ an integer is rounded
        return NumberValues(numbers_of(pc.fill_null(reals, _NAN)))
    return WordValues(column.to_pylist())


def _digits(value: float) -> str:
    return str(int(value)) if isinstance(value, int) or value.is_integer() else repr(value)

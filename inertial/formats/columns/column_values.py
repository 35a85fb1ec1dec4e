"""The values of one column over some rows of a log, as numbers, as times and as texts."""

import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from decimal import Decimal
from typing import Any, Protocol

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from inertial.arrays import Array, Booleans, Integers
from inertial.formats.arrow_arrays import array_of_texts, numbers_of

_DECIMAL = pa.decimal128(38, 9)  # holds every number of nanoseconds since 1970 to its last digit
_TO_WHOLE = pc.CastOptions(target_type=pa.int64(), allow_decimal_truncate=True)
NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
NO_VALUE = ("", "nan", "na", "n/a", "null", "none", "-", "--")  # in lower case
_TIME_ALONE = r"^(\d?\d:\d\d?:\d\d?)"
_DAY_FIRST = r"^(\d\d?)\.(\d\d?)\.(\d{4}),?[ T]"
_MONTH_FIRST = r"^(\d\d?)/(\d\d?)/(\d{4}),? (.*[AaPp]\.?[Mm]\.?)$"
_HALF_DAY = r" ?([AaPp])\.?[Mm]\.?$"
_HOUR = 3_600_000_000_000  # ns
_ONE_FIGURE = r"([-T :])(\d)([-T :.]|$)"
_WITH_ZONE = r"[T ].*(Z|[+-]\d\d(:?\d\d)?)$"
# Of a buffer, for to make a scalar of a number the library imports pandas.
_NAN = pa.Array.from_buffers(pa.float64(), 1, [None, pa.py_buffer(np.array([np.nan]))])[0]


class ColumnValues(Protocol):
    """One column over n rows."""

    def numbers(self) -> Array:
        """The numbers; NaN or infinite where there is none, (n,)."""

    def nanoseconds(self, *, iso: bool) -> tuple[Integers, Booleans]:
        """Whole nanoseconds, of dates and times in ISO 8601 those since 1970; and which are known.

        (n,) each. A stamp of 19 digits is not rounded, as a floating-point number would be.
        """

    def texts(self) -> list[str]:
        """The texts that the plan selects rows by, (n,)."""

    def blank(self) -> Booleans:
        """Where nothing stands, (n,)."""

    def unknown(self) -> Booleans:
        """Where it is said that there is no value: nothing, NaN, n/a, (n,)."""

    def text(self, row: int) -> str:
        """What stands in one row, for whoever has to correct it."""


class TextValues:
    """A column of a log of text: its numbers are what the texts say.

    `decimal`: what stands between the whole and the fraction of a number, a point or a comma.
    """

    def __init__(self, texts: pa.ChunkedArray, decimal: str = ".") -> None:
        self._texts = texts
        self._decimal = decimal

    def _in_digits(self) -> pa.ChunkedArray:
        """The texts as numbers are written everywhere; a point where a comma is due is none."""
        if self._decimal == ".":
            return self._texts
        return pc.replace_substring(pc.replace_substring(self._texts, ".", "_"), ",", ".")

    def numbers(self) -> Array:
        """The numbers that the texts are, NaN where one is none, (n,)."""
        texts = self._in_digits()
        try:
            return numbers_of(pc.cast(pc.replace_substring_regex(texts, "^$", "nan"), pa.float64()))
        except pa.ArrowInvalid:  # some are none: one by one
            return np.array(
                [float(text) if NUMBER.fullmatch(text) else np.nan for text in texts.to_pylist()]
            )

    def nanoseconds(self, *, iso: bool) -> tuple[Integers, Booleans]:
        """What the texts say, also as 1.40363657975856E+018, (n,) each."""
        if iso:
            return _times(self._texts)
        texts = self._in_digits()
        for kind in (pa.int64(), _DECIMAL):
            with suppress(pa.ArrowInvalid):
                whole = pc.cast(pc.cast(texts, kind), options=_TO_WHOLE)
                return numbers_of(whole), np.ones(len(whole), bool)
        return _one_by_one(texts, _whole)

    def blank(self) -> Booleans:
        """Which texts are empty, (n,)."""
        return np.asarray(numbers_of(pc.utf8_length(self._texts)) == 0)

    def unknown(self) -> Booleans:
        """Which texts say that there is no value, (n,)."""
        known = pc.is_in(pc.utf8_lower(self._texts), array_of_texts(list(NO_VALUE)))
        return np.asarray(numbers_of(known.cast(pa.int8())) == 1)

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

    def numbers(self) -> Array:
        """The numbers, (n,)."""
        return self._values.astype(np.float64)

    def nanoseconds(self, *, iso: bool) -> tuple[Integers, Booleans]:
        """The numbers, if they are not to be dates, (n,) each."""
        known = np.isfinite(self._values) & (not iso)
        return np.where(known, self._values, 0).astype(np.int64), known

    def blank(self) -> Booleans:
        """Nowhere: what is no number is damaged, (n,)."""
        return np.zeros(len(self._values), bool)

    def unknown(self) -> Booleans:
        """Which are NaN, (n,)."""
        return np.isnan(self.numbers())

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

    def numbers(self) -> Array:
        """None: all NaN, (n,)."""
        return np.full(len(self._words), np.nan)

    def nanoseconds(self, *, iso: bool) -> tuple[Integers, Booleans]:
        """The dates among the words, (n,) each."""
        if iso:
            return _times(pa.chunked_array([array_of_texts(self.texts())]))
        return np.zeros(len(self._words), np.int64), np.zeros(len(self._words), bool)

    def blank(self) -> Booleans:
        """Where there is no word, (n,)."""
        return np.array([not text for text in self.texts()], bool)

    def unknown(self) -> Booleans:
        """Which words say that there is no value, (n,)."""
        return np.array([text.lower() in NO_VALUE for text in self.texts()], bool)

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
    if pa.types.is_timestamp(kind):
        return WordValues(pc.cast(column, pa.string()).to_pylist())
    if pa.types.is_integer(kind) and not column.null_count:
        return NumberValues(numbers_of(column))
    if pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind):
        reals = pc.cast(column, pa.float64(), safe=False)  # beyond 2⁵³ an integer is rounded
        return NumberValues(numbers_of(pc.fill_null(reals, _NAN)))
    return WordValues(column.to_pylist())


def _digits(value: float) -> str:
    return str(int(value)) if isinstance(value, int) or value.is_integer() else repr(value)


def _times(texts: pa.ChunkedArray) -> tuple[Integers, Booleans]:
    """Dates and times in ISO 8601, one without a zone in UTC, as ns since 1970; which are known.

    Also where a figure lacks its leading zero; the time of the day alone is that since midnight;
    07.03.2025 14:02:03 has the day first, 3/7/2025 2:02:03 PM the month.
    """
    texts = pc.replace_substring(texts, ",", ".")
    texts = pc.replace_substring_regex(texts, _DAY_FIRST, r"\3-\2-\1 ")
    texts = pc.replace_substring_regex(texts, _MONTH_FIRST, r"\3-\1-\2 \4")
    halves = [_matches(texts, _HALF_DAY.replace("AaPp", half)) for half in ("Aa", "Pp")]
    texts = pc.replace_substring_regex(texts, _HALF_DAY, "")
    texts = pc.replace_substring_regex(texts, _TIME_ALONE, r"1970-01-01 \1")
    for _again in range(2):  # neighbours share what stands between them
        texts = pc.replace_substring_regex(texts, _ONE_FIGURE, r"\10\2\3")
    times, known = _iso_times(texts)
    morning, afternoon = halves
    noon = times // _HOUR % 24 == 12  # 12:30 PM is half past noon, 12:30 AM half past midnight
    return times + 12 * _HOUR * ((afternoon & ~noon).astype(int) - (morning & noon)), known


def _matches(texts: pa.ChunkedArray, pattern: str) -> Booleans:
    return np.asarray(numbers_of(pc.match_substring_regex(texts, pattern).cast(pa.int8())) == 1)


def _iso_times(texts: pa.ChunkedArray) -> tuple[Integers, Booleans]:
    zoned = pc.match_substring_regex(texts, _WITH_ZONE)
    with suppress(pa.ArrowInvalid):
        whole = pc.if_else(zoned, texts, pc.replace_substring_regex(texts, "$", "Z"))
        times = pc.cast(pc.cast(whole, pa.timestamp("ns", "UTC")), pa.int64())
        return numbers_of(times), np.ones(len(times), bool)
    return _one_by_one(texts, _time)


def _time(text: str) -> int:
    """One of them, in any notation of ISO 8601, to the microsecond."""
    time = datetime.fromisoformat(text)
    elapsed = (time if time.tzinfo else time.replace(tzinfo=UTC)) - datetime(1970, 1, 1, tzinfo=UTC)
    return ((elapsed.days * 86400 + elapsed.seconds) * 10**6 + elapsed.microseconds) * 1000


def _whole(text: str) -> int:
    """The whole part of a number."""
    if not NUMBER.fullmatch(text):
        raise ValueError
    return int(Decimal(text))


def _one_by_one(
    texts: pa.ChunkedArray, converted: Callable[[str], int]
) -> tuple[Integers, Booleans]:
    """The whole numbers that texts mean, 0 where one means none; and which these are."""
    found = np.zeros(len(texts), np.int64)
    known = np.zeros(len(texts), bool)
    for row, text in enumerate(texts.to_pylist()):
        with suppress(ValueError, ArithmeticError):
            found[row], known[row] = converted(text), True
    return found, known

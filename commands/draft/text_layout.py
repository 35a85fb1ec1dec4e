"""How a log of text is laid out: what separates its fields, and where its data begin."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

HEAD_BYTES = 1 << 17  # of the log, by which its layout is judged
MIN_NUMBERS = 3  # in a row of data
USUAL = 0.9  # share of rows in which a column of numbers holds one
DELIMITERS, DECIMALS = (None, ",", ";", "\t"), (".", ",")
COMMENTS = ("#", "//", "%")
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_DATE = re.compile(
    r"\d{4}-?\d\d-?\d\d[T ]\d\d:?\d\d(:?\d\d([.,]\d+)?)?(Z|[+-]\d\d:?\d\d)?", re.ASCII
)


@dataclass(frozen=True)
class TextLayout:
    """What the format of a campaign file states of a text, its header, and columns from 0 by kind.

    `stated`: delimiter, decimal, comment, header_lines; `header`: the lines before the data;
    `names`: of the columns as the reader has them; none where it does not name each of them once.
    """

    stated: dict[str, Any]
    header: Sequence[str]
    names: Sequence[str]
    numbers: Sequence[int]
    dates: Sequence[int]
    words: Sequence[int]


def text_layout(path: Path) -> TextLayout | None:
    """The layout of the text at `path`; None where no row holds enough numbers."""
    with path.open("rb") as file:
        head = file.read(HEAD_BYTES)
    lines = head.decode("utf-8-sig", errors="replace").splitlines()
    if len(head) == HEAD_BYTES:
        lines = lines[:-1]  # the last one is cut off
    best: tuple[tuple[int, int], str | None, str] = ((0, 0), None, ".")
    for delimiter, decimal in product(DELIMITERS, DECIMALS):
        if delimiter != decimal:
            rows = [_fields(line, delimiter) for line in lines]
            lengths = Counter(len(row) for row in rows if _is_data(row, decimal))
            if lengths:
                length, count = lengths.most_common(1)[0]
                best = max(best, ((count, length), delimiter, decimal), key=lambda found: found[0])
    (count, length), delimiter, decimal = best
    return _layout(lines, delimiter, decimal, length) if count else None


def is_number(text: str, decimal: str = ".") -> bool:
    """Whether a field of a log is a number."""
    text = text.strip()
    if decimal == ",":
        text = text.replace(".", "_").replace(",", ".")
    return bool(_NUMBER.fullmatch(text))


def _is_data(row: Sequence[str], decimal: str) -> bool:
    return sum(is_number(field, decimal) for field in row) >= MIN_NUMBERS


def _fields(line: str, delimiter: str | None) -> list[str]:
    return [field.strip() for field in line.split(delimiter)]


def _layout(lines: Sequence[str], delimiter: str | None, decimal: str, length: int) -> TextLayout:
    rows = [_fields(line, delimiter) for line in lines]
    data = [len(row) == length and _is_data(row, decimal) for row in rows]
    first = data.index(True)
    fields = list(zip(*(row for row, good in zip(rows, data, strict=True) if good), strict=True))

    def holding(good: Any) -> list[int]:
        return [
            n
            for n, own in enumerate(fields)
            if sum(bool(good(text)) for text in own) >= USUAL * len(own)
        ]

    numbers = holding(lambda text: is_number(text, decimal))
    dates = holding(_DATE.fullmatch)
    words = [n for n, own in enumerate(fields) if n not in numbers + dates and any(own)]
    header = lines[:first]
    comment = next((mark for mark in COMMENTS if any(h.startswith(mark) for h in header)), None)
    others = [line for line in header if not (comment and line.startswith(comment))]
    stated = {
        "delimiter": delimiter,
        "decimal": None if decimal == "." else decimal,
        "comment": comment,
        "header_lines": len(others) or None,
    }
    named = (others or header)[-1] if header else ""
    names = _names(named, delimiter, length)
    stated = {key: value for key, value in stated.items() if value is not None}
    return TextLayout(stated, header, names, numbers, dates, words)


def _names(line: str, delimiter: str | None, length: int) -> list[str]:
    """The names in the last line of a header; none where they do not fit the columns."""
    names = _fields(line.strip().lstrip("#%/").lstrip(), delimiter)
    if len(names) > 1 and not names[-1]:
        names = names[:-1]
    fit = len(names) in (length, length - 1) and len(set(names)) == len(names) and all(names)
    return names if fit and not any(map(is_number, names)) else []

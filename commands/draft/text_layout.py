"""How a log of text is laid out: what separates its fields, and where its data begin."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

HEAD_BYTES = 1 << 17  # of the log, by which its layout is judged
MIN_NUMBERS = 3  # in a row of data
USUAL = 0.9  # share of rows in which a column of numbers holds one
DELIMITERS = (None, ",", ";", "\t")
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)


@dataclass(frozen=True)
class TextLayout:
    """What separates fields, the lines before the data, and the columns by what they hold.

    `names`: of the columns by the last of `header`, the lines before the data; none where it does
    not name each of them once. `numbers`, `words`: columns from 0.
    """

    delimiter: str | None
    header: Sequence[str]
    names: Sequence[str]
    numbers: Sequence[int]
    words: Sequence[int]


def text_layout(path: Path) -> TextLayout | None:
    """The layout of the text at `path`; None where no row holds enough numbers."""
    with path.open("rb") as file:
        lines = file.read(HEAD_BYTES).decode(errors="replace").splitlines()
    lines = lines[:-1] or lines  # the last one may be cut off
    best: tuple[int, int, str | None] = (0, 0, None)
    for delimiter in DELIMITERS:
        lengths = Counter(
            len(fields)
            for fields in (_fields(line, delimiter) for line in lines)
            if sum(map(is_number, fields)) >= MIN_NUMBERS
        )
        if lengths:
            length, rows = lengths.most_common(1)[0]
            best = max(best, (rows, length, delimiter), key=lambda found: found[:2])
    rows, length, delimiter = best
    return _columns(lines, delimiter, length) if rows else None


def is_number(text: str) -> bool:
    """Whether a field of a log is a number."""
    return bool(_NUMBER.fullmatch(text.strip()))


def _fields(line: str, delimiter: str | None) -> list[str]:
    return [field.strip() for field in line.split(delimiter)]


def _columns(lines: Sequence[str], delimiter: str | None, length: int) -> TextLayout:
    rows = [_fields(line, delimiter) for line in lines]
    of_data = [len(row) == length and sum(map(is_number, row)) >= MIN_NUMBERS for row in rows]
    first = of_data.index(True)
    data = [row for row, good in zip(rows, of_data, strict=True) if good]
    numbers = [
        place
        for place in range(length)
        if sum(is_number(row[place]) for row in data) >= USUAL * len(data)
    ]
    words = [
        place for place in range(length) if place not in numbers and any(r[place] for r in data)
    ]
    return TextLayout(
        delimiter, lines[:first], _names(lines[:first], delimiter, length), numbers, words
    )


def _names(header: Sequence[str], delimiter: str | None, length: int) -> list[str]:
    """The names in the last line of a header, as the reader has them; none where they fit not."""
    if not header:
        return []
    names = _fields(header[-1].removeprefix("\ufeff"), delimiter)
    fit = len(names) == length == len(set(names)) and all(names) and not any(map(is_number, names))
    return names if fit else []

"""The columns of a log as the project's own readers have them, and how a text is laid out."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Array, Booleans
from inertial.formats.account import quoted
from inertial.formats.columns import column_reader, vectornav_lines
from inertial.formats.columns.column_layout import names_in_header
from inertial.formats.columns.column_values import NUMBER
from inertial.formats.columns.text_lines import (
    BYTE_ORDER_MARK,
    names_in,
    naming_line,
    without_names,
)
from inertial.formats.file_type import FileType, file_type_of
from inertial.formats.gps_time import NANOSECONDS
from inertial.formats.novatel import novatel_reader
from inertial.sensors import CHANNELS
from inertial.tables.errors import Refusal
from inertial.text.messages import _, plural

HEAD_BYTES = 1 << 17  # of the log, by which its layout is judged
MINNUMBERS = 3  # in a row of data
USUAL = 0.9  # share of rows in which a column of numbers holds one
DELIMITERS, DECIMALS = (None, ",", ";", "\t"), (".", ",")
QUOTED_COMMA = re.compile(r'"[+-]?\d+,\d+",|,"[+-]?\d+,\d+"')
NO_NUMBER = ("", "nan", "na", "n/a", "null")  # in lower case, among the numbers of a column
COMMENTS = ("#", "//", "%")
_DATE = re.compile(
    r"(\d{4}-?\d\d?-?\d\d?[T ]\d\d?:?\d\d?(:?\d\d?([.,]\d+)?)?(Z|[+-]\d\d:?\d\d)?)"
    r"|(\d\d?\.\d\d?\.\d{4},?[ T])?(\d?\d:\d\d:\d\d([.,]\d+)?)"
    r"|(\d\d?/\d\d?/\d{4},? )?(\d?\d:\d\d:\d\d(\.\d+)? ?[AaPp]\.?[Mm]\.?)",
    re.ASCII,
)


@dataclass(frozen=True)
class TextLayout:
    """What the format of a campaign file states of a text, its header, and columns from 0 by kind.

    `stated`: delimiter, decimal, comment, labelled, header_lines; `header`: the lines before the
    data; `names`: of the columns as the reader has them; none where not each has one of its own;
    `sparse`: columns that hold a number in some rows, and nothing in the others.
    """

    stated: dict[str, Any]
    header: Sequence[str]
    names: Sequence[str]
    numbers: Sequence[int]
    dates: Sequence[int]
    words: Sequence[int]
    sparse: Sequence[int]


def text_layout(path: Path) -> TextLayout | None:
    """The layout of the text at `path`; None where no row holds enough numbers."""
    with path.open("rb") as file:
        head = file.read(HEAD_BYTES)
    parts = head.removeprefix(BYTE_ORDER_MARK).split(b"\n")
    if len(head) == HEAD_BYTES or not parts[-1]:
        parts = parts[:-1]  # the last one is cut off
    lines = [_decoded(line.rstrip(b"\r")) for line in parts]
    if any(map(QUOTED_COMMA.search, lines)):
        raise Refusal(
            path.name,
            "",
            _("decimal commas in quotation marks, and commas between the columns"),
            _("another character between the columns than within numbers"),
            _('write it with semicolons: sed \'s/","/";"/g\''),
        )
    plain = _separated(lines)
    labels = [names_in(line.encode()) for line in lines]
    labelled = sum(len(names) >= MINNUMBERS for names in labels)
    if labelled and labelled >= plain.rows:
        bare = [without_names(line.encode()).decode() for line in lines]
        if (separated := _separated(bare)).rows:
            found = _layout(bare, separated, labels)
            return replace(found, header=lines[: len(found.header)])
    return _layout(lines, plain) if plain.rows else None


def _decoded(line: bytes) -> str:
    """A line as the reader has it, of a program for Windows too."""
    try:
        return line.decode("utf-8")
    except UnicodeDecodeError:
        return line.decode("cp1252", "backslashreplace")


@dataclass(frozen=True)
class _Separated:
    """What stands between the fields, within numbers, and how many fields most rows have."""

    rows: int = 0  # that hold enough numbers
    numbers: int = 0  # in all of them
    length: int = 0
    delimiter: str | None = None
    decimal: str = "."

    @property
    def rank(self) -> tuple[int, int, bool, int]:
        """The larger, the likelier: blanks may stand within names and dates."""
        return self.rows, self.numbers, self.delimiter is not None, self.length


def _separated(lines: Sequence[str]) -> _Separated:
    """How most lines are separated that hold enough numbers."""
    best = _Separated()
    for delimiter, decimal in product(DELIMITERS, DECIMALS):
        if delimiter != decimal:
            rows = [_fields(line, delimiter) for line in lines]
            data = [row for row in rows if _is_data(row, decimal)]
            if data:
                length, count = Counter(map(len, data)).most_common(1)[0]
                own = (text for row in data if len(row) == length for text in row)
                numbers = sum(is_number(text, decimal) for text in own)
                found = _Separated(count, numbers, length, delimiter, decimal)
                best = max(best, found, key=lambda one: one.rank)
    return best


def is_number(text: str, decimal: str = ".") -> bool:
    """Whether a field of a log is a number."""
    text = text.strip(' \t"')
    if decimal == ",":
        text = text.replace(".", "_").replace(",", ".")
    return bool(NUMBER.fullmatch(text))


def _is_data(row: Sequence[str], decimal: str) -> bool:
    return sum(is_number(field, decimal) for field in row) >= MINNUMBERS


def _fields(line: str, delimiter: str | None) -> list[str]:
    return [field.strip() for field in line.split(delimiter)]


def _layout(
    lines: Sequence[str], separated: _Separated, labels: Sequence[Sequence[bytes]] = ()
) -> TextLayout:
    """`labels`: of the fields of each line, where every field has one before it."""
    delimiter, decimal, length = separated.delimiter, separated.decimal, separated.length
    rows = [_fields(line, delimiter) for line in lines]
    data = [len(row) == length and _is_data(row, decimal) for row in rows]
    first = data.index(True)
    good_rows = (row for row, good in zip(rows, data, strict=True) if good)
    fields = [[text.strip(' "') for text in own] for own in zip(*good_rows, strict=True)]

    def holding(good: Any) -> list[int]:
        return [
            n
            for n, own in enumerate(fields)
            if sum(bool(good(text)) for text in own) >= USUAL * len(own)
        ]

    numbers = holding(lambda text: is_number(text, decimal))
    dates = holding(_DATE.fullmatch)
    some = [[text for text in own if text.lower() not in NO_NUMBER] for own in fields]
    sparse = [n for n, own in enumerate(some) if all(is_number(text, decimal) for text in own)]
    words = [n for n in range(len(fields)) if n not in numbers + dates + sparse]
    header = lines[:first]
    comment = next((mark for mark in COMMENTS if any(h.startswith(mark) for h in header)), None)
    others = [line for line in header if not (comment and line.startswith(comment))]
    stated = {
        "delimiter": delimiter,
        "decimal": None if decimal == "." else decimal,
        "comment": comment,
        "header_lines": len(others) or None,
    }
    named = naming_line(others or header, delimiter) if header else ""
    names = _names(named, delimiter, length)
    if labels:
        stated["labelled"] = True
        own = [name.decode() for name in labels[first]]
        names = own if len(own) == length and len(set(own)) == length else []
    stated = {key: value for key, value in stated.items() if value is not None}
    sparse = [n for n in sparse if some[n] and n not in numbers]
    return TextLayout(stated, header, names, numbers, dates, words, sparse)


def _names(line: str, delimiter: str | None, length: int) -> list[str]:
    """The names in a line of a header; none where they do not fit the columns."""
    names = names_in_header(line, delimiter)
    fit = len(names) in (length, length - 1) and len(set(names)) == len(names) and all(names)
    return names if fit and not any(map(is_number, names)) else []


# ---- The log.

Name = str | int
MIN_MESSAGES = 20  # of a receiver: fewer show no manoeuvre
MAX_WORDS = 50  # different ones in a column that labels rows
SENT = (2, 1, 0, 5, 4, 3)  # a receiver sends z, −y, x
SENT_SIGNS = (1, -1, 1, 1, -1, 1)


@dataclass(frozen=True)
class Pair:
    """Two columns that hold one time: whole seconds, and the fraction in another unit."""

    columns: tuple[Name, Name]
    units: tuple[str, str]


@dataclass(frozen=True)
class RawLog:
    """A log: `columns` and `words` by the name, or number from 1, of the campaign file.

    `layout`: what the format of the campaign file states beside the columns; `header`: the lines
    before the data; `columns`: (n,) numbers each, NaN where there is none; `words`: n texts each,
    of a few different ones; `dates`: columns of dates, in s; `unread`: columns that hold numbers
    in some rows only; `texts`: columns of other texts; `left_out`: rows at the end of the file
    that hold no samples, and are not among these; `pairs`: of a column that the file holds as two,
    whole units of time and a fraction, these two and their units.
    """

    path: Path
    layout: Mapping[str, Any]
    columns: Mapping[Name, Array]
    header: Sequence[str] = ()
    words: Mapping[Name, Sequence[str]] = field(default_factory=dict)
    dates: Sequence[Name] = ()
    unread: Sequence[Name] = ()
    texts: Sequence[Name] = ()
    left_out: int = 0
    pairs: Mapping[Name, "Pair"] = field(default_factory=dict)

    @property
    def kind(self) -> str:
        """The kind of its format."""
        return str(self.layout["kind"])

    @property
    def rows(self) -> int:
        """How many data rows."""
        return max((len(values) for values in self.columns.values()), default=0)

    def column(self, name: Name, rows: tuple[Name, str] | None = None) -> Array:
        """A column, or its rows in which another column holds a word: `rows`, both of these."""
        values = self.columns[name]
        if rows is None:
            return values
        other, word = rows
        return np.asarray(values[np.array(self.words[other])[: len(values)] == word])


def finite(values: Array) -> Array:
    """Those that are numbers; one zero where none is."""
    there = values[np.isfinite(values)]
    return there if len(there) else np.zeros(1)


def raw_log(path: Path) -> RawLog:
    """The log at `path`.

    Raises
    ------
    Refusal
        where no columns of numbers are in it
    """
    return _with_whole_times(_as_it_stands(path))


SECONDS = re.compile(r"(?P<stem>.*?)(?:secs?|seconds|tv_sec)", re.IGNORECASE)
FRACTIONS = (
    ("ns", 1e9, re.compile(r"(?:nsecs?|nanosecs?|nanoseconds?|tv_nsec)", re.IGNORECASE)),
    ("us", 1e6, re.compile(r"(?:usecs?|microsecs?|microseconds?|tv_usec)", re.IGNORECASE)),
)


def _with_whole_times(log: RawLog) -> RawLog:
    """The log with one column for each two of seconds and their fraction, as ROS has them."""
    columns, pairs = dict[Name, Array](), dict[Name, Pair]()
    parts = {part: pair for pair in _pairs(log) for part in pair[0].columns}
    for name, values in log.columns.items():
        if name not in parts:
            columns[name] = values
        elif name == parts[name][0].columns[0]:
            pair, time = parts[name]
            both = ", ".join(map(str, pair.columns))
            columns[both], pairs[both] = time, pair
    return replace(log, columns=columns, pairs=pairs) if pairs else log


def _pairs(log: RawLog) -> Iterator[tuple[Pair, Array]]:
    """Columns of whole seconds and of their fraction, by their names and values; and both in s."""
    for name, whole in log.columns.items():
        seconds = SECONDS.fullmatch(str(name))
        if seconds is None or (finite(whole) % 1).any():
            continue
        for (other, part), (unit, ticks, pattern) in product(log.columns.items(), FRACTIONS):
            if len(part) == len(whole) and str(other).startswith(seconds["stem"]):
                own, named = finite(part), pattern.fullmatch(str(other), len(seconds["stem"]))
                if named and own.min() >= 0 and 1 < own.max() <= ticks and not (own % 1).any():
                    yield Pair((name, other), ("s", unit)), whole + part / ticks


def _as_it_stands(path: Path) -> RawLog:
    names = column_reader.names_in(path)
    if names is not None:
        layout: dict[str, Any] = {"kind": "columns"}
        columns: dict[Name, Array] = {}
        for matrix in _matrices(names):
            columns |= _numbers(path, layout, matrix)
        return RawLog(path, layout, columns)
    if file_type_of(path) is FileType.TEXT and (messages := _receiver_log(path)) is not None:
        return messages
    with path.open("rb") as file:
        if file.read(3) == b"$VN":
            return _vectornav_log(path)
    found = text_layout(path)
    if found is None:
        raise Refusal(
            path.name,
            "",
            _("no rows of three numbers or more; {line}", line=_a_line(path)),
            _("the samples of an IMU: messages of a receiver, or rows of columns"),
            _(
                "leave it out where it is no log of an IMU; another format has to be exported as "
                "text first"
            ),
        )
    return _text_log(path, found)


def _a_line(path: Path) -> str:
    """The last line of the beginning of a file, with its number."""
    with path.open("rb") as file:
        lines = file.read(HEAD_BYTES).rstrip().splitlines()
    if not lines:
        return _("it is empty")
    return _("line {number} of it is '{line}'", number=len(lines), line=quoted(lines[-1]))


def _text_log(path: Path, found: TextLayout) -> RawLog:
    def column(place: int) -> Name:
        return found.names[place] if place < len(found.names) else place + 1

    layout = {"kind": "columns", **found.stated}
    columns = _numbers(path, layout, [column(place) for place in found.numbers])
    dates = [column(place) for place in found.dates]
    for name in dates:
        columns[name] = _dates(path, layout, name)
    labels = {}
    for place in found.words:
        words = _words(path, layout, column(place))
        if len(set(words)) <= MAX_WORDS:
            labels[column(place)] = words
    unread = [column(place) for place in found.sparse]
    texts = [name for name in map(column, found.words) if name not in labels]
    return RawLog(path, layout, columns, found.header, labels, dates, unread, texts)


def _receiver_log(path: Path) -> RawLog | None:
    """The increments of a receiver's log, in counts along body axes; None where it has none."""
    stamps: list[Array] = []
    counts: list[NDArray[np.int32]] = []
    for reading in novatel_reader.read(path):
        if not stamps and not len(reading.records.stamp):
            return None  # text as long as a chunk without a message
        stamps.append(reading.records.stamp / NANOSECONDS)
        counts.append(reading.records.counts)
    if not stamps:
        return None
    if (number := sum(map(len, stamps))) < MIN_MESSAGES:
        raise Refusal(
            path.name,
            "",
            plural("{count} message of an IMU", "{count} messages of an IMU", number),
            _("at least {least}, of a rest or a turn", least=MIN_MESSAGES),
            _("leave it out, or record for longer"),
        )
    body = np.concatenate(counts)[:, SENT] * np.array(SENT_SIGNS)
    columns: dict[Name, Array] = {"time": np.concatenate(stamps)}
    columns |= {name: body[:, i].astype(np.float64) for i, name in enumerate(CHANNELS)}
    return RawLog(path, {"kind": "rawimus"}, columns)


def _vectornav_log(path: Path) -> RawLog:
    """The readings of a VectorNav sensor, whose columns are known."""
    layout = vectornav_lines.layout_of({})
    values = _numbers(path, layout, [5, 6, 7, 8, 9, 10])
    units = ["m/s2"] * 3 + ["rad/s"] * 3
    columns: dict[Name, Array] = {
        f"{name} [{unit}]": own
        for name, unit, own in zip(CHANNELS, units, values.values(), strict=True)
    }
    return RawLog(path, {"kind": "vectornav"}, columns)


def _matrices(names: Sequence[str]) -> Iterator[list[str]]:
    """The columns of a container, those of each matrix together."""
    by_matrix: dict[str, list[str]] = {}
    for name in names:
        stem, _point, place = name.rpartition(".")
        by_matrix.setdefault(stem if place.isdecimal() else name, []).append(name)
    yield from by_matrix.values()


def _numbers(path: Path, layout: Mapping[str, Any], columns: Sequence[Name]) -> dict[Name, Array]:
    """The numbers of these columns; the reader takes three at a time, as axes of a sensor."""
    values: dict[Name, Array] = {}
    for first in range(0, len(columns), 3):
        three = columns[first : first + 3]
        padded = [*three, *[None] * (3 - len(three))]
        wanted = {**layout, "accelerometer": {"columns": padded, "unit": "m/s2"}}
        wanted.pop("gyro", None)
        records, numbers = [], []
        for reading in column_reader.read(path, wanted):
            records.append(reading.records.record)
            numbers.append(reading.records.accelerometer)
        place = np.concatenate(records) if records else np.zeros(0, np.int64)
        whole = np.full((int(place.max(initial=-1)) + 1, 3), np.nan)
        whole[place] = np.concatenate(numbers) if numbers else np.empty((0, 3))
        values |= {name: whole[:, axis] for axis, name in enumerate(three)}
    return values


def _dates(path: Path, layout: Mapping[str, Any], column: Name) -> Array:
    """A column of dates as seconds since 1970."""
    ticks = []
    for reading in column_reader.read(
        path, {**layout, "time": {"column": column, "unit": "iso8601"}}
    ):
        if reading.records.ticks is not None:
            ticks.append(reading.records.ticks / NANOSECONDS)
    return np.concatenate(ticks) if ticks else np.zeros(0)


def _words(path: Path, layout: Mapping[str, Any], column: Name) -> list[str]:
    """The texts of one column, row by row."""
    words: list[str] = []
    for reading in column_reader.read(path, {**layout, "label": [column]}):
        words += [label.partition("=")[2] for label in reading.records.label or []]
    return words


# ---- The end of a log that holds no samples: what was filled up, or read from an empty memory.

MIN_TAIL = 20  # rows that do not change, to be no chance
MIN_CLOCK_STEPS = 0.99  # share of steps in which a clock goes on
MIN_ZEROS = 3  # columns that a recorder fills up with zeros: the axes of a sensor


def without_tail(log: RawLog) -> RawLog:
    """The log without the rows at its end that hold no samples.

    Nothing changes in them but a clock, and they hold no number, or zeros, or a clock that stands:
    an IMU that rests is not so still.
    """
    names = list(log.columns)
    if not names or log.rows <= MIN_TAIL or log.kind == "rawimus":
        return log
    values = np.full((log.rows, len(names)), np.nan)
    for place, name in enumerate(names):
        values[: len(log.columns[name]), place] = log.columns[name]
    clocks = np.mean(np.diff(values, axis=0) > 0, axis=0) >= MIN_CLOCK_STEPS
    first = min(_unchanged_from(values), _unchanged_from(values[:, ~clocks]))
    if not 0 < first <= len(values) - MIN_TAIL or not _is_empty(values, first):
        return log
    columns: dict[Name, Array] = {name: log.columns[name][:first] for name in names}
    words: dict[Name, Sequence[str]] = {name: own[:first] for name, own in log.words.items()}
    return replace(log, columns=columns, words=words, left_out=len(values) - first)


def _unchanged_from(values: Array) -> int:
    """The first row, of (n, k), from which on all are the same; n where there are no columns."""
    if not values.size:
        return len(values)
    other = ~_same(values, values[-1]).all(axis=1)
    return int(np.flatnonzero(other)[-1]) + 1 if other.any() else 0


def _same(values: Array, last: Array) -> Booleans:
    return np.asarray((values == last) | (np.isnan(values) & np.isnan(last)))


def _is_empty(values: Array, first: int) -> bool:
    """Whether rows from `first` on, which do not change, hold no samples."""
    before, last = values[:first], values[-1]
    none = np.isnan(last) & (np.isfinite(before).mean(axis=0) > 0.5)
    zeros = (last == 0) & (before != 0).any(axis=0)
    went_on = np.mean(np.diff(before, axis=0) > 0, axis=0) >= MIN_CLOCK_STEPS
    stands = went_on & (values[first] == last)
    return bool(none.any() or zeros.sum() >= MIN_ZEROS or stands.any())

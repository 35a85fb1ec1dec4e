"""The outline of the report as data: sections with a title, what they show and how to read it.

What a part looks like is decided by report.html alone; a part only says what it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import Literal

from inertial.text.messages import LOCALES, _, language
from inertial.text.numbers import aligned, whole
from stages.report.tables import Tables

# What a column holds, hence how it is set: text; name (in one line); number (digits under
# digits); sigma (the number after ±); unit; symbol (`b_x` with its index below); code;
# identifier (code in one line); note (small); mark (✓ or ✗).
Kind = Literal[
    "text", "name", "number", "sigma", "unit", "symbol", "code", "identifier", "note", "mark"
]
# How grave a row, a paragraph or a figure is. Never by colour alone: a word says it too.
Tone = Literal["", "good", "fair", "poor"]
MOST_ROWS_TOGETHER = 12  # of a table that no page break cuts


@dataclass(frozen=True)
class Column:
    """A column of a table: its heading and what it holds; neighbours may share a `group`."""

    heading: str
    kind: Kind = "text"
    group: str = ""

    @property
    def label(self) -> str:
        """What stands before its cells where a narrow screen makes a card of each row."""
        if self.kind in ("sigma", "unit"):  # they follow the number that they belong to
            return ""
        return " ".join(filter(None, (self.group, self.heading)))


def columns(kind: Kind, *headings: str, group: str = "") -> tuple[Column, ...]:
    """Columns of one kind, below a common heading where `group` is given."""
    return tuple(Column(heading, kind, group) for heading in headings)


def value_and_sigma(
    group: str = "", value: str = _("value"), *, unit: bool = False
) -> list[Column]:
    """The columns of a value, its sigma, and its unit where that differs from row to row."""
    both = [Column(value, "number", group), Column("± σ", "sigma", group)]
    return [*both, Column(_("unit"), "unit", group)] if unit else both


class Traced(str):
    """A number as a cell, with the identifier by which the page traces it back to the logs."""

    id: str

    def __new__(cls, text: str, id: str) -> Traced:
        """`text` as it is shown; `id` as the tables have it."""
        made = super().__new__(cls, text)
        made.id = id
        return made


@dataclass(frozen=True)
class Row:
    """A row of a table; one with `heads` stands above the rows it names.

    `href`: another page that its first cell leads to; `sort`: what its cells are sorted by, where
    that is not their text.
    """

    cells: tuple[str, ...]
    anchor: str = ""
    tone: Tone = ""
    heads: bool = False
    href: str = ""
    sort: tuple[str, ...] = ()


def table_row(*cells: str, anchor: str = "", tone: Tone = "") -> Row:
    """A row of these cells."""
    return Row(cells, anchor, tone)


def head(name: str) -> Row:
    """The name of the rows below it."""
    return Row((name,), heads=True)


def more(count: int, where: str) -> str:
    """That `count` rows are left out, `where` says which; or nothing."""
    return _("{number} more{where}.", number=whole(count), where=where) if count > 0 else ""


class Part:
    """A piece of a section; `kind` says how the page shows it."""

    @property
    def kind(self) -> str:
        """The macro of the page."""
        return type(self).__name__.lower()


@dataclass(frozen=True)
class Table(Part):
    """A table with its caption; without rows, the words in `empty`.

    `sortable`: the script of the page, if it has one, lets its rows be filtered and sorted.
    """

    caption: str
    columns: Sequence[Column]
    rows: Sequence[Row]
    empty: str = _("None.")
    note: str = ""
    sortable: bool = False

    @property
    def short(self) -> bool:
        """Whether it stands on one printed page as a whole."""
        return len(self.rows) <= MOST_ROWS_TOGETHER

    @property
    def paddings(self) -> tuple[tuple[str, ...], ...]:
        """What follows each cell, so that points of a column stand below each other."""
        own = [row.cells for row in self.rows if not row.heads]
        columns = [
            [padded[len(cell) :] for cell, padded in zip(cells, aligned(cells), strict=True)]
            if column.kind in ("number", "sigma")
            else [""] * len(cells)
            for column, cells in zip(self.columns, zip(*own, strict=True), strict=False)
        ]
        rows = iter(zip(*columns, strict=True))
        return tuple(("",) if row.heads else next(rows) for row in self.rows)

    @property
    def groups(self) -> tuple[tuple[str, int], ...]:
        """The headings above the headings, each with how many columns it spans; or nothing."""
        if not any(column.group for column in self.columns):
            return ()
        spans = groupby(column.group for column in self.columns)
        return tuple((group, len(list(own))) for group, own in spans)


@dataclass(frozen=True)
class Figure(Part):
    """A drawing with its caption; `drawn` is SVG, `words` say it to who cannot see it.

    `small`: it stands to the right of what comes before it.
    """

    caption: str
    drawn: str
    words: str
    tone: Tone = ""
    small: bool = False


@dataclass(frozen=True)
class Paragraph(Part):
    """Plain sentences."""

    text: str
    tone: Tone = ""


@dataclass(frozen=True)
class Heading(Part):
    """The name of what follows within a section; other places lead to its `anchor`.

    `breaks`: it begins a printed page.
    """

    text: str
    anchor: str = ""
    breaks: bool = False


@dataclass(frozen=True)
class Sentences(Part):
    """Sentences, one below the other."""

    items: tuple[str, ...]


@dataclass(frozen=True)
class Facts(Part):
    """Names and what they are: instrument, serial, date."""

    pairs: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Signatures(Part):
    """Lines to sign on, what the signature is for and whose, and what stands below them."""

    pairs: tuple[tuple[str, str], ...]
    end: str


@dataclass(frozen=True)
class Equation(Part):
    """An equation in words and signs, with what it says."""

    text: str
    meaning: str


@dataclass(frozen=True)
class Matrix:
    """A matrix or a vector, digits under digits."""

    name: str
    entries: tuple[tuple[str, ...], ...]
    unit: str = ""


@dataclass(frozen=True)
class Matrices(Part):
    """Matrices side by side."""

    caption: str
    items: tuple[Matrix, ...]


@dataclass(frozen=True)
class Level(Part):
    """The verdict in one of three words."""

    word: str
    tone: Tone
    meaning: str


@dataclass(frozen=True)
class Link:
    """Words that lead to another place of the page."""

    words: str
    anchor: str


Pairs = tuple[tuple[str, str], ...]  # the answer to each question of one or two words


@dataclass(frozen=True)
class Finding(Part):
    """What was found: a sentence, what it does and what to do, the figures that show it.

    One about the `model` has its figures below the answers, one about the recording above.
    """

    anchor: str
    title: str
    grade: str  # how grave or how sure it is, in words
    sentence: str
    answers: Pairs
    facts: Pairs = ()
    parts: Sequence[Figure | Table] = ()
    links: Sequence[Link] = ()
    tone: Tone = ""
    model: bool = False


@dataclass(frozen=True)
class Section:
    """One section: what it shows, how to read it if that needs words, tables, parts."""

    key: str
    title: str
    shows: str
    reading: str
    reads: tuple[str, ...]
    parts: Callable[[Tables], Iterable[Part]]


@dataclass(frozen=True)
class Chapter:
    """A section in its place: its number, or as an annex its letter, and its parts."""

    number: str
    section: Section
    parts: Sequence[Part]

    @property
    def annex(self) -> bool:
        """Whether it stands behind the evidence; on screen it is folded then."""
        return self.number.isalpha()

    @property
    def reading(self) -> str:
        """How to read it; nothing where it has words alone, and so nothing to be explained."""
        words = all(isinstance(part, (Paragraph, Sentences)) for part in self.parts)
        return "" if words else self.section.reading


@dataclass(frozen=True)
class Report:
    """The whole report: its title page and its chapters in order.

    `script`: what runs in the page, written here; `wide`: its tables have many columns.
    """

    title: str
    campaign: str
    instrument: str  # with its serial
    running: str  # what stands on top of every printed page
    simulated: bool
    chapters: Sequence[Chapter]
    # Of traced numbers, by their identifier's folder.
    origins: Mapping[str, Sequence[str]] = field(default_factory=dict)
    script: str = ""
    wide: bool = False
    language: str = field(default_factory=lambda: LOCALES[language()])  # as HTML names it: zh-CN

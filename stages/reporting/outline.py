"""The outline of the report as data: sections with a title, what they show and how to read it.

What a part looks like is decided by report.html alone; a part only says what it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import ClassVar, Literal

# What a column holds, hence how it is set: text; name (in one line); number (digits under
# digits); sigma (the number after ±); unit; symbol (`b_x` with its index below); code;
# identifier (code in one line); note (small); mark (✓ or ✗).
Kind = Literal[
    "text", "name", "number", "sigma", "unit", "symbol", "code", "identifier", "note", "mark"
]
# How grave a row, a paragraph or a figure is. Never by colour alone: a word says it too.
Tone = Literal["", "good", "fair", "poor"]


@dataclass(frozen=True)
class Column:
    """A column of a table: its heading and what it holds; neighbours may share a `group`."""

    heading: str
    kind: Kind = "text"
    group: str = ""


@dataclass(frozen=True)
class Row:
    """A row of a table; one with `heads` stands above the rows it names."""

    cells: tuple[str, ...]
    anchor: str = ""
    tone: Tone = ""
    heads: bool = False


@dataclass(frozen=True)
class Table:
    """A table with its caption; without rows, the words in `empty`."""

    kind: ClassVar[str] = "table"
    caption: str
    columns: tuple[Column, ...]
    rows: tuple[Row, ...]
    empty: str = "None."
    note: str = ""

    @property
    def groups(self) -> tuple[tuple[str, int], ...]:
        """The headings above the headings, each with how many columns it spans; or nothing."""
        if not any(column.group for column in self.columns):
            return ()
        spans = groupby(column.group for column in self.columns)
        return tuple((group, len(list(columns))) for group, columns in spans)


@dataclass(frozen=True)
class Figure:
    """A drawing with its caption; `drawn` is SVG, `words` tell it to who cannot see it."""

    kind: ClassVar[str] = "figure"
    caption: str
    drawn: str
    words: str
    tone: Tone = ""


@dataclass(frozen=True)
class Paragraph:
    """Plain sentences."""

    kind: ClassVar[str] = "paragraph"
    text: str
    tone: Tone = ""


@dataclass(frozen=True)
class Heading:
    """The name of what follows within a section."""

    kind: ClassVar[str] = "heading"
    text: str
    anchor: str = ""


@dataclass(frozen=True)
class Sentences:
    """Sentences, one below the other."""

    kind: ClassVar[str] = "sentences"
    items: tuple[str, ...]


@dataclass(frozen=True)
class Facts:
    """Names and what they are: instrument, serial, date."""

    kind: ClassVar[str] = "facts"
    pairs: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Equation:
    """An equation in words and signs, with what it says."""

    kind: ClassVar[str] = "equation"
    text: str
    meaning: str


@dataclass(frozen=True)
class Matrix:
    """A 3×3 matrix and, where there is one, the vector beside it, digits under digits."""

    kind: ClassVar[str] = "matrix"
    name: str
    entries: tuple[tuple[str, ...], ...]
    unit: str = ""


@dataclass(frozen=True)
class Matrices:
    """Matrices side by side."""

    kind: ClassVar[str] = "matrices"
    caption: str
    items: tuple[Matrix, ...]


@dataclass(frozen=True)
class Level:
    """The verdict in one of three words."""

    kind: ClassVar[str] = "level"
    word: str
    tone: Tone
    meaning: str


@dataclass(frozen=True)
class Link:
    """Words that lead to another place of the page."""

    words: str
    anchor: str


@dataclass(frozen=True)
class Finding:
    """What was found, what it does to the result, what was or should be done, what shows it."""

    kind: ClassVar[str] = "finding"
    anchor: str
    title: str
    grade: str  # how grave it is, in words
    sentence: str
    consequence: str
    action: str
    facts: tuple[tuple[str, str], ...]
    parts: tuple[Figure | Table, ...] = ()
    links: tuple[Link, ...] = ()
    tone: Tone = ""


Answers = tuple[tuple[str, str], ...]  # each to a question of one or two words


@dataclass(frozen=True)
class Cause:
    """What the model lacks: a sentence, the answers to what a reader asks, and what shows it."""

    kind: ClassVar[str] = "cause"
    anchor: str
    title: str
    grade: str  # how sure it is, in words
    sentence: str
    answers: Answers
    parts: tuple[Figure | Table, ...] = ()
    links: tuple[Link, ...] = ()
    tone: Tone = ""


Part = (
    Table
    | Figure
    | Paragraph
    | Heading
    | Sentences
    | Facts
    | Equation
    | Matrices
    | Level
    | Finding
    | Cause
)


@dataclass(frozen=True)
class Section:
    """One numbered section: its title, what it shows, how to read it, and its parts."""

    key: str
    title: str
    shows: str
    reading: str
    parts: Sequence[Part] = field(default_factory=tuple)


@dataclass(frozen=True)
class Report:
    """The whole report: its title page and its sections in order."""

    title: str
    campaign: str
    instrument: str  # with its serial
    running: str  # what stands on top of every printed page
    simulated: bool
    sections: Sequence[Section]

"""Chinese type: full-width marks, no spaces between characters, columns as wide as they look.

Sentences are put together with the marks and spaces of English; where they meet Chinese
characters these become those of Chinese (GB/T 15834-2011). Text without Chinese stays as it is.
"""

import re
import textwrap
from itertools import groupby
from unicodedata import east_asian_width

HAN = "\u3400-\u9fff"
MARKS = "，。；：、？！（）《》“”"
CHINESE = re.compile(f"[{HAN}]")
FULL_WIDTH = {",": "，", ";": "；", ":": "："}
RULES = (
    (re.compile(rf" *\(([^()]*[{HAN}][^()]*)\) *"), r"（\1）"),
    (re.compile(rf"(?<=[{HAN}”）]) *\(([^()]*)\)"), r"（\1）"),
    (re.compile(rf"(?<=[{HAN}”）])\.(?=$|[^\d\w]|[{HAN}])"), "。"),
    (re.compile(rf"([%σ°\dA-Za-z)])\.(?= *[{HAN}])"), r"\1。"),
    (re.compile(r"(?<!\.)\.$|。\.|。。"), "。"),
    (re.compile(rf"(?<=[{HAN}{MARKS}]) +(?=[{HAN}{MARKS}])"), ""),
    (re.compile(rf"(?<=[{MARKS}]) +| +(?=[，。；：、？！（）])"), ""),
)
BEHIND = re.compile(rf"(?<=[{HAN}”）])([,;:])(?=\s|$)\s*")
BEFORE = re.compile(rf"([,;:]) +(?=[{HAN}“（])")
# A space between Chinese characters and letters or numbers, whoever put them beside each other.
APART = re.compile(rf"(?<=[{HAN}])(?=[A-Za-z0-9−±<])|(?<=[A-Za-z0-9%°σ″])(?=[{HAN}])")
NO_BEGINNING = "，。；：、？！）》”"  # what no line begins with
NO_END = "（《“"  # what no line ends with


def capital(text: str) -> str:
    """A sentence with its first letter large, but where it begins with the name of a file."""
    of_file = "." in text.partition(" ")[0].rstrip(".:")
    return text if of_file or CHINESE.search(text) else text[:1].upper() + text[1:]


def typeset(text: str) -> str:
    """A text with the marks of Chinese where it is Chinese."""
    if not CHINESE.search(text):
        return text
    text = BEHIND.sub(lambda mark: FULL_WIDTH[mark[1]], text)
    text = BEFORE.sub(lambda mark: FULL_WIDTH[mark[1]], text)
    for pattern, marks in RULES:
        text = pattern.sub(marks, text)
    return APART.sub(" ", text)


def wrapped(text: str, width: int, initial: str = "", subsequent: str = "") -> list[str]:
    """Lines of at most `width` columns, of which a Chinese character takes two."""
    if not CHINESE.search(text):
        return textwrap.wrap(
            text,
            width,
            initial_indent=initial,
            subsequent_indent=subsequent,
            break_on_hyphens=False,
        )
    lines, line = [], initial
    for piece in _pieces(text):
        full = columns_of(line + piece.rstrip()) > width and piece[0] not in NO_BEGINNING
        if full and line.strip():
            ends = line.rstrip()
            kept = ends.rstrip(NO_END)
            lines.append(kept.rstrip())
            line = subsequent + ends[len(kept) :] + piece.lstrip()
        else:
            line += piece
    return [*lines, line.rstrip()]


def columns_of(text: str) -> int:
    """The columns that a text takes on a terminal."""
    return sum(2 if east_asian_width(letter) in "WF" else 1 for letter in text)


def _pieces(text: str) -> list[str]:
    """What stays together: a word with the space before it, or one Chinese character."""
    pieces: list[str] = []
    for chinese, letters in groupby(text, lambda letter: east_asian_width(letter) in "WF"):
        own = "".join(letters)
        pieces += list(own) if chinese else re.findall(r"\s*\S+|\s+", own)
    return pieces

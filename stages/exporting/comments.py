"""Comment lines of the parameter files, in ASCII, whatever the names in them are made of.

Autopilots, their ground stations and Kalibr read these files with the character set of the
machine they run on, so nothing but ASCII goes into them.
"""

import textwrap
from collections.abc import Iterable

WIDTH = 96
LONGEST = 80  # characters of a name from outside
# The signs that the stages write, as they are written in ASCII.
PLAIN = str.maketrans(
    {
        "°": " deg", "²": "^2", "√": "sqrt ", "−": "-", "±": "+-", "×": "*", "·": "*", "µ": "u",
        "σ": "sigma", "…": "...", "′": "'", "″": '"', "–": "-", "÷": "/", "⁻": "^-", "¹": "1",
    }
)  # fmt: skip


def harmless(text: str) -> str:
    """`text` in printable ASCII on one line; any other sign as its escape sequence."""
    plain = text.translate(PLAIN)
    return "".join(
        sign if sign.isascii() and sign.isprintable() else sign.encode("unicode_escape").decode()
        for sign in plain
    )


def quoted(name: str) -> str:
    """A name from outside, between quotes and not too long."""
    short = name if len(name) <= LONGEST else f"{name[:LONGEST]}…"
    return f'"{harmless(short)}"'


def commented(paragraphs: Iterable[str]) -> list[str]:
    """Each paragraph as lines of a comment; one that begins with '- ' as an item of a list."""
    lines = []
    for paragraph in paragraphs:
        indent = "  " if paragraph.startswith("- ") else ""
        text = harmless(paragraph)
        wrapped = textwrap.wrap(
            text, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
        )
        lines += [f"# {line}" for line in wrapped] or ["#"]
    return lines

"""Rows whose fields carry their names, as many a serial port prints them.

`ax:123 ay:-4`, `gx = 0.1, gy = 0.2` and one JSON object a line: {"t": 0.01, "ax": 9.8}. The names,
quotation marks and braces become blanks, so that every byte stays in its place. The T of a date
begins no name.
"""

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from inertial.formats.columns.text_lines import Chunk, HeaderLines, RowLines

_NAME = rb"[A-Za-z_][^\s:=,;\"]*(?:[ ][A-Za-z_(\[][^\s:=,;\"]*)*"
_FIELD_NAME = re.compile(rb"(?<![\w.+-])\"?(" + _NAME + rb")\"?[ \t]*[:=]")
_MARKS = bytes.maketrans(b'"{}[]', b"     ")


class LabelledLines:
    """The lines of a log without the names in its fields.

    `names`: a header of those of the first row with three or more, separated as its fields are.
    """

    def __init__(self, layout: Mapping[str, Any]) -> None:
        self.names = b""
        self._header = HeaderLines(layout)
        self._between = str(layout.get("delimiter") or " ").encode()

    def rows_of(self, chunk: Chunk) -> RowLines:
        """The lines of the next chunk that are neither header nor comment."""
        lines = self._header.rows_of(chunk)
        if not self.names:
            found = (names_in(lines.chunk.text(i)) for i in range(len(lines.chunk)))
            names = next((own for own in found if len(own) >= 3), [])
            self.names = self._between.join(name.replace(self._between, b"_") for name in names)
        bare = without_names(lines.chunk.data)
        return replace(lines, chunk=replace(lines.chunk, data=bare))


def names_in(line: bytes) -> list[bytes]:
    """The names of the fields of a line."""
    return _FIELD_NAME.findall(line)


def without_names(text: bytes) -> bytes:
    """The same with blanks in their place."""
    return _FIELD_NAME.sub(lambda found: b" " * len(found[0]), text).translate(_MARKS)

"""The account of a log: where each of its lines and bytes went, and which were refused and why.

A reader counts every line of the file once, so the account adds up to the size of the file.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from inertial.arrays import Integers

DECODED = "decoded"
OTHER_MESSAGE = "other message"
HEADER = "header"
BLANK = "blank"
NOT_SELECTED = "not selected"
REFUSED = "refused"
KINDS = (DECODED, OTHER_MESSAGE, HEADER, BLANK, NOT_SELECTED, REFUSED)

QUOTED_BYTES = 80  # of a refused line that are kept


@dataclass(frozen=True)
class RefusedLine:
    """A line that could not be read."""

    line: int  # number in the file, from 1
    offset: int  # byte in the file where it begins
    bytes: int  # its length with its line end
    reason: str  # what was found and what was expected
    text: str  # its beginning; bytes that are no printable ASCII as \xNN


class Account:
    """Lines and bytes of a log by kind, and by name of the message where it has one."""

    def __init__(self) -> None:
        self._sums: dict[tuple[str, str], tuple[int, int]] = {}

    def add(self, kind: str, name: str, lines: int, size: int) -> None:
        """Count `lines` more lines of `size` bytes in all."""
        old_lines, old_size = self._sums.get((kind, name), (0, 0))
        self._sums[kind, name] = (old_lines + lines, old_size + size)

    def add_all(self, kind: str, name: str, lengths: Integers) -> None:
        """Count lines of these lengths in bytes."""
        if len(lengths):
            self.add(kind, name, len(lengths), int(lengths.sum()))

    def add_account(self, other: "Account") -> None:
        """Count what `other` has counted."""
        for kind, name, lines, size in other:
            self.add(kind, name, lines, size)

    def __iter__(self) -> Iterator[tuple[str, str, int, int]]:
        """Kind, name, lines, bytes of what there is; in the order of `KINDS`, then by name."""
        for kind, name in sorted(self._sums, key=lambda key: (KINDS.index(key[0]), key[1])):
            lines, size = self._sums[kind, name]
            if lines or size:
                yield kind, name, lines, size


def quoted(text: bytes) -> str:
    """The beginning of `text` as it can be shown; what is no printable ASCII stands as \\xNN."""
    return repr(text[:QUOTED_BYTES])[2:-1]

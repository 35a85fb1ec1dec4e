"""The lines of a text that are plain rows, cut into fields all at once.

Most lines of most logs are plain: ASCII, with as many fields as the others. One by one they took
half of the time of a log.
"""

import numpy as np
from numpy.typing import NDArray

from stages.formats.pieces import LONGEST_LINE, Integers, Piece

BETWEEN = b"\x1f"  # put between the fields of every row: ASCII's own unit separator

Truths = NDArray[np.bool_]

_FEED, _RETURN = ord("\n"), ord("\r")
# What a byte is: part of a text, blank, or a reason to look at its line more closely.
_TEXT, _BLANK, _ODD = range(3)
_KIND = np.full(256, _TEXT, np.uint8)
_KIND[list(b" \t\v\f\n")] = _BLANK
_KIND[[_RETURN, *BETWEEN, *range(128, 256)]] = _ODD


def plain_rows(
    piece: Piece, header: int, delimiter: bytes | None, fields: int
) -> tuple[Truths, bytes]:
    """Which lines of a piece are plain rows, (n,), and these with `BETWEEN` between their fields.

    `header`: lines at the beginning that are none; `delimiter`: None for any white space. One of
    several bytes makes no row a plain one.
    """
    if delimiter is not None and len(delimiter) > 1:
        return np.zeros(len(piece.starts), bool), b""
    data = np.frombuffer(piece.data, np.uint8)
    kind = _KIND[data]
    ends = piece.ends[piece.ends < len(data)]
    kind[ends[data[ends] == _RETURN]] = _BLANK  # of a line that ends with CRLF
    text = kind == _TEXT
    if delimiter is None:
        begins = np.flatnonzero(text & ~np.append(False, text[:-1]))
        counts = _of_lines(begins, piece)
    else:
        counts = _of_lines(np.flatnonzero(data == delimiter[0]), piece) + 1
    plain = (counts == fields) & np.logical_or.reduceat(text, piece.starts)
    plain &= (_of_lines(np.flatnonzero(kind == _ODD), piece) == 0) & (piece.lengths <= LONGEST_LINE)
    plain[:header] = False
    if not plain.any():
        return plain, b""
    if delimiter is None:
        between = _between(begins, counts)
        data = data.copy()
        data[between] = ord(BETWEEN)
        text[between] = True
        kept = text | (data == _FEED)
    else:
        data = np.where(data == delimiter[0], np.uint8(ord(BETWEEN)), data)
        kept = np.ones(len(data), bool)
    if not plain.all():
        kept &= np.repeat(plain, np.diff(piece.starts, append=len(data)))
    return plain, data[kept].tobytes().removesuffix(b"\n")


def _of_lines(places: Integers, piece: Piece) -> Integers:
    """How many of some bytes, by their ascending places, each line has, (n,)."""
    return np.diff(np.searchsorted(places, np.append(piece.starts, len(piece.data))))


def _between(begins: Integers, counts: Integers) -> Integers:
    """The bytes before the fields that are not the first of their lines."""
    first = np.append(0, np.cumsum(counts[counts > 0])[:-1])
    return np.delete(begins, first) - 1

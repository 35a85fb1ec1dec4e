"""How large the variables of a MATLAB file of version 5 get, counted before they are unpacked.

A compressed variable may unpack to a thousand times its size, and what it says of itself may be
wrong. So it is unpacked once into nothing, a little at a time.

Source: https://www.mathworks.com/help/pdf_doc/matlab/matfile_format.pdf
"""

import struct
import zlib
from pathlib import Path
from typing import BinaryIO

from stages.formats.limits import LARGEST_PIECE, refuse_piece

_HEADER = 128  # byte, before the first variable
_LITTLE = b"IM"  # the last two of them
_COMPRESSED = 15
_AT_ONCE = 1 << 18  # byte


def refuse_large_variables(path: Path) -> None:
    """Look at every variable of the file at `path`.

    Raises
    ------
    Refusal
        where one is larger than may be unpacked at once
    EOFError
        where the file is cut off
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        end = "<" if file.read(_HEADER)[-2:] == _LITTLE else ">"
        place, number = _HEADER, 1
        while place < size:
            file.seek(place)
            tag = file.read(8)
            if len(tag) < 8:
                raise EOFError("the file ends inside the head of a variable")
            kind, length = struct.unpack(f"{end}II", tag)
            place += 8 + length
            if place > size:
                raise EOFError(f"variable {number} ends at byte {place}, the file at {size}")
            unpacked = _unpacked(file, length) if kind == _COMPRESSED else length
            refuse_piece(path, f"variable {number}", unpacked)
            number += 1


def _unpacked(file: BinaryIO, length: int) -> int:
    """How many bytes the next `length` ones unpack to; counting ends where it is too many."""
    unpacking = zlib.decompressobj()
    unpacked = 0
    while length and not unpacking.eof and unpacked <= LARGEST_PIECE:
        rest = file.read(min(length, _AT_ONCE))
        length -= len(rest)
        while rest and unpacked <= LARGEST_PIECE:
            unpacked += len(unpacking.decompress(rest, _AT_ONCE))
            rest = unpacking.unconsumed_tail
    return unpacked

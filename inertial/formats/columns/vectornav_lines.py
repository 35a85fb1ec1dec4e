"""Messages of a VectorNav sensor in ASCII, such as $VNIMU,…*65, each with its checksum.

After the * stand two digits, the exclusive or of the characters between $ and *, or four digits,
their CRC-16 (polynomial 0x1021, from 0). Source: VectorNav, VN-100 user manual, "checksum / CRC"
and "IMU measurements" (register 54).
"""

import binascii
from collections.abc import Mapping
from dataclasses import replace
from functools import reduce
from operator import xor
from typing import Any

import numpy as np

from inertial.arrays import Booleans
from inertial.formats.account import OTHER_MESSAGE, REFUSED, Account, quoted
from inertial.formats.columns.text_lines import Chunk, RowLines
from inertial.text.messages import _

MESSAGE = "VNIMU"  # the only one with readings that were not compensated by the sensor
COLUMNS = {
    "kind": "columns",
    "message": MESSAGE,
    "delimiter": ",",
    # The first field is the name; the magnetometer, gauss, comes second, the pressure, kPa, last.
    "accelerometer": {"columns": [5, 6, 7], "unit": "m/s2"},
    "gyro": {"columns": [8, 9, 10], "unit": "rad/s"},
    "temperature": {"column": 11, "unit": "degC"},
}
_DIGIT = np.full(256, -1)
for _value in range(16):
    _DIGIT[[ord(f"{_value:x}"), ord(f"{_value:X}")]] = _value


def layout_of(stated: Mapping[str, Any]) -> dict[str, Any]:
    """The columns of the message that is read; what the campaign states of them counts."""
    return {**COLUMNS, **stated, "kind": "columns"}


class MessageLines:
    """Keeps the lines of one message whose checksum is right.

    Other messages are counted by name. What is damaged is refused; where it was once a message of
    this name its record is lost.
    """

    names = b""

    def __init__(self, layout: Mapping[str, Any]) -> None:
        self._name = str(layout["message"]).encode()

    def rows_of(self, chunk: Chunk) -> RowLines:
        """The lines of the next chunk that are rows, the checksum their last field."""
        intact = _intact(chunk)
        rows = intact & chunk.begin_with(b"$" + self._name + b",")
        account, refused = Account(), []
        lost = np.zeros(len(chunk), np.int64)
        for index in np.flatnonzero(~rows).tolist():
            text, length = chunk.text(index), int(chunk.lengths[index])
            if not text.strip():
                rows[index] = True  # a blank line, and no row
            elif intact[index]:
                name = quoted(text[1:].partition(b",")[0])
                account.add(OTHER_MESSAGE, name, 1, length)
            else:
                lost[index] = self._name in text
                refused.append(chunk.refused(index, _why_damaged(text)))
                account.add(REFUSED, "", 1, length)
        kept = chunk.part(rows)
        kept = replace(kept, data=kept.data.replace(b"*", b","))
        return RowLines(kept, account, refused, np.cumsum(lost)[rows], int(lost.sum()))


def _intact(chunk: Chunk) -> Booleans:
    """Which lines are messages with a right checksum, (n,)."""
    characters = np.frombuffer(chunk.data, np.uint8)
    starts, ends = chunk.starts, chunk.ends
    intact = np.zeros(len(chunk), bool)
    begun = characters[starts] == ord("$")

    def with_digits(count: int) -> list[int]:
        star = characters[np.maximum(ends - 1 - count, 0)] == ord("*")
        return np.flatnonzero(begun & star & (ends - starts > 2 + count)).tolist()

    if short := with_digits(2):
        edges = np.column_stack([starts[short] + 1, ends[short] - 3]).ravel()
        computed = np.bitwise_xor.reduceat(characters, edges)[::2]
        high, low = (_DIGIT[characters[ends[short] - place]] for place in (2, 1))
        intact[short] = (computed == 16 * high + low) & (low >= 0) & (high >= 0)
    for index in with_digits(4):
        body, __, stated = chunk.text(index)[1:].rpartition(b"*")
        intact[index] |= _checksum(body, 4) == stated.upper()
    return intact


def _checksum(body: bytes, digits: int) -> bytes:
    """The checksum of what stands between $ and *, in 2 or 4 digits."""
    value = binascii.crc_hqx(body, 0) if digits == 4 else reduce(xor, body, 0)
    return b"%0*X" % (digits, value)


def _why_damaged(text: bytes) -> str:
    """Why a line is no message with a right checksum."""
    body, star, stated = text.rpartition(b"*")
    if not text.startswith(b"$"):
        return _("no message, expected '$' at the beginning")
    if not star or len(stated) not in (2, 4):
        return _("no checksum, expected '*' and 2 or 4 hexadecimal digits at the end")
    return _(
        "checksum '{stated}', computed '{computed}'",
        stated=quoted(stated),
        computed=_checksum(body[1:], len(stated)).decode(),
    )

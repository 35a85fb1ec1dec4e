"""How many bytes a message of an Arrow stream says it unpacks to.

The library unpacks a buffer into as many bytes as the buffer's own beginning claims. So these are
summed up before it is asked to. They stand behind a FlatBuffer, whose fields are found by way of a
table of places; a field that is left out has place 0.

Source: https://github.com/apache/arrow/blob/main/format/Message.fbs
        https://flatbuffers.dev/internals/
"""

import struct

from pyarrow import ipc

_KIND, _HEADER = 1, 2  # fields of a message: what its header is, and the header
_DICTIONARY, _BATCH = 2, 3  # kinds of a header
_DATA = 1  # field of a dictionary: its batch
_BUFFERS, _COMPRESSION = 2, 3  # fields of a batch
_BUFFER_BYTES = 16  # its place in the body and its length
_AS_IT_IS = -1  # a buffer may say that it is not compressed after all


def claimed_bytes(message: ipc.Message) -> int:
    """What the buffers of `message`, unpacked, are said to have, byte."""
    stored = len(message.body) if message.body is not None else 0
    data = message.metadata.to_pybytes()
    root = _at("<I", data, 0)
    kind = _field(data, root, _KIND)
    batch = _table(data, root, _HEADER)
    header = data[kind] if kind else 0
    if header == _DICTIONARY and batch:
        batch = _table(data, batch, _DATA)
    if header not in (_DICTIONARY, _BATCH) or not batch or not _field(data, batch, _COMPRESSION):
        return stored  # what is not compressed is as large as it is
    buffers = _table(data, batch, _BUFFERS)
    claimed = 0
    for number in range(_at("<I", data, buffers) if buffers else 0):
        place, length = struct.unpack_from("<qq", data, buffers + 4 + _BUFFER_BYTES * number)
        if length:
            size = _at("<q", message.body, place)
            claimed += length if size == _AS_IT_IS else size
    return claimed


def _at(form: str, data: bytes, place: int) -> int:
    """The integer of this form at byte `place`."""
    number: int = struct.unpack_from(form, data, place)[0]
    return number


def _field(data: bytes, table: int, number: int) -> int:
    """The byte where a field of the table stands; 0 where it is left out."""
    places = table - _at("<i", data, table)
    if _at("<H", data, places) < 4 + 2 * (number + 1):
        return 0
    place = _at("<H", data, places + 4 + 2 * number)
    return table + place if place else 0


def _table(data: bytes, table: int, number: int) -> int:
    """The byte where the table or list begins that a field points at; 0 where it is left out."""
    place = _field(data, table, number)
    return place + _at("<I", data, place) if place else 0

"""Damage of every kind costs what is damaged: no byte is lost, and no number is wrong."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from inertial.formats.novatel.kernel import MAX_LINE_BYTES
from inertial.formats.novatel.message_errors import checksum
from inertial.formats.novatel.novatel_reader import read
from laboratory.rawimu import MESSAGES, Samples, log_bytes

N = 12
STAMPS = 1_380_801_099_879_998_762 + 10_000_000 * np.arange(N)
COUNTS = np.random.default_rng(2).integers(-70_000, 70_000, (2, N, 3))
SENT = Samples(STAMPS, *COUNTS)
BETWEEN = b"#TIMEA,COM1;VALID*00000000\r\n"  # its checksum is wrong


def parts(message: str) -> list[bytes]:
    """The messages one by one."""
    return [
        log_bytes(
            Samples(STAMPS[k : k + 1], COUNTS[0, k : k + 1], COUNTS[1, k : k + 1]),
            message,
            "00000077",
        )
        for k in range(N)
    ]


PARTS = {message: parts(message) for message in MESSAGES}
KNOWN = {
    (int(stamp), *row): message
    for message in MESSAGES
    for stamp, row in zip(STAMPS.tolist(), SENT.sent.tolist(), strict=True)
}

PLACE = st.integers(0, 2000)
DAMAGE = st.one_of(
    st.tuples(st.just("cut off"), PLACE, st.just(b"")),
    st.tuples(st.just("take out"), PLACE, st.integers(1, 200)),
    st.tuples(st.just("put in"), PLACE, st.binary(max_size=60)),
    st.tuples(st.just("put in"), PLACE, st.integers(1, 300).map(bytes)),
    st.tuples(
        st.just("put in"), PLACE, st.sampled_from([b"\xaaD\x12", b"\xaaD\x13\xff", b"%", b"*"])
    ),
    st.tuples(st.just("flip"), PLACE, st.integers(0, 7)),
    st.tuples(st.just("double"), PLACE, st.integers(1, 400)),
    st.tuples(st.just("exchange"), PLACE, st.integers(1, 400)),
    st.tuples(
        st.just("line ends"), st.just(0), st.sampled_from([b"\n", b"\r", b"", b"\n\r", b"\r\r\n"])
    ),
)


def spoiled(content: bytes, how: str, place: int, what: object) -> bytes:
    place = min(place, len(content))
    if how == "cut off":
        return content[:place]
    if how == "put in":
        return content[:place] + what + content[place:]
    if how == "take out":
        return content[:place] + content[place + what :]
    if how == "double":
        return content[: place + what] + content[place:]
    if how == "exchange":
        one, other = content[place : place + what], content[place + what : place + 2 * what]
        return content[:place] + other + one + content[place + 2 * what :]
    if how == "line ends":
        return content.replace(b"\r\n", what)
    flipped = bytearray(content)
    if place < len(flipped):
        flipped[place] ^= 1 << what
    return bytes(flipped)


def everything(path: Path, content: bytes, size: int):
    path.write_bytes(content)
    readings = list(read(path, size))
    assert sum(length for one in readings for *_, length in one.account) == len(content)
    refused = [line for one in readings for line in one.refused]
    kinds = [
        (lines, length)
        for one in readings
        for kind, _, lines, length in one.account
        if kind == "refused"
    ]
    assert sum(lines for lines, _ in kinds) == len(refused)
    assert sum(length for _, length in kinds) == sum(line.bytes for line in refused)
    whole = [one.records for one in readings]
    shapes = {"counts": (0, 6)}
    names = ("record", "offset", "line", "stamp", "status", "counts")
    records = [
        np.concatenate(
            [np.zeros(shapes.get(name, 0), np.int64), *(getattr(one, name) for one in whole)]
        )
        for name in names
    ]
    return records, refused


@pytest.mark.parametrize("message", MESSAGES)
@example(  # the checksum of a whole message lies behind what a false header claims
    damages=[("take out", 157, 140), ("put in", 36, b"\xaaD\x13\xff")], size=50, mixed=False
)
@example(  # the next message begins with the last bytes of what was read
    damages=[("take out", 340, 113), ("exchange", 0, 242)], size=50, mixed=False
)
@given(
    damages=st.lists(DAMAGE, max_size=4),
    size=st.sampled_from([50, 333, 1 << 22]),
    mixed=st.booleans(),
)
@settings(max_examples=60)
def test_every_byte_is_accounted_for_and_every_whole_message_is_read(
    tmp_path_factory, message, damages, size, mixed
):
    own = PARTS[message]
    content = (BETWEEN if mixed else b"").join(own)
    for damage in damages:
        content = spoiled(content, *damage)
    path = tmp_path_factory.getbasetemp() / "log"
    (record, offset, line, stamp, status, counts), refused = everything(path, content, size)

    # what is decoded stands there as it was sent
    texts = [part.rstrip(b"\r\n") if message.endswith("A") else part for part in own]
    by_number = {tuple(row): text for row, text in zip(SENT.sent.tolist(), texts, strict=True)}
    for place, row in zip(offset.tolist(), counts.tolist(), strict=True):
        assert content.startswith(by_number[tuple(row)], place)
    assert set(stamp.tolist()) <= set(STAMPS.tolist())
    assert set(status.tolist()) <= {0x77}
    # and what stands there whole is decoded
    assert len(stamp) == sum(content.count(text) for text in texts)
    assert (np.diff(record) > 0).all()
    assert (np.diff(line) > 0).all()
    # in whatever pieces it is read
    again, refused_again = everything(path, content, 1 << 22)
    np.testing.assert_array_equal(again[1], offset)
    assert [(one.offset, one.bytes) for one in refused_again] == [
        (one.offset, one.bytes) for one in refused
    ]


LENGTHS = (500_000, MAX_LINE_BYTES + 1, 3 * MAX_LINE_BYTES)
# Each of many beginnings of a message is refused by itself, which takes time: of one length only.
LONG = pytest.param(b"\xaaD\x13", MAX_LINE_BYTES + 1, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    ("fill", "length"),
    [*product([b"\x00", b"x", b"%", b"\xaa"], LENGTHS), LONG],
)
def test_half_a_megabyte_and_more_without_a_line_end(tmp_path, fill, length):
    first, second = PARTS["RAWIMUSA"][:2]
    junk = fill * (length // len(fill))
    content = first + junk + b"\n" + second
    (record, offset, *_), refused = everything(tmp_path / "log", content, 1 << 18)
    assert list(offset) == [0, len(content) - len(second)]
    assert list(record) == [0, 1]
    if fill != b"\xaaD\x13":  # else each may be the beginning of a message
        assert [(one.offset, one.bytes) for one in refused] == [(len(first), len(junk) + 1)]


@pytest.mark.parametrize("size", [50, 1 << 22])
def test_a_message_without_fields_is_refused_before_the_first_whole_one_too(tmp_path, size):
    damaged = b"#RAWIMUXA,COM1,0,68.5,FINESTEERING,2283,42699.890"
    damaged += b"*%08x\r\n" % checksum(damaged[1:])
    whole = PARTS["RAWIMUXA"][0]
    (record, offset, *_), refused = everything(tmp_path / "log", damaged + whole, size)
    assert [(one.line, one.bytes) for one in refused] == [(1, len(damaged))]
    assert (list(record), list(offset)) == ([1], [len(damaged)])


def test_a_message_behind_a_megabyte_of_zeros_in_its_line_is_read(tmp_path):
    first, second = PARTS["RAWIMUSA"][:2]
    content = first + bytes(2 * MAX_LINE_BYTES) + second
    (_, offset, *_), refused = everything(tmp_path / "log", content, 1 << 18)
    assert list(offset) == [0, len(content) - len(second)]
    assert [one.bytes for one in refused] == [2 * MAX_LINE_BYTES]
    assert refused[0].reason.endswith("bytes without a line end, expected at most 1048576")


@pytest.mark.parametrize(
    "content", [b"", b"\n", b"%", b"\xaa", b"\xaaD", b"*", b"\r", b"%*00000000"]
)
def test_next_to_nothing_is_no_crash(tmp_path, content):
    (record, *_), _ = everything(tmp_path / "log", content, 1 << 18)
    assert not len(record)

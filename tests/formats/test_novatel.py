"""RAWIMUSA lines: nothing is used that is not as it was sent, and nothing else is lost."""

import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from inertial.formats.account import Account
from inertial.formats.novatel.imu_messages import find_items
from inertial.formats.novatel.kernel import IMU, SHORT, UNPARSED
from inertial.formats.novatel.message_errors import Fields, checksum, fields_of
from inertial.formats.novatel.novatel_reader import read

# Lines 2192 and 2193 of the z counter-clockwise log of the Wuhan report, as printed there.
S0 = (
    b"%RAWIMUSA,2283,42699.880;2283,42699.879998762,00000077,64188,-64,465,-16100,-2,873*3928684b",
    b"%RAWIMUSA,2283,42711.860;2283,42711.859998756,00000077,64186,-1,432,-16100,4,-1037*b6a6925a",
)
EXTENDED = b"RAWIMUSXA,1692,484620.664;00,11,1692,484620.664389000,00801503,1,2,3,4,5,6"
HEXADECIMAL = b"0123456789abcdef"


def signed(text: bytes, first: bytes = b"%") -> bytes:
    """The line that a receiver sends of `text`."""
    return b"%b%b*%08x" % (first, text, checksum(text))


def imu_line(number: int, status: str = "00000077") -> bytes:
    seconds = 42699.879998762 + number / 100
    counts = b"%d,%d,465,-16100,-2,873" % (64188 + number, -number)
    return signed(
        b"RAWIMUSA,2283,%.3f;2283,%.9f,%b,%b" % (seconds, seconds, status.encode(), counts)
    )


@pytest.fixture
def log(tmp_path: Path):
    def write(content: bytes) -> Path:
        path = tmp_path / "log.asc"
        path.write_bytes(content)
        return path

    return write


def everything(path: Path, size: int = 1 << 22):
    """Records as tuples, refused lines, account."""
    records, refused = [], []
    account = Account()
    for reading in read(path, size):
        found = reading.records
        records += zip(
            found.record.tolist(),
            found.offset.tolist(),
            found.line.tolist(),
            found.stamp.tolist(),
            found.status.tolist(),
            map(tuple, found.counts.tolist()),
            strict=True,
        )
        refused += reading.refused
        account.add_account(reading.account)
    return records, refused, {(kind, name): (n, size) for kind, name, n, size in account}


# ---- the checksum


def crc32_bit_by_bit(text: bytes) -> int:
    """As NovAtel's manual prints it in C, "32-Bit CRC"."""
    crc = 0
    for character in text:
        value = (crc ^ character) & 0xFF
        for _ in range(8):
            value = (value >> 1) ^ (0xEDB88320 if value & 1 else 0)
        crc = (crc >> 8) ^ value
    return crc


@given(st.binary(max_size=100))
def test_the_checksum_is_that_of_the_manual(text):
    assert checksum(text) == crc32_bit_by_bit(text)


@pytest.mark.parametrize(("line", "stated"), [(S0[0], 0x3928684B), (S0[1], 0xB6A6925A)])
def test_the_printed_lines_carry_their_checksum(line, stated):  # T1
    assert checksum(line[1:].partition(b"*")[0]) == stated
    assert zlib.crc32(line[1:].partition(b"*")[0]) != stated  # the common CRC-32 is another one


# ---- what the lines say


def test_the_printed_lines_are_read_to_the_nanosecond(log):
    records, refused, account = everything(log(b"\r\n".join(S0)))
    week = 2283 * 604_800 * 10**9
    assert records == [
        (0, 0, 1, week + 42699879998762, 0x77, (64188, -64, 465, -16100, -2, 873)),
        (1, len(S0[0]) + 2, 2, week + 42711859998756, 0x77, (64186, -1, 432, -16100, 4, -1037)),
    ]
    assert not refused
    assert account == {("decoded", "RAWIMUSA"): (2, len(S0[0]) + 2 + len(S0[1]))}


@pytest.mark.parametrize("size", [1, 100, 1000, 1 << 22])
def test_line_ends_and_pieces_do_not_change_the_numbers(log, size):
    lines = [imu_line(number) for number in range(40)]
    mixed = b"".join(line + (b"\n", b"\r\n")[number % 2] for number, line in enumerate(lines))
    expected = [(record, *rest) for record, _, *rest in everything(log(b"\n".join(lines)))[0]]
    assert len(expected) == 40
    for content in (b"\n".join(lines) + b"\n", b"\r\n".join(lines), mixed, mixed + b"\r"):
        records, refused, account = everything(log(content), size)
        assert [(record, *rest) for record, _, *rest in records] == expected
        assert [content[offset : offset + 9] for _, offset, *_ in records] == [b"%RAWIMUSA"] * 40
        assert not refused
        assert sum(size for _, size in account.values()) == len(content)


@given(number=st.integers(0, 8), bit=st.integers(0, 8 * 95), size=st.sampled_from([200, 1 << 22]))
@settings(max_examples=300)
def test_one_flipped_bit_refuses_its_line_and_moves_nothing(tmp_path_factory, number, bit, size):
    lines = [imu_line(count) for count in range(9)]
    whole = tmp_path_factory.mktemp("bits") / "log.asc"
    whole.write_bytes(b"\n".join(lines))
    before, _, _ = everything(whole, size)

    damaged = bytearray(lines[number])
    byte = bit // 8 % len(damaged)
    damaged[byte] ^= 1 << bit % 8
    if damaged[byte] == ord("\n"):
        return  # that makes two lines of one; see the test of damage
    lines[number] = bytes(damaged)
    whole.write_bytes(b"\n".join(lines))
    after, refused, _ = everything(whole, size)

    assert [line.line for line in refused] == [number + 1]
    assert refused[0].bytes == len(damaged) + (number < 8)
    rest = before[:number] + before[number + 1 :]
    if byte < len(b"%RAWIMUSA"):  # no longer known as one of the records
        assert [record[1:] for record in after] == [record[1:] for record in rest]
    else:
        assert after == rest


def test_every_digit_of_the_checksum_counts(log):
    line = imu_line(0)
    for place in range(len(line) - 8, len(line)):
        for digit in set(HEXADECIMAL) - {line[place]}:
            changed = line[:place] + bytes([digit]) + line[place + 1 :]
            records, refused, _ = everything(log(changed))
            assert not records
            assert refused[0].reason == (
                f"checksum '{changed[-8:].decode()}', computed '{line[-8:].decode()}'"
            )


WILD = st.one_of(
    st.integers(-(10**22), 10**22).map(str),
    st.floats(-1, 1e20).map("{:.9f}".format),
    st.text("0123456789-+. e_abcdefABCDEFg", max_size=12),
)


@settings(max_examples=500)
@given(place=st.integers(0, 9), wild=WILD)
def test_what_the_loop_reads_of_a_line_is_what_a_second_look_reads(place, wild):
    """The second look is Python's own, field by field; the loop may leave a line to it."""
    fields = ["2283", "42699.879998762", "00000077", "64188", "-64", "465", "-16100", "-2", "873"]
    fields[place : place + 1] = [wild]
    line = signed(f"RAWIMUSA,2283,42699.880;{','.join(fields)}".encode())
    found = find_items(np.frombuffer(line + b"\r\n", np.uint8), 0, last=True)
    if found.kind[0] == IMU:
        parts = (found.stamp, found.status, found.counts, found.imu_type)
        stamp, status, counts, imu = (part[0] for part in parts)
        assert fields_of(line, SHORT) == Fields(stamp, status, counts.tolist(), imu)
    else:
        assert found.kind[0] == UNPARSED


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (b"RAWIMUSA,2283,1.0;22x3,1.0,00000077,1,2,3,4,5,6", "week is '22x3', expected a whole"),
        (b"RAWIMUSA,2283,1.0;2283,nan,00000077,1,2,3,4,5,6", "seconds is 'nan', expected a num"),
        (b"RAWIMUSA,2283,1.0;2283,-1.0,00000077,1,2,3,4,5,6", "seconds is '-1.0', expected a n"),
        (b"RAWIMUSA,2283,1.0;2283,604800,00000077,1,2,3,4,5,6", "seconds is 604800, expected t"),
        (b"RAWIMUSA,2283,1.0;2283,,00000077,1,2,3,4,5,6", "seconds is '', expected a number"),
        (b"RAWIMUSA,2283,1.0;2283,-.5,00000077,1,2,3,4,5,6", "seconds is '-.5', expected a num"),
        (b"RAWIMUSA,2283,1.0;2283,1.0,00000077,1_0,2,3,4,5,6", "accelerometer 1 is '1_0', expec"),
        # more nanoseconds than 64 bits hold
        (b"RAWIMUSA,2283,1.0;2283,9300000000.0,00000077,1,2,3,4,5,6", "seconds is '9300000000"),
        (b"RAWIMUSA,2283,1.0;2283,18446744073709594315.8,00000077,1,2,3,4,5,6", "seconds is '184"),
        (b"RAWIMUSA,2283,1.0;2283,1.0,0000g077,1,2,3,4,5,6", "status is '0000g077', expected u"),
        (b"RAWIMUSA,2283,1.0;2283,1.0,00000077,1,2,3,4,5", "8 fields behind the ';', expected 9"),
        (b"RAWIMUSA,2283,1.0;2283,1.0,00000077,1,2,3,4,5,6,7", "10 fields behind the ';'"),
        (b"RAWIMUSA,2283,1.0;2283,1.0,00000077,1,2,3,4,5,", "gyro 3 is '', expected a whole nu"),
        (b"RAWIMUSA,2283,1.0;2283,1.0,00000077,1,2,3,4,5,3000000000", "gyro 3 is '3000000000'"),
        (b"RAWIMUSA,2283,1.0;2283,1.0,00000077,1,2\r,3,4,5,", "gyro 3 is ''"),
        # a field too few before the ';' and one too many behind: none takes another's place
        (b"RAWIMUSA,2283;1.0,2283,1.0,00000077,1,2,3,4,5,6", "2 fields before the ';', expected 3"),
        (b"RAWIMUSA,", "2 fields before the ';', expected 3"),
    ],
)
def test_a_right_checksum_over_wrong_fields_costs_that_line_only(log, text, reason):
    content = b"\n".join([*(imu_line(n) for n in range(3)), signed(text), imu_line(4)])
    records, refused, _ = everything(log(content))
    assert [record for record, *_ in records] == [0, 1, 2, 4]
    assert [counts[0] for *_, counts in records] == [64188, 64189, 64190, 64192]
    assert len(refused) == 1
    assert refused[0].reason.startswith(f"right checksum, but {reason}")


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        (b"[COM1]<OK", "begins with '[', expected '%', '#' or a binary message's AA 44"),
        (S0[0][:40], "no checksum, expected '*' and 8 hexadecimal digits at the end"),
        (S0[0][:-1], "checksum '3928684', computed '3928684b'"),
    ],
)
def test_a_refused_line_says_why(log, line, reason):
    records, refused, _ = everything(log(b"\n".join([S0[0], line, S0[1]])))
    assert len(records) == 2
    assert refused[0].reason.startswith(reason)
    assert refused[0].line == 2
    assert refused[0].offset == len(S0[0]) + 1


def test_other_messages_and_blank_lines_are_told_apart(log):
    lines = [S0[0], signed(EXTENDED), b"", b" \t", signed(b"BESTPOSA,COM1;1", b"#"), S0[1]]
    records, refused, account = everything(log(b"\n".join(lines)))
    assert [(record, line) for record, _, line, *_ in records] == [(0, 1), (1, 6)]
    assert not refused
    assert account == {
        ("decoded", "RAWIMUSA"): (2, len(S0[0]) + 1 + len(S0[1])),
        ("other message", "RAWIMUSXA"): (1, len(signed(EXTENDED)) + 1),
        ("other message", "BESTPOSA"): (1, len(lines[4]) + 1),
        ("blank", ""): (2, 4),
    }


def test_the_status_word_may_change_from_line_to_line(log):
    words = [f"{number * 0x01010101:08x}" for number in range(200)]
    records, _, _ = everything(log(b"\n".join(imu_line(n, word) for n, word in enumerate(words))))
    assert [status for *_, status, _ in records] == [int(word, 16) for word in words]


def test_a_line_without_end_is_refused_as_too_long(log):
    content = S0[0] + b"\n" + bytes(9 << 20) + b"\n" + S0[1]
    records, refused, account = everything(log(content))
    assert [record for record, *_ in records] == [0, 1]
    assert refused[0].reason.endswith("bytes without a line end, expected at most 1048576")
    assert account["refused", ""] == (1, (9 << 20) + 1)


# ---- whole messages among damage


@pytest.mark.parametrize(
    "junk", [b"\x00", b"<OK\r", bytes(300), S0[0][:40], b"%#*", b"\xaa\x44\x12"]
)
def test_a_whole_message_behind_junk_in_its_line_is_used(log, junk):
    content = b"\n".join([S0[0], junk + S0[1], S0[0]])
    records, refused, account = everything(log(content))
    assert [offset for _, offset, *_ in records] == [
        0,
        len(S0[0]) + 1 + len(junk),
        len(content) - len(S0[0]),
    ]
    assert [(line.offset, line.bytes) for line in refused] == [(len(S0[0]) + 1, len(junk))]
    assert sum(size for _, size in account.values()) == len(content)


def test_two_messages_in_one_line_are_two(log):
    records, refused, _ = everything(log(S0[0] + S0[1] + b"\n" + S0[0]))
    assert [counts[1] for *_, counts in records] == [-64, -1, -64]
    assert not refused


def test_an_empty_log_has_nothing(log):
    assert everything(log(b"")) == ([], [], {})


# ---- real logs


def test_six_quoted_lines_of_the_family(recordings):
    path = recordings / "novatel_samples" / "rawimu_lines.txt"
    records, refused, account = everything(path)
    assert [counts[0] for *_, counts in records] == [43110635, -327350056, 32068]
    assert [line.line for line in refused] == [4, 5]
    assert {key: lines for key, (lines, _) in account.items()} == {
        ("decoded", "RAWIMUSXA"): 3,
        ("other message", "RAWIMUXA"): 1,
        ("refused", ""): 2,
    }
    assert sum(size for _, size in account.values()) == path.stat().st_size


def test_all_lines_of_the_real_turntable_are_whole(recordings):
    logs = sorted((recordings / "whu_xwgi7681_excerpt").glob("*.ASC"))
    found = [everything(path) for path in logs]
    assert sum(len(records) for records, _, _ in found) == 412
    assert not any(refused for _, refused, _ in found)
    for records, _, _ in found:
        steps = np.diff([stamp for _, _, _, stamp, *_ in records])
        assert (np.abs(steps - 10_000_000) < 2).all()  # 100 Hz, ns, across whole seconds too

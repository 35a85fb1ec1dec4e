"""The eight messages of the IMU, text and binary: what was sent is read, whatever is among it."""

import struct
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from inertial.formats.novatel.imu_messages import find_items
from inertial.formats.novatel.kernel import IMU, UNPARSED
from inertial.formats.novatel.message_errors import checksum
from inertial.formats.novatel.novatel_reader import read
from laboratory.rawimu import MESSAGES, Samples, log_bytes

WEEK = 604_800 * 10**9  # ns
START = 2283 * WEEK + 42_699_879_998_762
STEP = 5_000_000
KVH = 33  # the KVH 1750 in NovAtel's list


def samples(n: int, start: int = START, step: int = STEP) -> Samples:
    random = np.random.default_rng(1)
    counts = random.integers(-(2**31), 2**31, (2, n, 3), endpoint=False)
    return Samples(start + step * np.arange(n), *counts)


def decoded(content: bytes, folder: Path, size: int = 1 << 22):
    """All records' arrays, the refused lines, the account; every byte is accounted for."""
    path = folder / "log"
    path.write_bytes(content)
    readings = list(read(path, size))
    account = {}
    for reading in readings:
        for kind, name, lines, length in reading.account:
            old = account.get((kind, name), (0, 0))
            account[kind, name] = (old[0] + lines, old[1] + length)
    assert sum(length for _, length in account.values()) == len(content)
    fields = ("record", "offset", "line", "stamp", "status", "counts", "imu")
    records = {
        name: np.concatenate([getattr(reading.records, name) for reading in readings])
        for name in fields
    }
    return records, [line for reading in readings for line in reading.refused], account


def binary(number: int, body: bytes) -> bytes:
    """A binary message with the short header."""
    text = bytes([0xAA, 0x44, 0x13, len(body)]) + struct.pack("<HHi", number, 2283, 0) + body
    return text + checksum(text).to_bytes(4, "little")


def signed(text: bytes, first: bytes) -> bytes:
    return b"%b%b*%08x\r\n" % (first, text, checksum(text))


BESTPOS = signed(b"BESTPOSA,COM1,0,78.5,FINESTEERING,2283,4.0,02000020,cdba,1;SOL,5", b"#")
OTHERS = (BESTPOS, binary(508, b"INSPVAS" * 12), b"\r\n", binary(507, b"%RAWIMUSA,\n\n" * 7))


@pytest.mark.parametrize("message", MESSAGES)
@pytest.mark.parametrize("size", [100, 1 << 22])
def test_what_the_laboratory_writes_is_read(message, size, tmp_path):
    sent = samples(300)
    content = log_bytes(sent, message, "00801503", imu_type=KVH)
    records, refused, account = decoded(content, tmp_path, size)
    np.testing.assert_array_equal(records["counts"], sent.sent)
    np.testing.assert_array_equal(records["stamp"], sent.stamps)
    assert set(records["status"]) == {0x00801503}
    assert set(records["imu"]) == {KVH if "X" in message else -1}
    np.testing.assert_array_equal(records["record"], np.arange(300))
    np.testing.assert_array_equal(records["line"], np.arange(1, 301))
    assert not refused
    assert account == {("decoded", message): (300, len(content))}


@pytest.mark.parametrize("message", MESSAGES)
def test_other_messages_stand_among_them(message, tmp_path):
    sent = samples(40)
    whole = log_bytes(sent, message, "00000077")
    length = [len(log_bytes(samples_of(sent, k), message, "00000077")) for k in range(40)]
    ends = np.cumsum([0, *length])
    parts = [whole[a:b] for a, b in pairwise(ends)]
    content = b"".join(part + OTHERS[k % 4] for k, part in enumerate(parts))
    records, refused, account = decoded(content, tmp_path, 1000)
    np.testing.assert_array_equal(records["counts"], sent.sent)
    assert [content[o : o + 2] for o in records["offset"]] == [whole[:2]] * 40
    np.testing.assert_array_equal(records["line"], 2 * np.arange(40) + 1)
    assert not refused
    assert account == {
        ("decoded", message): (40, len(whole)),
        ("other message", "BESTPOSA"): (10, 10 * len(OTHERS[0])),
        ("other message", "binary 508"): (10, 10 * len(OTHERS[1])),
        ("other message", "binary 507"): (10, 10 * len(OTHERS[3])),
        ("blank", ""): (10, 20),
    }


def samples_of(sent: Samples, k: int) -> Samples:
    return Samples(sent.stamps[k : k + 1], sent.accelerometer[k : k + 1], sent.gyro[k : k + 1])


def test_the_same_samples_as_two_messages_are_read_once(tmp_path):
    sent = samples(50)
    text, extended = (log_bytes(sent, m, "00000077") for m in ("RAWIMUSA", "RAWIMUSXB"))
    records, _, account = decoded(text + extended, tmp_path)
    assert len(records["stamp"]) == 50
    assert account["other message", "RAWIMUSXB"] == (50, len(extended))


def test_the_answer_to_a_command_is_no_record(tmp_path):
    one = bytearray(log_bytes(samples(1), "RAWIMUB", "00000077")[:-4])
    one[6] |= 0x80
    content = bytes(one) + checksum(bytes(one)).to_bytes(4, "little")
    records, refused, account = decoded(content, tmp_path)
    assert not len(records["stamp"])
    assert not refused
    assert account == {("other message", "binary 268"): (1, len(content))}


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        (bytes(39), "right checksum, but a body of 39 bytes, expected 40"),
        (
            struct.pack("<Id", 2283, float("nan")) + bytes(28),
            "right checksum, but week 2283, seconds nan, expected up to 9999 and from 0 to 604800",
        ),
        (
            struct.pack("<Id", 4_000_000_000, 1.0) + bytes(28),
            "right checksum, but week 4000000000, seconds 1.0, expected up to 9999 and from 0",
        ),
    ],
)
def test_a_binary_message_of_nonsense_says_why(body, reason, tmp_path):
    around = log_bytes(samples(2), "RAWIMUSB", "00000077")
    records, refused, _ = decoded(around[:56] + binary(325, body) + around[56:], tmp_path)
    assert list(records["record"]) == [0, 2]
    assert refused[0].reason.startswith(reason)
    assert (refused[0].line, refused[0].offset) == (2, 56)


@settings(max_examples=300)
@given(
    seconds=st.one_of(st.floats(), st.floats(0, 604_800)),
    week=st.integers(0, 12_000),
    counts=st.lists(st.integers(-(2**31), 2**31 - 1), min_size=6, max_size=6),
)
@example(seconds=5e-324, week=0, counts=[0] * 6)
@example(seconds=-0.0, week=9999, counts=[0] * 6)
@example(seconds=604_800.0, week=1, counts=[0] * 6)
@example(seconds=float("inf"), week=1, counts=[0] * 6)
def test_what_the_loop_reads_of_a_binary_message_is_what_was_packed(seconds, week, counts):
    sent = binary(325, struct.pack("<IdI6i", week, seconds, 0x77, *counts))
    found = find_items(np.frombuffer(sent, np.uint8), 0, last=True)
    good = week <= 9999 and 0 <= seconds < 604_800 and not str(seconds).startswith("-")
    assert found.kind.tolist() == [IMU if good else UNPARSED]
    if good:
        stamp, status, read_counts = found.stamp[0], found.status[0], found.counts[0]
        whole = int(seconds)
        assert stamp == week * WEEK + whole * 10**9 + round((seconds - whole) * 1e9)
        assert (status, read_counts.tolist()) == (0x77, counts)


def test_a_new_week_begins_inside_a_log(tmp_path):
    sent = samples(20, start=2284 * WEEK - 10 * STEP)
    for message in MESSAGES:
        records, _, _ = decoded(log_bytes(sent, message, "00000077"), tmp_path)
        assert set(np.diff(records["stamp"])) == {STEP}


@pytest.mark.parametrize("size", [300, 1 << 22])
def test_weeks_in_ten_bits_go_on_after_the_last(tmp_path, size):
    before = samples(10, start=1024 * WEEK - 10 * STEP)
    after = samples(10, start=0)
    content = b"".join(log_bytes(one, "RAWIMUSA", "00000077") for one in (before, after))
    records, _, _ = decoded(content, tmp_path, size)
    assert set(np.diff(records["stamp"])) == {STEP}


# ---- real bytes


def test_text_and_binary_of_the_same_epoch_say_the_same(recordings, tmp_path):
    folder = recordings / "novatel_samples"
    lines = (folder / "rawimu_lines.txt").read_bytes().splitlines(keepends=True)
    text, _, _ = decoded(lines[0], tmp_path)
    sent, refused, account = decoded((folder / "rawimusx_short.bin").read_bytes(), tmp_path)
    assert not refused
    assert account == {("decoded", "RAWIMUSXB"): (1, 56)}
    for name in ("stamp", "status", "counts", "imu"):
        np.testing.assert_array_equal(text[name], sent[name])
    assert sent["stamp"] == 1692 * WEEK + 484_620_664_389_000
    assert sent["imu"] == 11  # HG1700 AG58


@pytest.mark.parametrize(("name", "frames"), [("oem7_ins1.gps", 284), ("oem7_ins2.gps", 835)])
def test_every_frame_of_a_mixed_log_is_whole(recordings, tmp_path, name, frames):
    content = (recordings / "novatel_samples" / name).read_bytes()
    records, refused, account = decoded(content, tmp_path, 700)
    assert not len(records["stamp"])
    assert not refused
    assert sum(lines for lines, _ in account.values()) == frames

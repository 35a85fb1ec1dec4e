"""Containers that are cut off or flipped: refused by name, or fewer rows with an account."""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from inertial.formats.columns import column_reader as columns
from inertial.tables.errors import Refusal
from tests.formats import written

ROWS = 400


@cache
def whole(name: str) -> tuple[bytes, dict[str, object]]:
    """A log of this format, and its layout."""
    with TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        layout = written.WRITERS[name](log, written.rows(ROWS))
        return log.read_bytes(), layout


def rows_or_refusal(log: Path, content: bytes, layout: dict[str, object]) -> int | None:
    """How many rows are read, all of them accounted for; None where the log is refused."""
    log.write_bytes(content)
    try:
        readings = list(columns.read(log, layout))
    except Refusal as refusal:
        assert refusal.file == "log"
        return None
    entries = [entry for reading in readings for entry in reading.account]
    rows = sum(len(reading.records.record) for reading in readings)
    assert sum(size for *_, size in entries) == len(content)
    assert sum(lines for kind, _, lines, _ in entries if kind == "decoded") == rows
    lost = sum(len(reading.refused) for reading in readings)
    assert sum(lines for kind, _, lines, _ in entries if kind == "refused") == lost
    assert all(np.isfinite(reading.records.gyro).all() for reading in readings)
    return rows


@pytest.mark.parametrize("name", written.CONTAINERS)
@given(share=st.floats(0.01, 0.999))
@settings(max_examples=25)
def test_a_log_that_is_cut_off_is_refused_or_gives_what_there_is(tmp_path_factory, name, share):
    content, layout = whole(name)
    log = tmp_path_factory.getbasetemp() / "log"
    rows = rows_or_refusal(log, content[: int(len(content) * share)], layout)
    assert rows is None or rows <= ROWS


@pytest.mark.parametrize("name", written.CONTAINERS)
@given(
    flips=st.lists(st.tuples(st.floats(0, 0.9999), st.integers(1, 255)), min_size=1, max_size=4),
    ends=st.sampled_from(["anywhere", "head", "tail"]),
)
@settings(max_examples=40)
def test_flipped_bytes_never_end_in_anything_but_rows_or_a_refusal(
    tmp_path_factory, name, flips, ends
):
    content, layout = whole(name)
    flipped = bytearray(content)
    reach = len(content) if ends == "anywhere" else min(600, len(content))
    for share, bits in flips:
        place = int(share * reach)
        flipped[-1 - place if ends == "tail" else place] ^= bits
    log = tmp_path_factory.getbasetemp() / "log"
    rows_or_refusal(log, bytes(flipped), layout)


@pytest.mark.parametrize("name", ["ros 1", "mcap"])
def test_a_bag_that_was_never_closed_gives_its_messages_and_says_so(tmp_path, name):
    log = tmp_path / "log"
    layout = written.WRITERS[name](log, written.rows(8000))
    content = log.read_bytes()
    log.write_bytes(content[: len(content) * 2 // 3])
    readings = list(columns.read(log, layout))
    rows = sum(len(reading.records.record) for reading in readings)
    refused = [line for reading in readings for line in reading.refused]
    assert 1000 < rows < 8000
    assert [line.line for line in refused] == [rows + 1]
    assert refused[0].reason.startswith("the bag cannot be read any further: the record at byte")


def test_a_damaged_chunk_of_a_bag_costs_its_messages_alone(tmp_path):
    log = tmp_path / "log"
    layout = written.mcap(log, written.rows(8000))
    content = bytearray(log.read_bytes())
    middle = len(content) // 2
    content[middle : middle + 64] = bytes(64)
    log.write_bytes(content)
    readings = list(columns.read(log, layout))
    times = np.concatenate([reading.records.ticks for reading in readings])
    refused = [line for reading in readings for line in reading.refused]
    assert len(refused) == 1
    assert refused[0].reason.startswith("a chunk of messages is damaged")
    assert 4000 < len(times) < 8000
    assert (np.diff(times) > 0.0015).sum() <= 1  # one gap, or the beginning or the end is lost


def test_a_ulog_that_breaks_off_in_a_message_gives_what_there_is_and_says_where(tmp_path):
    """As where the power was cut."""
    log = tmp_path / "log"
    layout = written.ulog(log, written.rows(1000))
    content = log.read_bytes()[:-7]
    log.write_bytes(content)
    readings = list(columns.read(log, layout))
    assert sum(len(reading.records.record) for reading in readings) == 999
    refused = [line for reading in readings for line in reading.refused]
    last = len(content) + 7 - 69 + 3  # a message of 69 bytes, 3 of them its head
    assert [(line.line, line.reason) for line in refused] == [
        (1000, f"the log breaks off in the message at byte {last} of {len(content)}")
    ]

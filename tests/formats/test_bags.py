"""Bags of ROS: which topic is the IMU's, and nothing in a bag is believed but its numbers."""

import bz2
import sqlite3
import struct
import zlib
from contextlib import closing

import lz4.frame
import numpy as np
import pyarrow as pa
import pytest
from rosbags.rosbag1 import ReaderError
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag1.reader import Header
from rosbags.rosbag2 import ReaderError as McapError

from inertial.formats.columns import column_reader as columns
from inertial.formats.containers import mcap_bag, ros1_bag
from inertial.formats.containers.bags import Record
from inertial.tables.errors import Refusal
from tests.formats import written

BAGS = {"ros 1": written.ros_1, "ros 2": written.ros_2, "mcap": written.mcap}


@pytest.mark.parametrize("name", BAGS)
def test_of_several_topics_the_layout_says_which(tmp_path, name):
    log = tmp_path / "log"
    layout = BAGS[name](log, written.rows(20), topics=("/imu/left", "/imu/right"))
    with pytest.raises(Refusal) as refusal:
        list(columns.read(log, layout))
    assert refusal.value.place == "topic"
    assert refusal.value.found == "2 topics with sensor_msgs/msg/Imu"
    assert refusal.value.expected == "one of /imu/left, /imu/right"

    (reading,) = columns.read(log, layout | {"topic": "/imu/right"})
    assert len(reading.records.record) == 20
    assert list(reading.account) == [
        ("decoded", "", 20, log.stat().st_size),
        ("other message", "/chat", 2, 0),
        ("other message", "/imu/left", 20, 0),
    ]
    for other in ("/imu", "/chat"):
        with pytest.raises(Refusal, match=f"no topic '{other}' with sensor_msgs"):
            list(columns.read(log, layout | {"topic": other}))


@pytest.mark.parametrize("name", BAGS)
def test_without_a_topic_of_an_imu_the_others_are_listed(tmp_path, name):
    log = tmp_path / "log"
    layout = BAGS[name](log, written.rows(20), topics=())
    with pytest.raises(Refusal, match=r"one of /chat \(std_msgs/msg/String\)"):
        list(columns.read(log, layout))


@pytest.mark.parametrize("name", BAGS)
def test_time_may_be_that_of_receiving(tmp_path, name):
    log, values = tmp_path / "log", written.rows(20)
    layout = BAGS[name](log, values) | {"time": {"column": "received", "unit": "s"}}
    (reading,) = columns.read(log, layout)
    np.testing.assert_array_equal(reading.records.ticks, values[:, 0])


def test_a_definition_in_the_bag_that_is_not_that_of_ros_is_no_imu(tmp_path):
    log = tmp_path / "log"
    layout = written.ros_1(log, written.rows(20))
    definition = b"6a62c6daae103f4ff57a132d6f95cec2"
    content = log.read_bytes()
    assert definition in content
    log.write_bytes(content.replace(definition, definition[::-1]))
    with pytest.raises(Refusal, match=r"/imu \(sensor_msgs/msg/Imu of another definition\)"):
        list(columns.read(log, layout))


def test_a_message_that_is_none_costs_itself(tmp_path):
    log = tmp_path / "log"
    layout = written.ros_2(log, written.rows(20))
    with closing(sqlite3.connect(log)) as bag, bag:
        number = bag.execute("SELECT max(topic_id) FROM messages").fetchone()[0]
        ids = [row[0] for row in bag.execute(f"SELECT id FROM messages WHERE topic_id={number}")]
        bag.execute("UPDATE messages SET data = x'00010000ff' WHERE id = ?", (ids[3],))
    (reading,) = columns.read(log, layout)
    np.testing.assert_array_equal(reading.records.record, [n for n in range(20) if n != 3])
    assert [line.line for line in reading.refused] == [4]
    assert reading.refused[0].reason.startswith("no sensor_msgs/msg/Imu: Could not deserialize")


def test_a_view_that_never_ends_is_not_asked(tmp_path):
    log = tmp_path / "log"
    layout = written.ros_2(log, written.rows(20))
    with closing(sqlite3.connect(log)) as bag, bag:
        bag.execute("ALTER TABLE messages RENAME TO kept")
        bag.execute(
            "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 "
            "FROM n) SELECT id, 2 AS topic_id, id AS timestamp, x'00' AS data FROM n"
        )
    with pytest.raises(Refusal, match="without the tables messages and topics"):
        list(columns.read(log, layout))


def test_a_bag_of_ros_2_with_messages_in_its_journal_is_refused(tmp_path):
    log = tmp_path / "log"
    layout = written.ros_2(log, written.rows(20))
    with closing(sqlite3.connect(log)) as bag:
        bag.execute("PRAGMA journal_mode = WAL")
        bag.execute("DELETE FROM messages WHERE id > 10")
        bag.commit()
        with pytest.raises(Refusal, match="messages lie in log-wal"):
            list(columns.read(log, layout))
    assert sum(len(reading.records.record) for reading in columns.read(log, layout)) == 9


DATA = np.random.default_rng(1).bytes(3000) * 2


@pytest.mark.parametrize(
    ("compression", "chunk"),
    [("none", DATA), ("bz2", bz2.compress(DATA)), ("lz4", lz4.frame.compress(DATA))],
)
def test_a_chunk_of_ros_1_is_unpacked_to_its_size_and_to_no_other(compression, chunk):
    def unpacked(size: int, compression: str = compression) -> bytes:
        fields = Header(compression=compression.encode(), size=size.to_bytes(4, "little"))
        return ros1_bag.unpacked(Record(5, fields, chunk))

    assert unpacked(6000) == DATA
    for size in (5999, 6001):
        with pytest.raises(ReaderError, match=f"a chunk of 6000 bytes, expected {size}"):
            unpacked(size)
    with pytest.raises(ReaderError, match="compression 'xz', expected none, bz2, lz4"):
        unpacked(6000, "xz")


@pytest.mark.parametrize(
    ("compression", "chunk"),
    [
        ("", DATA),
        ("lz4", lz4.frame.compress(DATA)),
        ("zstd", pa.Codec("zstd").compress(DATA, asbytes=True)),
    ],
)
def test_a_chunk_of_mcap_is_unpacked_to_its_size_and_to_no_other(compression, chunk):
    def unpacked(size: int, compression: str = compression, checksum: int = 0) -> bytes:
        name = compression.encode()
        head = struct.pack("<QQQII", 0, 0, size, checksum, len(name)) + name
        return mcap_bag.unpacked(Record(6, None, head + struct.pack("<Q", len(chunk)) + chunk))

    assert unpacked(6000) == unpacked(6000, checksum=zlib.crc32(DATA)) == DATA
    for size in (5999, 6001):
        with pytest.raises(McapError, match=f"expected {size} bytes, got 6000"):
            unpacked(size)
    with pytest.raises(McapError, match="Unsupported chunk compression 'xz'"):
        unpacked(6000, "xz")
    with pytest.raises(McapError, match="checksum mismatch"):
        unpacked(6000, checksum=1)


@pytest.mark.parametrize("compression", ["none", "BZ2", "LZ4"])
def test_a_bag_of_ros_1_is_read_by_every_compression(tmp_path, monkeypatch, compression):
    log, values = tmp_path / "log", written.rows(20)
    plain = Writer1.set_compression
    if compression == "none":
        monkeypatch.setattr(Writer1, "set_compression", lambda *_: None)
    else:
        kind = Writer1.CompressionFormat[compression]
        monkeypatch.setattr(Writer1, "set_compression", lambda bag, _: plain(bag, kind))
    (reading,) = columns.read(log, written.ros_1(log, values))
    np.testing.assert_array_equal(reading.records.gyro, values[:, 1:4])

"""Logs that are no text: the same rows whatever they are written in, told by content alone."""

import json
import struct
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet
from scipy.io import savemat

from inertial.formats.account import Account
from inertial.formats.columns import column_reader as columns
from inertial.tables.errors import Refusal
from tests.formats import written


def everything(path, layout):
    """The rows of all pieces together, the refused lines, the account."""
    readings = list(columns.read(path, layout))
    account = Account()
    for reading in readings:
        account.add_account(reading.account)
    records = [reading.records for reading in readings]
    together = {
        name: np.concatenate([getattr(rows, name) for rows in records])
        for name in ("record", "offset", "line", "ticks", "accelerometer", "gyro")
    }
    together["label"] = [label for rows in records for label in rows.label or []]
    refused = [line for reading in readings for line in reading.refused]
    return together, refused, list(account)


@pytest.mark.parametrize("name", written.CONTAINERS)
def test_every_format_gives_the_rows_of_the_text(tmp_path, name):
    values = written.rows(1000)
    text, log = tmp_path / "text.csv", tmp_path / "log.csv"
    expected, *_ = everything(text, written.text(text, values))
    found, refused, account = everything(log, written.WRITERS[name](log, values))
    for key in ("record", "ticks", "accelerometer", "gyro", "label"):
        np.testing.assert_array_equal(found[key], expected[key])
    np.testing.assert_array_equal(found["gyro"], values[:, 1:4])
    np.testing.assert_array_equal(found["line"], np.arange(1, 1001))
    assert not found["offset"].any()
    assert not refused
    other = [("other message", "/chat", 100, 0)] if name in ("ros 1", "ros 2", "mcap") else []
    assert account == [("decoded", "", 1000, log.stat().st_size), *other]


@pytest.mark.parametrize("name", written.CONTAINERS)
def test_a_column_that_is_not_there_is_refused_with_those_that_are(tmp_path, name):
    log = tmp_path / "log"
    layout = written.WRITERS[name](log, written.rows(20))
    layout["time"] = {"column": "tim", "unit": "s"}
    with pytest.raises(Refusal) as refusal:
        everything(log, layout)
    assert refusal.value.place == "time.column"
    assert refusal.value.found == "no column 'tim'"
    there = refusal.value.expected.removeprefix("one of ").split(", ")
    assert set(layout["gyro"]["columns"]) <= set(there)
    layout["time"] = {"column": len(there) + 1, "unit": "s"}
    with pytest.raises(Refusal, match=f"no column '{len(there) + 1}'"):
        everything(log, layout)


@pytest.mark.parametrize("name", written.CONTAINERS)
def test_columns_go_by_number_as_well(tmp_path, name):
    log, values = tmp_path / "log", written.rows(20)
    layout = written.WRITERS[name](log, values)
    with pytest.raises(Refusal) as refusal:
        everything(log, layout | {"mean_of": "?"})
    there = refusal.value.expected.removeprefix("one of ").split(", ")
    numbers = [there.index(column) + 1 for column in layout["gyro"]["columns"]]
    found, *_ = everything(log, layout | {"gyro": {"columns": numbers, "unit": "rad/s"}})
    np.testing.assert_array_equal(found["gyro"], values[:, 1:4])


@pytest.mark.parametrize("name", ["parquet", "arrow stream", "matlab 5", "matlab 7.3", "mcap"])
def test_a_log_without_rows_has_no_records(tmp_path, name):
    log = tmp_path / "log"
    layout = written.WRITERS[name](log, written.rows(0))
    if name.startswith("matlab"):  # no samples have no longer side
        layout = {"kind": "columns"}
    readings = list(columns.read(log, layout))
    assert sum(len(reading.records.record) for reading in readings) == 0
    accounts = [entry for reading in readings for entry in reading.account]
    assert accounts == [("header", "", 0, log.stat().st_size)]


def test_a_row_without_a_finite_number_costs_itself_and_says_why(tmp_path):
    log = tmp_path / "log"
    numbers = {"a": [1.0, None, 3.0, float("inf"), 5.0], "b": ["1", "2", "3", "4", "5"]}
    parquet.write_table(pa.table(numbers), log)
    layout = {"kind": "columns", "time": {"rate_hz": 10}}
    found, refused, account = everything(
        log, layout | {"gyro": {"columns": ["a", "a", None], "unit": "g"}}
    )
    np.testing.assert_array_equal(found["record"], [0, 2, 4])
    np.testing.assert_array_equal(found["ticks"], [0, 2, 4])
    assert [(line.line, line.offset, line.bytes, line.reason) for line in refused] == [
        (2, 0, 0, "column a is 'nan', expected a finite number"),
        (4, 0, 0, "column a is 'inf', expected a finite number"),
    ]
    assert account == [("decoded", "", 3, log.stat().st_size), ("refused", "", 2, 0)]

    _, refused, account = everything(
        log, layout | {"gyro": {"columns": ["b", None, None], "unit": "g"}}
    )
    assert refused[0].reason == "column b is '1', expected a finite number"
    assert account == [("header", "", 0, log.stat().st_size), ("refused", "", 5, 0)]


def test_integers_of_any_width_labels_selection_and_missing(tmp_path):
    log = tmp_path / "log"
    columns_there = {
        "sensor": pa.array(["acc", "gyro", "acc", "mag"]).dictionary_encode(),
        "place": pa.array([1.0, 2.0, 2.5, 3.0], pa.float32()),
        "x": pa.array([1, 2, -99, 4], pa.int8()),
        "y": pa.array([1, 2, 3, 4], pa.uint64()),
        "z": pa.array([1, 2, 3, None], pa.int32()),
    }
    parquet.write_table(pa.table(columns_there), log)
    axes = {"columns": ["x", "y", "z"], "unit": "g"}
    layout = {
        "kind": "columns",
        "label": ["place", "y"],
        "time": {"column": "y", "unit": "sample", "rate_hz": 10},
        "accelerometer": axes | {"rows": {"sensor": "acc"}, "missing": -99},
        "gyro": axes | {"rows": {"sensor": "gyro"}},
    }
    found, refused, account = everything(log, layout)
    nan = [np.nan] * 3
    np.testing.assert_array_equal(found["accelerometer"], [[1, 1, 1], nan, [np.nan, 3, 3]])
    np.testing.assert_array_equal(found["gyro"], [nan, [2, 2, 2], nan])
    assert found["label"] == ["place=1; y=1", "place=2; y=2", "place=2.5; y=3"]
    assert not refused
    assert account == [("decoded", "", 3, log.stat().st_size), ("not selected", "", 1, 0)]


@pytest.mark.parametrize("name", ["parquet", "matlab 5", "matlab 7.3", "mcap", "numpy", "ulog"])
def test_reading_needs_no_pandas(tmp_path, name):
    log = tmp_path / "log"
    layout = written.WRITERS[name](log, written.rows(20))
    program = (
        "import sys, json; from pathlib import Path\n"
        "from inertial.formats.columns import column_reader\n"
        "readings = column_reader.read(Path(sys.argv[1]), json.load(sys.stdin))\n"
        "print(sum(len(reading.records.record) for reading in readings))\n"
        "assert 'pandas' not in sys.modules"
    )
    told = subprocess.run(
        [sys.executable, "-c", program, str(log)],
        input=json.dumps(layout),
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(columns.__file__).parents[3],
    )
    assert told.stdout == "20\n"


def test_square_matrices_are_read_as_matlab_shows_them(tmp_path):
    square = np.arange(9.0).reshape(3, 3)  # each row a sample
    layout = {
        "kind": "columns",
        "time": {"rate_hz": 1},
        "gyro": {"columns": ["w.1", "w.2", "w.3"], "unit": "rad/s"},
    }
    savemat(tmp_path / "5", {"w": square}, appendmat=False)
    with h5py.File(tmp_path / "73", "w") as file:
        file["w"] = square.T
        file["w"].attrs["MATLAB_class"] = np.bytes_("double")
    with h5py.File(tmp_path / "plain", "w") as file:
        file["w"] = square
    for name in ("5", "73", "plain"):
        found, *_ = everything(tmp_path / name, layout)
        np.testing.assert_array_equal(found["gyro"], square)


def test_a_large_table_comes_in_portions_whatever_it_is_stored_in(tmp_path):
    count = 150_000
    numbers = np.arange(count, dtype=np.float32)
    table = pa.table({"x": numbers})
    parquet.write_table(table, tmp_path / "parquet")
    with pa.ipc.new_file(tmp_path / "arrow", table.schema) as writer:
        writer.write_table(table)
    savemat(tmp_path / "matlab", {"x": numbers}, appendmat=False)
    with h5py.File(tmp_path / "hdf5", "w") as file:
        file.create_dataset("x", data=numbers, chunks=(1000,), compression="gzip")
    np.savez(tmp_path / "numpy", x=numbers)
    (tmp_path / "numpy.npz").rename(tmp_path / "numpy")
    layout = {"kind": "columns", "gyro": {"columns": ["x", None, "x"], "unit": "rad/s"}}
    for name in ("parquet", "arrow", "matlab", "hdf5", "numpy"):
        readings = list(columns.read(tmp_path / name, layout))
        assert max(len(reading.records.record) for reading in readings) <= 1 << 16
        found = np.concatenate([reading.records.gyro for reading in readings])
        np.testing.assert_array_equal(found[:, 2], numbers)
        record = np.concatenate([reading.records.record for reading in readings])
        np.testing.assert_array_equal(record, np.arange(count))


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", ["<f4", ">i2"])
def test_the_columns_of_a_plain_array_go_by_number(tmp_path, order, dtype):
    numbers = np.arange(700).reshape(100, 7).astype(dtype)
    np.save(tmp_path / "log.npy", np.asarray(numbers, order=order))
    np.save(tmp_path / "turned.npy", np.asarray(numbers.T, order=order))
    layout = {
        "kind": "columns",
        "time": {"column": 1, "unit": "s"},
        "gyro": {"columns": [2, 3, 4], "unit": "deg/s"},
    }
    for name in ("log.npy", "turned.npy"):  # samples lie along the longer side
        found, *_ = everything(tmp_path / name, layout)
        np.testing.assert_array_equal(found["ticks"], numbers[:, 0])
        np.testing.assert_array_equal(found["gyro"], numbers[:, 1:4])


ULOG_LAYOUT = {
    "kind": "columns",
    "time": {"column": "timestamp", "unit": "us"},
    "gyro": {"columns": [f"gyro_rad[{axis}]" for axis in range(3)], "unit": "rad/s"},
    "accelerometer": {
        "columns": [f"accelerometer_m_s2[{axis}]" for axis in range(3)],
        "unit": "m/s2",
    },
}


def test_a_real_log_of_px4(recordings):
    """On its wheels at first, −z up; each row integrates 4888 µs by its own gyro_integral_dt."""
    log = recordings / "formats/flight.ulg"
    found, refused, _ = everything(log, ULOG_LAYOUT)
    assert not refused
    assert len(found["ticks"]) == 1298
    assert np.median(np.diff(found["ticks"])) == pytest.approx(4888, abs=2)
    assert found["accelerometer"][:50].mean(0) == pytest.approx([0, 0, -9.7], abs=0.3)
    assert np.abs(found["gyro"][:50]).max() < 0.05


@pytest.mark.parametrize(("topic", "mean"), [("sensor_accel", -9.7), ("sensor_accel_2", -9.7)])
def test_a_topic_of_px4_and_its_instances_go_by_name(recordings, topic, mean):
    log = recordings / "formats/flight.ulg"
    layout = {
        "kind": "columns",
        "topic": topic,
        "time": {"column": "timestamp_sample", "unit": "us"},
        "accelerometer": {"columns": ["x", "y", "z"], "unit": "m/s2"},
    }
    found, *_ = everything(log, layout)
    assert len(found["ticks"]) == 6
    assert found["accelerometer"][0, 2] == pytest.approx(mean, abs=0.3)
    with pytest.raises(Refusal) as refusal:
        everything(log, layout | {"topic": "sensor_accel_3"})
    assert refusal.value.found == "no messages of the topic 'sensor_accel_3'"
    assert "sensor_accel_2, sensor_baro_0" in refusal.value.expected


def test_a_row_of_px4_without_an_accelerometer_s_sample_is_refused(tmp_path):
    """What PX4 repeats where its accelerometers are slower is marked by the largest integer."""
    fields = "uint64_t timestamp;float[3] gyro_rad;"
    fields += "int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2;"
    messages = [
        written.ulog_message("F", f"sensor_combined:{fields}".encode()),
        written.ulog_message("A", struct.pack("<BH", 0, 7) + b"sensor_combined"),
    ]
    for number in range(4):
        relative = 2**31 - 1 if number == 2 else -100
        data = struct.pack("<HQ3fi3f", 7, number * 5000, 0, 0, number, relative, 0, 0, -number)
        messages.append(written.ulog_message("D", data))
    log = tmp_path / "log"
    log.write_bytes(b"ULog\x01\x12\x35\x01" + bytes(8) + b"".join(messages))
    found, refused, _ = everything(log, ULOG_LAYOUT)
    np.testing.assert_array_equal(found["accelerometer"][:, 2], [0, -1, -3])
    assert [line.line for line in refused] == [3]
    gyros = {name: ULOG_LAYOUT[name] for name in ("kind", "time", "gyro")}
    found, refused, _ = everything(log, gyros)
    np.testing.assert_array_equal(found["gyro"][:, 2], [0, 1, 2, 3])
    assert not refused

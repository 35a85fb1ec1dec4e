"""The stage: what it needs, what it refuses, and what a log tells of its IMU."""

import gzip
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from decoded_logs import S0_FIRST, S0_SECOND, SPAN_CPT, at, decoded, one, signed

from inertial.tables import LOGS
from inertial.tables.errors import Refusal
from inertial.tables.parquet import Writer
from laboratory.rawimu import Samples, log_bytes
from stages.decode.stage import decode


def test_a_missing_log_is_refused_by_name(tmp_path):
    there = tmp_path / "x-up.asc"
    there.write_bytes(signed(S0_FIRST))
    with pytest.raises(Refusal) as refusal:
        decoded(("x-up.asc", there, SPAN_CPT), ("x-down.asc", tmp_path / "x-down.asc", SPAN_CPT))
    assert str(refusal.value) == (
        "x-down.asc\n"
        "  found:    no such file\n"
        "  expected: the log of the campaign beside x-up.asc\n"
        "  cure:     put it into the campaign's folder, or correct its name in campaign.yaml"
    )


def test_the_stage_runs_without_pandas(tmp_path):
    logs = [tmp_path / "z.asc", tmp_path / "columns.txt"]
    logs[0].write_bytes(signed(S0_FIRST) + b"junk\n" + signed(S0_SECOND))
    logs[1].write_bytes(b"a 1 2 3\nb 1 2 3\nc x 2 3\n")
    columns = {"kind": "columns", "gyro": {"columns": [2, 3, 4], "unit": "rad/s"}, "label": [1]}
    rows = [
        {"log": log.name, "file": log.name, "layout": json.dumps(layout)}
        for log, layout in zip(logs, (SPAN_CPT, columns), strict=True)
    ]
    with Writer(tmp_path / "plan", {"logs": LOGS}, dict) as writer:
        writer.write("logs", pa.RecordBatch.from_pylist(rows, LOGS.schema))
    program = (
        "import runpy, sys\n"
        "runpy.run_module('stages', run_name='__main__')\n"
        "assert 'pandas' not in sys.modules, 'pandas was imported'\n"
    )
    output = tmp_path / "decode"
    subprocess.run(
        [sys.executable, "-c", program, "decode", tmp_path, "--raw", *logs],
        check=True,
        cwd=Path(__file__).parents[2],
    )
    samples = pq.read_table(output / "samples.parquet")
    assert samples["log"].to_pylist() == ["z.asc", "z.asc", "columns.txt", "columns.txt"]
    assert samples["label"].to_pylist() == [None, None, "1=a", "1=b"]
    assert pq.read_table(output / "refused.parquet")["reason"].to_pylist() == [
        "begins with 'j', expected '%', '#' or a binary message's AA 44",
        "column 2 is 'x', expected a finite number",
    ]
    assert pq.read_table(output / "clocks.parquet")["records"].to_pylist() == [2, 2]


def test_a_log_that_grows_while_it_is_read_is_refused(tmp_path):
    path = tmp_path / "log.asc"
    path.write_bytes(at(2283, 0) + at(2283, 0.01))
    layout = {"log": "log", "file": path.name, "layout": json.dumps(SPAN_CPT)}
    pieces = decode([pa.RecordBatch.from_pylist([layout], LOGS.schema)], [path])
    assert next(pieces)[0] == "samples"
    with path.open("ab") as file:
        file.write(at(2283, 0.02))
    with pytest.raises(Refusal, match="204 bytes, 68 more than when it was opened"):
        list(pieces)


def test_the_types_of_imu_that_a_log_tells(tmp_path):
    path = tmp_path / "log.bin"
    sent = Samples(np.arange(3) * 10_000_000, *np.zeros((2, 3, 3), np.int64))
    path.write_bytes(
        log_bytes(sent, "RAWIMUSXB", "00000077", imu_type=33)
        + log_bytes(sent, "RAWIMUSXB", "00000077", imu_type=13)
        + log_bytes(sent, "RAWIMUSXB", "00000077", imu_type=0)  # unknown
    )
    assert one(path, SPAN_CPT)["imu_types"]["imu_type"] == [13, 33]


@pytest.mark.parametrize(
    ("content", "found"),
    [
        (gzip.compress(at(2283, 0)), "packed with gzip"),
        (b"PAR1" + bytes(100), "a file of Parquet"),
        (b"SQLite format 3\x00" + bytes(100), "a file of ROS 2 bag"),
    ],
    ids=["gzip", "Parquet", "SQLite"],  # gzip writes down the time
)
def test_what_is_no_receiver_s_log_is_refused_by_name(tmp_path, content, found):
    path = tmp_path / "log.asc"
    path.write_bytes(content)
    with pytest.raises(Refusal, match=found):
        one(path, SPAN_CPT)

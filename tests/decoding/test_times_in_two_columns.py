"""A time of whole seconds and a fraction in a column of its own, as ROS and C have it."""

import json
from pathlib import Path

import pyarrow as pa
import pytest
from decoded_logs import one
from pyarrow import parquet

from inertial.formats.columns import column_reader
from inertial.tables.errors import Refusal
from stages.plan.stage import plan

ROOT = Path(__file__).parents[2]
SECONDS = [1717000000, 1717000000, 1717000001, 1717000001]
PARTS = [999999998, 999999999, 0, 123456789]
STAMPS = [10**9 * whole + part for whole, part in zip(SECONDS, PARTS, strict=True)]
LAYOUT = {
    "kind": "columns",
    "delimiter": ",",
    "header_lines": 1,
    "time": {"columns": ["secs", "nsecs"], "units": ["s", "ns"]},
    "gyro": {"columns": ["x", "y", "z"], "unit": "rad/s"},
}


def text(rows: list[tuple[object, object]]) -> str:
    return "secs,nsecs,x,y,z\n" + "".join(f"{s},{n},1,2,3\n" for s, n in rows)


def test_no_digit_is_lost(tmp_path):
    """A floating-point number of seconds since 1970 holds 0.2 µs."""
    path = tmp_path / "log.csv"
    path.write_text(text(list(zip(SECONDS, PARTS, strict=True))))
    (reading,) = column_reader.read(path, LAYOUT)
    assert reading.records.ticks.tolist() == STAMPS
    samples = one(path, LAYOUT)["samples"]
    assert samples["time"] == [(stamp - STAMPS[0]) / 1e9 for stamp in STAMPS]


def test_nor_in_a_container(tmp_path):
    path = tmp_path / "log.parquet"
    axes = dict.fromkeys("xyz", [0.0] * 4)
    parquet.write_table(pa.table({"secs": SECONDS, "nsecs": PARTS, **axes}), path)
    layout = {key: LAYOUT[key] for key in ("kind", "time", "gyro")}
    (reading,) = column_reader.read(path, layout)
    assert reading.records.ticks.tolist() == STAMPS


def test_microseconds_too(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text(text([(5, 999_000), (6, 4_000)]))
    layout = LAYOUT | {"time": {"columns": [1, 2], "units": ["s", "us"]}}
    assert one(path, layout)["samples"]["time"] == [0, 0.005]


@pytest.mark.parametrize(
    ("second", "part", "column"),
    [
        (1717000000, 1717000000000000000, "nsecs"),  # a stamp, and no fraction of one
        (1717000000, -1, "nsecs"),
        (1717000000.5, 0, "secs"),
        (1717000000, "x", "nsecs"),
        (1717000000000000000, 0, "secs"),  # nanoseconds
    ],
)
def test_what_is_no_whole_number_or_no_fraction_is_refused_by_its_column(
    second, part, column, tmp_path
):
    path = tmp_path / "log.csv"
    path.write_text(text([(1717000000, 1), (second, part), (1717000001, 2)]))
    tables = one(path, LAYOUT)
    assert tables["samples"]["line"] == [2, 4] and tables["refused"]["line"] == [3]
    assert f"column {column} is " in tables["refused"]["reason"][0]
    assert "expected a whole number from " in tables["refused"]["reason"][0]


# ---- in the campaign file

OF_TWO_COLUMNS = """campaign: 1
instrument:
  name: a
  format:
    kind: columns
    delimiter: ","
    time: TIME
    accelerometer: {columns: [ax, ay, az], unit: m/s2}
serial: b
date: 2026-11-02
site: {latitude_deg: 48.0, height_m: 100}
log: log.csv
plan:
  - {id: positions, do: positions, seconds: 2}
"""


def planned(folder: Path, time: str) -> dict:
    """The layout of the log of a campaign that states this time."""
    (folder / "campaign.yaml").write_text(OF_TWO_COLUMNS.replace("TIME", time))
    (folder / "log.csv").write_text("")
    paths = [folder / "campaign.yaml"], [folder / "log.csv"], [ROOT / "data/instruments.yaml"]
    return json.loads(dict(plan(*paths))["logs"]["layout"][0])


@pytest.mark.parametrize(
    ("time", "found"),
    [
        ("{columns: [secs, nsecs]}", "columns without units"),
        ("{units: [s, ns]}", "units without columns"),
        ("{columns: [secs, nsecs], units: [ns, s]}", "of which the first is not the longer"),
        ("{columns: [secs, secs], units: [s, ns]}", "column secs twice"),
        ("{columns: [secs, nsecs], units: [s, ns], column: t}", "columns, and beside them column"),
    ],
)
def test_a_time_in_two_columns_that_is_misstated_is_refused_with_an_example(time, found, tmp_path):
    with pytest.raises(Refusal) as refused:
        planned(tmp_path, time)
    assert found in str(refused.value) and "[secs, nsecs], units: [s, ns]" in str(refused.value)


def test_a_time_in_two_columns_is_understood(tmp_path):
    layout = planned(tmp_path, "{columns: [secs, nsecs], units: [s, ns]}")
    assert layout["time"] == {"columns": ["secs", "nsecs"], "units": ["s", "ns"]}

"""From logs to samples: units, axes, rates and clocks, against numbers that are known."""

import gzip
import json
import math
import subprocess
import sys
import zlib
from collections import defaultdict
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from laboratory.rawimu import Samples, log_bytes
from stages.contracts.errors import Refusal
from stages.contracts.parquet import Writer
from stages.contracts.tables import ACCOUNTS, CHANNELS, CLOCKS, LOGS, REFUSED, SAMPLES
from stages.decode import decode

S0_FIRST = b"2283,42699.880;2283,42699.879998762,00000077,64188,-64,465,-16100,-2,873"
S0_SECOND = b"2283,42711.860;2283,42711.859998756,00000077,64186,-1,432,-16100,4,-1037"
SPAN_CPT = {
    "kind": "rawimus",
    "axes": ["z", "-y", "x"],
    "gyro_count": 0.1 / (3600 * 256),  # rad
    "accelerometer_count": 0.05 / 2**15,  # m/s
}
DEGREE = math.pi / 180
G = 9.80665


def signed(text: bytes) -> bytes:
    text = b"RAWIMUSA," + text
    return b"%%%b*%08x\n" % (text, zlib.crc32(text, 0xFFFFFFFF) ^ 0xFFFFFFFF)


def at(week: int, seconds: float, counts: str = "0,0,0,0,0,0") -> bytes:
    return signed(f"{week},{seconds:.3f};{week},{seconds:.9f},00000077,{counts}".encode())


def decoded(*logs: tuple[str, Path, dict]) -> dict[str, dict[str, dict[str, list]]]:
    """Each table by log and column."""
    rows = [
        {"log": log, "file": path.name, "layout": json.dumps(layout)} for log, path, layout in logs
    ]
    half = len(rows) // 2  # a stream has more than one batch
    stream = [pa.RecordBatch.from_pylist(some, LOGS.schema) for some in (rows[:half], rows[half:])]
    tables = {"samples": SAMPLES, "refused": REFUSED, "accounts": ACCOUNTS, "clocks": CLOCKS}
    found = {
        name: {log: {column.name: [] for column in table.columns} for log, *_ in logs}
        for name, table in tables.items()
    }
    for name, batch in decode(stream, list({path for _, path, _ in logs})):
        assert batch.schema == tables[name].schema
        batch.validate(full=True)
        tables[name].arrow(batch)  # no gaps that the contract does not allow
        for row in batch.to_pylist():
            for column, value in row.items():
                found[name][row["log"]][column].append(value)
    for log, path, _ in logs:
        assert sum(found["accounts"][log]["bytes"]) == path.stat().st_size
    return found


def one(path: Path, layout: dict) -> dict[str, dict[str, list]]:
    """The tables of one log."""
    return {name: table["log"] for name, table in decoded(("log", path, layout)).items()}


def channels(samples: dict[str, list], row: int) -> list[float]:
    return [samples[channel][row] for channel in CHANNELS]


# ---- a receiver's log


def test_the_printed_lines_in_metres_degrees_and_seconds(tmp_path):  # T2
    # at 100 Hz, as they were recorded; the printed pair itself has a gap of 11.98 s between
    path = tmp_path / "z-ccw.asc"
    around = [at(2283, 42699.879998762 + n / 100) for n in range(1, 6)]
    path.write_bytes(b"".join([signed(S0_FIRST), *around, signed(S0_SECOND)]))
    tables = one(path, SPAN_CPT)
    first = channels(tables["samples"], 0)
    np.testing.assert_allclose(first[:3], [0.0709534, 0.0097656, 9.7943115], atol=5e-8)
    np.testing.assert_allclose(
        np.array(first[3:]) / DEGREE, [0.5427432, 0.0012434, -10.0093538], atol=5e-8
    )
    second = channels(tables["samples"], 6)
    np.testing.assert_allclose(second[:3], [0.0659180, 0.0001526, 9.7940063], atol=5e-8)
    np.testing.assert_allclose(
        np.array(second[3:]) / DEGREE, [-0.6447019, -0.0024868, -10.0093538], atol=5e-8
    )
    assert tables["samples"]["time"][6] == pytest.approx(11.979999994, abs=1e-12)
    assert tables["clocks"] == {
        "log": ["log"],
        "clock": ["GPS"],
        "epoch_gps": [2283 * 604800 + 42699.879998762],
        "recorded_on": ["2023-10-08"],  # T24
        "from_s": [0.0],
        "to_s": [11.979999994],
        "records": [7],
        "interval": [pytest.approx(0.01, abs=1e-9)],
        "step": [pytest.approx(0.01, abs=1e-9)],
        "imu_types": [None],
    }


def test_a_count_of_the_fsas_is_smaller_by_a_radian_in_degrees(tmp_path):  # T3
    # S0 takes its IMU for an iMAR-FSAS, of 0.1/256 arcsec a count: its counts cannot be that.
    path = tmp_path / "log.asc"
    path.write_bytes(signed(S0_FIRST) + at(2283, 42699.889998762))
    fsas = SPAN_CPT | {"gyro_count": 0.1 / 256 / 3600 * DEGREE}
    as_cpt, as_fsas = (one(path, layout)["samples"]["gyro_z"][0] for layout in (SPAN_CPT, fsas))
    assert as_cpt / as_fsas == pytest.approx(57.29578, abs=5e-6)


def test_the_axes_of_the_fields_are_those_of_the_layout(tmp_path):
    path = tmp_path / "log.asc"
    path.write_bytes(at(2283, 0, "1,2,3,4,5,6") + at(2283, 0.5))
    units = {"kind": "rawimus", "accelerometer_count": 1, "gyro_count": 1}
    for axes, expected in (
        (["z", "-y", "x"], [6, -4, 2, 12, -10, 8]),
        (["-x", "y", "z"], [-2, 4, 6, -8, 10, 12]),
    ):
        assert channels(one(path, units | {"axes": axes})["samples"], 0) == expected


def test_logs_of_a_receiver_share_a_clock_from_the_earliest_first_sample(tmp_path):
    paths = [tmp_path / name for name in ("late.asc", "early.asc", "next-week.asc", "empty.asc")]
    paths[0].write_bytes(at(2283, 604799.000000001) + at(2283, 604799.010000001))
    paths[1].write_bytes(at(2283, 604000.0) + at(2283, 604000.01))
    paths[2].write_bytes(at(2284, 0.000000001) + at(2284, 0.010000001))
    paths[3].write_bytes(b"")
    tables = decoded(*((path.name, path, SPAN_CPT) for path in paths))
    times = [tables["samples"][path.name]["time"][:1] for path in paths]
    assert times == [[799.000000001], [0.0], [800.000000001], []]
    clocks = [tables["clocks"][path.name] for path in paths]
    assert [clock["epoch_gps"] for clock in clocks] == [[2283 * 604800 + 604000.0]] * 3 + [[None]]
    assert [clock["records"] for clock in clocks] == [[2], [2], [2], [0]]
    assert clocks[3]["interval"] == clocks[3]["from_s"] == clocks[3]["recorded_on"] == [None]


def test_a_log_of_one_sample_has_no_rates(tmp_path):
    path = tmp_path / "log.asc"
    path.write_bytes(signed(S0_FIRST))
    tables = one(path, SPAN_CPT)
    assert channels(tables["samples"], 0) == [None] * 6
    assert tables["clocks"]["interval"] == [None]


def test_gaps_and_refused_lines_do_not_change_the_interval(tmp_path):
    lines = [at(2283, 100 + n / 100, f"{n},0,0,0,0,0") for n in range(100)]
    lines[40] = lines[40].replace(b"40,0,0", b"41,0,0")
    del lines[60:70]
    path = tmp_path / "log.asc"
    path.write_bytes(b"".join(lines))
    tables = one(path, SPAN_CPT)
    assert tables["clocks"]["interval"] == [pytest.approx(0.01, rel=1e-9)]
    assert tables["refused"]["line"] == [41]
    assert tables["samples"]["record"] == [*range(40), *range(41, 90)]
    expected = np.array([*range(40), *range(41, 60), *range(70, 100)])
    np.testing.assert_allclose(
        tables["samples"]["accel_z"], expected * SPAN_CPT["accelerometer_count"] * 100, rtol=1e-9
    )


def test_an_imu_on_a_real_table_feels_gravity_and_the_rate_that_was_set(recordings):
    folder = recordings / "whu_xwgi7681_excerpt"
    layout = SPAN_CPT | {"gyro_count": 1.0850694444e-7, "accelerometer_count": 1.5258789063e-6}
    logs = [(path.name, path, layout) for path in sorted(folder.glob("*.ASC"))]
    tables = decoded(*logs)
    assert sum(clock["records"][0] for clock in tables["clocks"].values()) == 412
    for axis in "xyz":
        up, down = (
            np.mean(tables["samples"][f"{axis}_{way}_3min.ASC"][f"accel_{axis}"])
            for way in ("up", "down")
        )
        assert up == pytest.approx(9.7936, abs=0.02)
        assert down == pytest.approx(-9.7936, abs=0.03)
        for sign in "+-":  # their "+360" reads negative: SOURCE.md
            rate = np.mean(tables["samples"][f"{axis}{sign}360.ASC"][f"gyro_{axis}"]) / DEGREE
            assert rate == pytest.approx(-10 if sign == "+" else 10, abs=0.02)
    assert {clock["recorded_on"][0] for clock in tables["clocks"].values()} == {"2025-10-11"}
    assert min(clock["from_s"][0] for clock in tables["clocks"].values()) == 0.0


# ---- logs of columns


def test_units_and_counts_become_si(tmp_path):
    path = tmp_path / "log.txt"
    path.write_bytes(b"100 2 4 8 90 180 270 25 -180\n110 2 4 8 90 180 270 298.15 -180\n")
    layout = {
        "kind": "columns",
        "time": {"column": 1, "unit": "us"},
        "accelerometer": {"columns": [2, 3, 4], "unit": "g", "counts_per_unit": 2},
        "gyro": {"columns": [5, 6, 7], "unit": "deg/s"},
        "temperature": {"column": 8, "unit": "degC"},
        "table_angle": {"column": 9, "unit": "deg"},
    }
    tables = one(path, layout)
    samples = tables["samples"]
    assert channels(samples, 0) == pytest.approx(
        [G, 2 * G, 4 * G, math.pi / 2, math.pi, 3 * math.pi / 2]
    )
    assert samples["temperature"][0] == 298.15
    assert samples["table_angle"][0] == pytest.approx(-math.pi)
    assert samples["time"] == pytest.approx([0, 1e-5], abs=1e-15)
    assert samples["status"] == [None, None]
    assert tables["clocks"]["clock"] == ["own"]
    assert tables["clocks"]["interval"] == [pytest.approx(1e-5)]
    layout |= {
        "temperature": {"column": 8, "unit": "K"},
        "gyro": {"columns": [5, 6, 7], "unit": "rad/s"},
    }
    samples = one(path, layout)["samples"]
    assert samples["temperature"][1] == 298.15
    assert samples["gyro_y"][1] == 180


def test_without_time_there_is_no_clock(tmp_path):
    path = tmp_path / "log.txt"
    path.write_bytes(b"1 2 3\n4 5 6\n")
    tables = one(path, {"kind": "columns", "gyro": {"columns": [1, 2, 3], "unit": "rad/s"}})
    assert tables["samples"]["time"] == [None, None]
    clock = {name: values[0] for name, values in tables["clocks"].items()}
    assert clock == {
        "log": "log",
        "clock": "none",
        "epoch_gps": None,
        "recorded_on": None,
        "from_s": None,
        "to_s": None,
        "records": 2,
        "interval": None,
        "step": None,
        "imu_types": None,
    }


def test_labelled_session_of_a_mems_imu(recordings):
    layout = {
        "kind": "columns",
        "delimiter": ",",
        "header_lines": 1,
        "time": {"column": "samples", "unit": "sample", "rate_hz": 204.8},
        "accelerometer": {
            "columns": ["acc_x", "acc_y", "acc_z"], "unit": "m/s2", "counts_per_unit": 208.9
        },
        "gyro": {"columns": ["gyr_x", "gyr_y", "gyr_z"], "unit": "deg/s", "counts_per_unit": 16.4},
        "label": ["part"],
    }  # fmt: skip
    tables = one(recordings / "imucal_ferraris" / "annotated_session.csv", layout)
    samples = tables["samples"]
    by_part = defaultdict(list)
    for row, label in enumerate(samples["label"]):
        by_part[label].append(row)
    assert set(by_part) == {f"part={axis}_{part}" for axis in "xyz" for part in ("p", "a", "rot")}
    for axis in "xyz":
        for part, sign in (("p", 1), ("a", -1)):
            rows = by_part[f"part={axis}_{part}"]
            assert 734 <= len(rows) <= 1061  # SOURCE.md
            mean = np.mean([samples[f"accel_{axis}"][row] for row in rows])
            assert mean == pytest.approx(sign * 9.81, abs=0.5)
        turned = sum(samples[f"gyro_{axis}"][row] for row in by_part[f"part={axis}_rot"]) / 204.8
        assert turned / DEGREE == pytest.approx(360, abs=15)
    assert tables["clocks"]["interval"] == [1 / 204.8]
    assert tables["accounts"]["kind"] == ["decoded", "header"]


def test_continuous_session_of_a_mems_imu(recordings):
    layout = {
        "kind": "columns",
        "delimiter": ",",
        "header_lines": 1,
        "time": {"column": "n_samples", "unit": "sample", "rate_hz": 102.4},
        "accelerometer": {"columns": ["acc_x", "acc_y", "acc_z"], "unit": "m/s2"},
        "gyro": {"columns": ["gyr_x", "gyr_y", "gyr_z"], "unit": "deg/s"},
    }
    samples = one(recordings / "imucal_ferraris" / "example_ferraris_session.csv", layout)[
        "samples"
    ]
    assert samples["record"] == list(range(10376))
    assert samples["accel_x"][0] == 10.332114257812501
    assert samples["time"][-1] == pytest.approx(10375 / 102.4)
    for axis, rows, angle in (
        ("x", slice(6770, 7093), -371.9),
        ("y", slice(8081, 8405), -354.8),
        ("z", slice(9205, 9512), -359.2),
    ):  # SOURCE.md
        turned = sum(samples[f"gyro_{axis}"][rows]) / 102.4 / DEGREE
        assert turned == pytest.approx(angle, abs=1.5)


def test_interleaved_rows_of_accelerometer_and_gyro(recordings):
    triad = {"columns": [3, 4, 5]}
    layout = {
        "kind": "columns",
        "delimiter": " ",
        "time": {"column": 2, "unit": "ms"},
        "accelerometer": triad | {"unit": "g", "rows": {"1": "acc"}},
        "gyro": triad | {"unit": "deg/s", "rows": {"1": "gyro"}},
    }
    path = recordings / "softdream_sixpos" / "gyro_rotation1.txt"
    tables = one(path, layout)
    samples = tables["samples"]
    words = [line.split()[0] for line in path.read_text().splitlines()]
    assert len(words) == len(samples["record"])
    for row, word in enumerate(words):
        assert (samples["accel_x"][row] is None) == (word == "gyro")
        assert (samples["gyro_z"][row] is None) == (word == "acc")
    assert samples["accel_z"][0] == pytest.approx(0.969238 * G)
    assert samples["gyro_x"][1] == pytest.approx(0.290076 * DEGREE)
    assert samples["time"][2] == pytest.approx(0.012)
    assert 0.011 <= tables["clocks"]["interval"][0] <= 0.012
    turning = [row for row, word in enumerate(words) if word == "gyro"]
    rates = np.array([samples["gyro_x"][row] for row in turning]) / DEGREE
    times = np.array([samples["time"][row] for row in turning])
    turned = ((rates - rates[:100].mean())[1:] * np.diff(times)).sum()
    assert turned == pytest.approx(-89.6, abs=3)  # SOURCE.md


def test_one_file_in_two_layouts(recordings):
    path = recordings / "hipnuc_temp" / "test.log"
    common = {
        "kind": "columns", "delimiter": ",", "temperature": {"column": 2, "unit": "degC"}
    }  # fmt: skip
    still = common | {
        "mean_of": 3,
        "accelerometer": {"columns": [5, 6, 7], "unit": "m/s2"},
        "gyro": {"columns": [8, 9, 10], "unit": "rad/s"},
    }
    turning = common | {
        "mean_of": 4,
        "gyro": {"columns": [None, None, 11], "unit": "deg/s", "missing": 0},
    }
    tables = decoded(("test.log:still", path, still), ("test.log:turning", path, turning))
    samples = tables["samples"]["test.log:still"]
    assert channels(samples, 0) == [0.12998, -0.1133, 9.90727, -0.00255, 0.00401, 0.00276]
    assert samples["mean_of"][:2] == [19674, 81550]
    assert samples["temperature"][0] == pytest.approx(273.15 + 1.38)
    samples = tables["samples"]["test.log:turning"]
    assert len(samples["record"]) == 30  # the last without a line end
    assert samples["mean_of"][0] == 11107
    assert samples["gyro_z"][0] == pytest.approx(-49.57611 * DEGREE)
    assert samples["gyro_z"][-1] is None  # 0.00000 stands for: not measured
    assert set(samples["gyro_x"]) == set(samples["accel_z"]) == {None}


def test_raw_counts_after_a_header_of_five_lines(recordings):
    layout = {
        "kind": "columns",
        "delimiter": ",",
        "header_lines": 5,
        "time": {"rate_hz": 100},
        "accelerometer": {"columns": ["ax", "ay", "az"], "unit": "g", "counts_per_unit": 16384},
        "gyro": {"columns": ["gx", "gy", "gz"], "unit": "deg/s", "counts_per_unit": 131},
    }
    tables = one(recordings / "mpu6050_cuyo" / "example_data_calibration.csv", layout)
    samples = tables["samples"]
    assert len(samples["record"]) == 10245  # SOURCE.md
    assert samples["line"][0] == 6
    assert channels(samples, 0) == pytest.approx(
        [count / 16384 * G for count in (-12, -812, 15032)]
        + [count / 131 * DEGREE for count in (-447, 156, -86)]
    )
    assert samples["time"][:2] == [0.0, 0.01]
    accounts = dict(zip(tables["accounts"]["kind"], tables["accounts"]["lines"], strict=True))
    assert accounts == {"decoded": 10245, "header": 5}


# ---- the stage


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
    with Writer(tmp_path / "plan", {"logs": LOGS}, {}) as writer:
        writer.write("logs", pa.RecordBatch.from_pylist(rows, LOGS.schema))
    raw = [part for log in logs for part in ("--raw", str(log))]
    program = (
        "import runpy, sys\n"
        "runpy.run_module('stages.decode', run_name='__main__')\n"
        "assert 'pandas' not in sys.modules, 'pandas was imported'\n"
    )
    plan, output = tmp_path / "plan" / "logs.parquet", tmp_path / "decode"
    subprocess.run(
        [sys.executable, "-c", program, "--logs", plan, "--output", output, *raw],
        check=True,
        cwd=Path(__file__).parent.parent,
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
    assert one(path, SPAN_CPT)["clocks"]["imu_types"] == ["13 33"]


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


# ---- the table's encoder beside the IMU


ENCODER = {
    "kind": "columns",
    "time": {"column": 1, "unit": "s"},
    "table_angle": {"column": 2, "unit": "deg"},
}


def with_encoder(layout: dict, readings: list[tuple[float, float]], folder: Path, **told) -> Path:
    """The layout of an IMU's log with the encoder's beside it, and that log."""
    path = folder / "table.txt"
    path.write_text("".join(f"{time:.6f} {angle:.6f}\n" for time, angle in readings))
    layout["encoder"] = {"file": path.name, "layout": ENCODER, "gps_week": None, "offset": 0.0}
    layout["encoder"] |= told
    return path


def turned(path: Path, layout: dict, table: Path) -> list[float | None]:
    """The table's angle at the samples, degrees."""
    rows = [{"log": "log", "file": path.name, "layout": json.dumps(layout)}]
    stream = [pa.RecordBatch.from_pylist(rows, LOGS.schema)]
    found, accounted = [], {}
    for name, batch in decode(stream, [path, table]):
        for row in batch.to_pylist():
            if name == "samples":
                angle = row["table_angle"]
                found.append(None if angle is None else math.degrees(angle))
            if name == "accounts":
                accounted[row["log"]] = accounted.get(row["log"], 0) + row["bytes"]
    assert accounted == {"log": path.stat().st_size, table.name: table.stat().st_size}
    return found


def test_the_encoder_s_angle_goes_on_over_a_turn_and_stops_in_its_gaps(tmp_path):
    path = tmp_path / "log.txt"
    path.write_text("".join(f"{100 + 0.05 * k:.2f} 0 0 1\n" for k in range(60)))
    layout = {
        "kind": "columns",
        "time": {"column": 1, "unit": "s"},
        "gyro": {"columns": [2, 3, 4], "unit": "deg/s"},
    }
    # At 200 °/s from 100.5 s on, modulo 360; without readings from 102.0 s to 102.4 s.
    times = [100.5 + 0.02 * k for k in range(110)]
    readings = [(t, 200 * (t - 100.5) % 360) for t in times if not 102.0 < t < 102.4]
    found = turned(path, layout, with_encoder(layout, readings, tmp_path))
    for k, angle in enumerate(found):
        time = 100 + 0.05 * k
        if time < 100.49 or 102.01 < time < 102.39 or time > times[-1]:
            assert angle is None
        elif time < 101.99 or time > 102.41:
            assert angle == pytest.approx(200 * (time - 100.5), abs=1e-3)


def test_the_encoder_beside_a_receiver_counts_seconds_of_a_gps_week(tmp_path):
    path = tmp_path / "log.asc"
    path.write_bytes(b"".join(at(2283, 42699 + 0.01 * k) for k in range(50)))
    layout = SPAN_CPT | {}
    readings = [(42698.5 + 0.1 * k, 10.0 * 0.1 * k) for k in range(20)]
    table = with_encoder(layout, readings, tmp_path, gps_week=2283, offset=0.25)
    found = turned(path, layout, table)
    assert found == pytest.approx([10 * (0.25 + 0.01 * k) for k in range(50)], abs=1e-5)

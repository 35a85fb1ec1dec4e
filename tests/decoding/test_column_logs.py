"""Logs of columns in SI: units, counts, clocks; real ones as their sources describe them."""

import math
from collections import defaultdict

import numpy as np
import pytest
from decoded_logs import DEGREE, G, channels, decoded, one

from inertial.tables.errors import Refusal


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


def test_increments_become_rates_by_the_interval_of_their_samples(tmp_path):
    """As a ring-laser gyro counts them: 1 count of 0.5″ in 10 ms is a rate of 50″/s."""
    path = tmp_path / "log.txt"
    path.write_text("".join(f"{0.01 * i:.2f} {i} 2 -1 4900 2 0\n" for i in range(50)))
    layout = {
        "kind": "columns",
        "time": {"column": 1, "unit": "s"},
        "gyro": {"columns": [2, 3, 4], "unit": "deg", "counts_per_unit": 7200},
        "accelerometer": {"columns": [5, 6, 7], "unit": "m/s", "counts_per_unit": 50000},
    }
    samples = one(path, layout)["samples"]
    assert channels(samples, 3) == pytest.approx(
        [9.8, 4e-3, 0, *np.radians(np.array([150, 100, -50]) / 3600)]
    )
    del layout["time"]
    with pytest.raises(Refusal, match="increments without a time"):
        one(path, layout)


@pytest.mark.parametrize("delimiter", [",", ";"])
def test_a_temperature_that_is_not_told_costs_no_sample(tmp_path, delimiter):
    """°F are 5/9 K; what is no number and not nothing is damage, and its row is refused."""
    temperatures = ("77", "", "NaN", "n/a", "7x7", "-40", "inf")
    rows = (f"{time} 1 2 3 {warm}" for time, warm in enumerate(temperatures))
    path = tmp_path / "log.csv"
    path.write_text("".join(row.replace(" ", delimiter) + "\n" for row in rows))
    layout = {
        "kind": "columns",
        "delimiter": delimiter,
        "time": {"column": 1, "unit": "s"},
        "gyro": {"columns": [2, 3, 4], "unit": "deg/s"},
        "temperature": {"column": 5, "unit": "degF"},
    }
    tables = one(path, layout)
    assert tables["samples"]["record"] == [0, 1, 2, 3, 5]
    warm = tables["samples"]["temperature"]
    assert [warm[0], warm[4]] == [pytest.approx(298.15), pytest.approx(233.15)]
    assert all(each is None or math.isnan(each) for each in warm[1:4])
    refused = tables["refused"]
    assert refused["line"] == [5, 7] and "'7x7', expected a finite number" in refused["reason"][0]


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
        "began": None,
        "recorded_on": None,
        "from_s": None,
        "to_s": None,
        "records": 2,
        "to_record": 2,
        "interval": None,
        "interval_sigma": None,
        "stamp_scatter": None,
        "shortest_gap": None,
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
    lines = [line.split() for line in path.read_text().splitlines()]
    assert len(samples["record"]) == len(lines) / 2  # a sample has a reading of either
    for row, line in enumerate(samples["line"][:100]):
        assert lines[line - 1][0] == "acc"
        assert samples["accel_x"][row] == pytest.approx(float(lines[line - 1][2]) * G)
    # The gyros are read up to 12 ms later; at the same rate each sample has a reading unchanged.
    read = [float(line[2]) * DEGREE for line in lines if line[0] == "gyro"]
    np.testing.assert_allclose(samples["gyro_x"], read)
    assert samples["time"][1] == pytest.approx(0.012)
    assert 0.011 <= tables["clocks"]["interval"][0] <= 0.012
    assert tables["accounts"]["lines"][tables["accounts"]["kind"].index("decoded")] == len(lines)
    rates, times = np.array(samples["gyro_x"]) / DEGREE, np.array(samples["time"])
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

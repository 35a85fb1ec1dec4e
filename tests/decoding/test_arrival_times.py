"""Logs with stamps of arrival, from the file to samples and findings."""

import shutil

import chain
import numpy as np
import pytest
from decoded_logs import one

TIME = {"column": 1, "unit": "ms"}
LAYOUT = {
    "kind": "columns",
    "time": TIME,
    "accelerometer": {"columns": [2, 3, 4], "unit": "m/s2"},
    "gyro": {"columns": [5, 6, 7], "unit": "rad/s"},
}


def stamped(count: int) -> np.ndarray:
    """Samples of 10 ms that arrive four at a time, 2 ms apart, in whole ms; the first at 7 s."""
    number = np.arange(count)
    return 7000 + number // 4 * 40 + number % 4 * 2


def test_samples_get_the_times_of_a_regular_clock(tmp_path):
    path = tmp_path / "log.txt"
    rows = [f"{stamp} 0 0 {9.8 + k % 3} 0 0 0.{k}" for k, stamp in enumerate(stamped(1000))]
    path.write_text("\n".join(rows))
    tables = one(path, LAYOUT)
    np.testing.assert_allclose(tables["samples"]["time"], np.arange(1000) * 0.01, atol=1e-4)
    clock = {name: values[0] for name, values in tables["clocks"].items()}
    assert clock["interval"] == pytest.approx(0.01, rel=1e-5)
    # Of four samples one comes in time, the others 8, 16 and 24 ms too soon.
    assert clock["stamp_scatter"] == pytest.approx(np.std([0, 8, 16, 24]) * 1e-3, rel=0.01)
    assert clock["from_s"] == 0


def test_rows_of_either_sensor_that_arrive_together(tmp_path):
    path = tmp_path / "log.txt"
    rows = []
    for k, stamp in enumerate(stamped(1000)):
        rows += [f"{stamp} acc 0 0 9.{k}", f"{stamp} gyro 0 0 0.{k}"]
    path.write_text("\n".join(rows))
    triad = {"columns": [3, 4, 5]}
    layout = {
        "kind": "columns",
        "time": TIME,
        "accelerometer": triad | {"unit": "m/s2", "rows": {"2": "acc"}},
        "gyro": triad | {"unit": "rad/s", "rows": {"2": "gyro"}},
    }
    samples = one(path, layout)["samples"]
    np.testing.assert_allclose(samples["time"], np.arange(1000) * 0.01, atol=1e-4)
    np.testing.assert_allclose(samples["gyro_z"], [float(f"0.{k}") for k in range(1000)])


def test_a_record_that_was_written_twice_takes_no_time(tmp_path):
    path = tmp_path / "log.txt"
    rows = [f"{stamp} 0 0 9.{k} 0 0 0" for k, stamp in enumerate(stamped(1000))]
    path.write_text("\n".join([*rows[:500], rows[499], *rows[500:]]))
    time = one(path, LAYOUT)["samples"]["time"]
    assert time[500] == time[499]
    assert time[-1] == pytest.approx(9.99, abs=1e-3)


def test_means_have_the_times_that_are_stated(tmp_path):
    path = tmp_path / "log.txt"
    stamps = [0, 60_000, 135_000, 170_000, 290_000, 300_000, 371_000, 405_000, 500_000, 640_000]
    path.write_text("\n".join(f"{stamp} 0 0 9.8 0 0 0 100" for stamp in stamps))
    tables = one(path, LAYOUT | {"mean_of": 8})
    assert tables["samples"]["time"] == [stamp / 1000 for stamp in stamps]


# ---- recordings

CAMPAIGN = """\
campaign: 1
instrument: {{name: some IMU, rate_hz: 100}}
serial: unknown
date: unknown
site: {{latitude_deg: null, gravity_m_s2: 9.8, gravity_sigma_m_s2: 0.03}}
table: {{name: by hand, position_sigma_arcsec: 3600}}
formats:
  log: {format}
plan:
"""
SNU = (
    "{kind: columns, header_lines: 1, time: {column: time, unit: s}, accelerometer: {columns: "
    "[tx, ty, tz], unit: m/s2}, gyro: {columns: [wx, wy, wz], unit: rad/s}}"
)
SUNSIDED = (
    "{kind: columns, time: {column: 1, unit: s}, accelerometer: {columns: [2, 3, 4], unit: g}}"
)


@pytest.fixture
def examined(recordings, tmp_path):
    def run(folder: str, pattern: str, layout: str) -> chain.Results:
        (tmp_path / "raw").mkdir()
        text = CAMPAIGN.format(format=layout)
        for number, path in enumerate(sorted((recordings / folder).glob(pattern))):
            shutil.copy(path, tmp_path / "raw" / f"{number}.log")
            text += f"  - {{id: r{number}, do: positions, seconds: 3, log: {number}.log, "
            text += "format: log}\n"
        (tmp_path / "raw/campaign.yaml").write_text(text)
        return chain.run(tmp_path / "raw", tmp_path / "derived", "quality")

    return run


def of_time(results: chain.Results) -> dict[str, int]:
    """How many events each finding about time has."""
    names = ["arrival_stamps", "gap", "clock_jitter", "clock_step", "time_backwards"]
    names += ["time_stands_still", "clock_scale", "duplicate"]
    findings = results["quality/findings"]
    own = findings[findings["cause"].isin(names)]
    return dict(zip(own["cause"], own["count"], strict=True))


def test_a_driver_that_polls(examined):
    """The median interval is 10.24 ms, from end to end it is 10.000 ms."""
    results = examined("snu_multipos", "*.txt", SNU)
    clocks = results["decode/clocks"]
    np.testing.assert_allclose(clocks["interval"], 0.01, rtol=1.5e-5)
    np.testing.assert_allclose(clocks["interval"], clocks["interval"].mean(), rtol=2e-6)
    assert of_time(results) == {"arrival_stamps": 3}


def test_packets_by_usb_are_one_finding(examined):
    """Their stamps are 2 ms apart, then up to 75 ms; once at the beginning 0.25 s."""
    results = examined("sunsided_mpu6050", "*-accelerometer.mat", SUNSIDED)
    clocks = results["decode/clocks"].sort_values("records")
    # No gap but one: at 94 s of the third longest log all delays are 40 ms longer than before.
    assert (results["quality/gaps"]["log"] == clocks["log"].iloc[-3]).all()
    assert results["quality/gaps"]["missing"].tolist() == [4]
    # From end to end it is 10.03 to 10.06 ms, by stamps that scatter by 35 ms in 20 to 130 s.
    np.testing.assert_allclose(clocks["interval"][-3:], 10.06e-3, rtol=2e-3)
    np.testing.assert_allclose(clocks["interval"], 10.06e-3, rtol=1e-2)
    assert of_time(results) == {"arrival_stamps": 7, "gap": 1}

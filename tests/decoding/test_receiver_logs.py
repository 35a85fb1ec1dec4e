"""A receiver's logs in SI, against printed values and a real table."""

import numpy as np
import pytest
from decoded_logs import DEGREE, S0_FIRST, S0_SECOND, SPAN_CPT, at, channels, decoded, one, signed

from stages.decode.decoded import interval_of


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
        "began": [None],
        "recorded_on": ["2023-10-08"],  # T24
        "from_s": [0.0],
        "to_s": [11.979999994],
        "records": [7],
        "to_record": [7],
        "interval": [pytest.approx(0.01, abs=1e-9)],
        "interval_sigma": [None],
        "stamp_scatter": [None],
        "shortest_gap": [None],
    }
    assert tables["imu_types"]["imu_type"] == []


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
        of_both = {"axes": {"accel": axes, "gyro": axes}}
        assert channels(one(path, units | of_both)["samples"], 0) == expected


def test_logs_of_a_receiver_share_a_clock_from_the_earliest_first_sample(tmp_path):
    paths = [tmp_path / name for name in ("late.asc", "early.asc", "next-week.asc")]
    paths[0].write_bytes(at(2283, 604799.000000001) + at(2283, 604799.010000001))
    paths[1].write_bytes(at(2283, 604000.0) + at(2283, 604000.01))
    paths[2].write_bytes(at(2284, 0.000000001) + at(2284, 0.010000001))
    tables = decoded(*((path.name, path, SPAN_CPT) for path in paths))
    times = [tables["samples"][path.name]["time"][:1] for path in paths]
    assert times == [[799.000000001], [0.0], [800.000000001]]
    clocks = [tables["clocks"][path.name] for path in paths]
    assert [clock["epoch_gps"] for clock in clocks] == [[2283 * 604800 + 604000.0]] * 3
    assert [clock["records"] for clock in clocks] == [[2], [2], [2]]


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


@pytest.mark.parametrize("jitter", [0.0, 20e3, 350e3, 3e6])  # ns
def test_the_interval_holds_no_jitter_gap_or_step_of_the_clock(jitter):
    """The median of 3000 steps was off by up to 1e-4 of an interval with jitter of 20 µs.

    Of the means of the first and of the last third, which are 20 s apart, the jitter is left.
    """
    random = np.random.default_rng(7)
    stamps = 10_000_000 * np.arange(3000) + random.normal(0, jitter, 3000)
    if not jitter:
        stamps[1500:] += 4e6  # a step of the clock, by which none other is off
    if jitter < 1e6:  # else no single gap is to see
        stamps = np.delete(stamps, [5, 100, 101, 700])
    interval = interval_of(np.rint(stamps).astype(np.int64))
    sigma = jitter * np.sqrt(2 / 1000) / 2000
    assert interval == pytest.approx(1e7, abs=4 * sigma + 1e-3)


def test_the_interval_is_that_of_many_gaps_too():
    """One sample in a hundred is missing: over a thousand steps that is 1 % of the time."""
    random = np.random.default_rng(9)
    there = np.flatnonzero(random.random(30_000) > 0.01)
    assert interval_of(10_000_000 * there) == pytest.approx(1e7, rel=1e-9)


@pytest.mark.parametrize(("true", "unit"), [(7.8125e6, 1e6), (1e7, 3e6), (1e7, 4e6), (1e7, 1.6e7)])
def test_the_interval_is_that_of_rounded_stamps(true, unit):
    """At 128 Hz in milliseconds four of five steps are 8 ms; of 10 ms in 4 ms they are 8 or 12."""
    stamps = (np.rint(np.arange(3000) * true / unit) * unit).astype(np.int64)
    assert interval_of(stamps) == pytest.approx(true, rel=1e-4)


def test_increments_become_rates_by_the_mean_interval(tmp_path):
    jitter = np.random.default_rng(8).normal(0, 1e-4, 400)  # s
    readings, path = [], tmp_path / "rest.asc"
    for off in (jitter, np.zeros(400)):
        stamps = 42699.0 + 0.01 * np.arange(400) + off
        counts = "64000,-10,20,300,-400,500"
        path.write_bytes(b"".join(at(2283, stamp, counts) for stamp in stamps))
        tables = one(path, SPAN_CPT)
        assert tables["clocks"]["interval"] == [pytest.approx(0.01, abs=1e-6)]
        readings.append(channels(tables["samples"], 0))
    assert abs(np.median(np.diff(jitter))) > 3e-6  # s, by which the median interval is off
    np.testing.assert_allclose(readings[0], readings[1], rtol=1e-4)


@pytest.mark.parametrize("lost", [1000, -1400], ids=["a gap", "a clock set back"])
@pytest.mark.parametrize("at", [300, 700])
def test_a_gap_or_a_jump_of_a_short_log_leaves_its_interval(at, lost):
    """Once most of the pairs of stamps lay across it: three intervals for one, or none at all."""
    stamps = np.arange(1000) + np.where(np.arange(1000) < at, 0, lost)
    assert interval_of(10_000_000 * stamps) == pytest.approx(1e7, rel=1e-9)

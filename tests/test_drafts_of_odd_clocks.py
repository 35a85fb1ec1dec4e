"""`make draft`: clocks of which the unit is not in their name, or another than that."""

from pathlib import Path

import chain
import numpy as np
import pytest
from drafting import Rates, comments, drafted, moved, told, written
from logs_by_hand import by_hand_log
from moved_by_hand import RATE

from commands.draft.__main__ import draft
from inertial.tables.yaml_file import YamlFile

NAMES = "ax,ay,az,gx,gy,gz"


def logged(clock: str, step: float, seed: int, header: str = "") -> str:
    """A log in m/s² and rad/s whose clock has this name, and counts on by `step` in 10 ms."""
    log = by_hand_log(seed)
    time = step * np.arange(len(log.force))
    return f"{header}{clock},{NAMES}\n" + written([time, log.force, log.rate], digits=9)


def layout_of(text: str, tmp_path, name: str = "log.csv") -> tuple[dict, str]:
    folder = drafted({name: text}, tmp_path)
    return told(folder)["instrument"]["format"], comments(folder)


# ---- clocks with ticks of 0.1 ms, as SampleTimeFine of Xsens


@pytest.mark.parametrize(
    "header",
    ["// Sample rate: 100.0Hz\n", "// Update Rate: 100\n", "// Abtastrate: 100 Hz\n", "# fs=100\n"],
)
def test_a_rate_in_the_header_decides_the_unit_of_a_clock(header, tmp_path):
    """It was taken for ms, and 10 Hz."""
    layout, said = layout_of(logged("SampleTimeFine", 100, 30, header), tmp_path)
    assert layout["time"] == {"column": "SampleTimeFine", "unit": "tick", "ticks_per_s": 10_000}
    assert layout["gyro"] == {"columns": ["gx", "gy", "gz"], "unit": "rad/s"}
    assert "at 100.0 Hz" in said and "how long is a tick" not in said


def test_the_gyros_decide_it_where_no_header_does(tmp_path):
    layout, said = layout_of(logged("SampleTimeFine", 100, 30), tmp_path)
    assert layout["time"] == {"column": "SampleTimeFine", "unit": "tick", "ticks_per_s": 10_000}
    assert layout["gyro"]["unit"] == "rad/s" and "counts_per_unit" not in layout["gyro"]
    assert "how long is a tick?" in said
    results = chain.run(tmp_path / "data/raw/drafted", tmp_path / "derived", "decode")
    assert np.median(np.diff(results["decode/samples"]["time"])) == pytest.approx(0.01)


def test_revolutions_per_minute_are_no_clock_of_another_unit(tmp_path):
    """1 rpm is 0.1047 rad/s."""
    log = by_hand_log(31)
    time = np.arange(len(log.force)) * 100
    text = f"n_t,{NAMES}\n" + written([time, log.force, log.rate / 0.104720], digits=9)
    layout, said = layout_of(text, tmp_path)
    assert layout["time"]["unit"] == "ms" and "in no usual unit" in said


@pytest.mark.parametrize("header", ["# Baud rate: 115200\n", "# accurate to 5 %\n"])
def test_other_rates_are_none_of_samples(header, tmp_path):
    log = by_hand_log(30)
    text = header + f"{NAMES}\n" + written([log.force, log.rate])
    layout, said = layout_of(text, tmp_path)
    assert layout["time"] == {"rate_hz": 100} and "the header states the rate" not in said


# ---- clocks whose name says another unit


@pytest.mark.parametrize(("clock", "right"), [("time_ms", "us"), ("time_s", "ms"), ("t_us", "ms")])
def test_a_name_by_which_the_rate_is_that_of_no_imu_is_asked_about(clock, right, tmp_path):
    step = {"us": 1e4, "ms": 10}[right]
    layout, said = layout_of(logged(clock, step, 32), tmp_path)
    assert layout["time"] == {"column": clock, "unit": right}
    assert f"{clock} of log.csv: its name says" in said and "100.0 samples a second" in said


def test_a_name_that_a_header_contradicts_is_asked_about(tmp_path):
    layout, said = layout_of(logged("t_ms", 0.01, 33, "# rate: 100 Hz\n"), tmp_path)
    assert layout["time"] == {"column": "t_ms", "unit": "s"}
    assert "the header states the rate" in said and "Which is right?" in said


def test_a_slow_rate_that_a_name_says_is_right(tmp_path):
    """Every tenth sample is kept, 10 Hz."""
    log = by_hand_log(34)
    rows = slice(None, None, 10)
    time = np.arange(len(log.force))[rows] * 1000 / RATE
    text = f"t_ms,{NAMES}\n" + written([time, log.force[rows], log.rate[rows]], digits=9)
    layout, said = layout_of(text, tmp_path)
    assert layout["time"] == {"column": "t_ms", "unit": "ms"} and "Which is right" not in said


# ---- no clock, and what states the rate


def test_a_column_of_intervals_states_the_rate(tmp_path):
    """In ms, 10 in the mean."""
    log = by_hand_log(35)
    steps = np.random.default_rng(35).choice([9, 10, 11], len(log.force))
    text = f"dt,{NAMES}\n" + written([steps, log.force, log.rate])
    layout, said = layout_of(text, tmp_path)
    assert layout["time"] == {"rate_hz": pytest.approx(100, rel=0.005)}
    assert "dt is the time from row to row" in said and "how many samples a second" not in said


@pytest.mark.parametrize(
    "header", ["// Abtastrate: 125 Hz\n", "# Samplerate=125\n", "# Fréquence : 125\n"]
)
def test_a_rate_is_stated_in_other_languages(header, tmp_path):
    log = by_hand_log(36)
    layout, _said = layout_of(header + f"{NAMES}\n" + written([log.force, log.rate]), tmp_path)
    assert layout["time"] == {"rate_hz": 125}


def test_ticks_that_are_a_rate_in_two_units_are_asked_about(tmp_path):
    """The 39.0625 µs of Bosch were taken for ms, and the counts of gyros for those that then fit.

    With these each quarter turn was of 51 turns more or less, and ended near the next position.
    """
    rates: Rates = []
    for axis in (0, 2, 0, 1, 0):
        rates += [(20, (0, 0, 0)), (3.25, tuple(np.eye(3)[axis] * np.pi / 6.5))]
    log = moved([*rates, (20, (0, 0, 0))])
    stamps = (16_770_000 + 256 * np.arange(len(log))) % 2**24
    counts = np.rint(log[:, 1:4] / 9.80665 * 8192), np.rint(log[:, 4:] * 131.2)
    text = f"sensortime;{NAMES.replace(',', ';')}\n" + written([stamps, *counts], ";", 9)
    _layout, said = layout_of(text, tmp_path)
    assert "a step of 256.000 ticks is 3.906 (ms) and 3906 (us) samples a second" in said
    assert "how many are there?" in said and "no turn shows how many are in 1 °/s" in said
    folder = draft([tmp_path / "log.csv"], "again", tmp_path / "data", rate=100)
    layout, said = told(folder)["instrument"]["format"], comments(folder)
    right = {"unit": "tick", "ticks_per_s": 25_600, "wraps_at": 2**24}
    assert layout["time"] == {"column": "sensortime", **right}
    assert layout["gyro"]["counts_per_unit"] == 131 and "how many are there?" not in said


@pytest.mark.parametrize(("name", "asked"), [("tick", True), ("t_us", False)])
def test_a_guessed_tick_is_asked_where_gyros_read_counts(name, asked, tmp_path):
    log = by_hand_log(35)
    counts = np.rint(log.force / 9.80665 * 4096), np.rint(np.degrees(log.rate) * 32.8)
    text = f"{name},{NAMES}\n" + written([10_000 * np.arange(len(log.force)), *counts], digits=9)
    _layout, said = layout_of(text, tmp_path)
    assert ("is taken for 1 µs, which makes 100.0 samples a second" in said) == asked


def test_days_are_no_clock_and_the_rate_is_asked(tmp_path):
    """MATLAB's days, taken for s, made a recording of 2.5 ms, all of which moved."""
    log = by_hand_log(34)
    days = 739_924.4166667 + np.arange(len(log.force)) / RATE / 86_400
    rows = zip(days, written([log.force, log.rate]).splitlines(), strict=True)
    text = f"datenum,{NAMES}\n" + "".join(f"{day:.9f},{row}\n" for day, row in rows)
    layout, said = layout_of(text, tmp_path)
    assert layout["time"] == {"rate_hz": RATE} and layout["gyro"]["unit"] == "rad/s"
    assert "how many samples a second are there?" in said


# ---- dates as they are written in Germany and in America

QUARTER_TO_ONE = 45_900  # s, 12:45:00: the hour of 12 PM becomes 1 PM in the log


def of_day(kind: str, seconds: np.ndarray) -> list[str]:
    """The stamps of 7 March 2025, or the time of that day, in the notation of a country."""
    ms = np.round(1000 * seconds).astype(int).tolist()
    parts = [(k // 3_600_000, k // 60_000 % 60, k // 1000 % 60, k % 1000) for k in ms]
    german = "07.03.2025 {:02}:{:02}:{:02},{:03}"
    if kind == "german":
        return [german.format(*part) for part in parts]
    date = "3/7/2025 " if kind == "american" else ""
    return [f"{date}{h % 12 or 12}:{m:02}:{s:02}.{f:03} {'AP'[h // 12]}M" for h, m, s, f in parts]


@pytest.mark.parametrize("kind", ["german", "american", "of the day"])
def test_dates_of_other_notations_are_a_clock(kind, tmp_path):
    log = by_hand_log(37)
    begin = QUARTER_TO_ONE - 12 * 3600 * (kind == "of the day")
    time = begin + np.arange(len(log.force)) / RATE
    rows = written([log.force, log.rate], ";").splitlines()
    if kind == "german":
        rows = [row.replace(".", ",") for row in rows]
    lines = [f"{stamp};{row}" for stamp, row in zip(of_day(kind, time), rows, strict=True)]
    text = "\n".join([f"When;{NAMES.replace(',', ';')}", *lines]) + "\n"
    layout, said = layout_of(text, tmp_path)
    _check_date(kind, tmp_path / "data/raw/drafted/campaign.yaml", said)
    assert layout["time"]["column"] == "When" and layout["time"]["unit"] == "iso8601"
    assert layout["gyro"]["unit"] == "rad/s" and "at 100.0 Hz" in said
    results = chain.run(tmp_path / "data/raw/drafted", tmp_path / "derived", "decode")
    taken = results["decode/samples"]["time"].to_numpy()
    assert len(taken) == len(time) and np.allclose(np.diff(taken), 0.01, atol=1e-6)


def _check_date(kind: str, file: Path, said: str) -> None:
    """Each draft left the date unknown, and asked when the log was recorded."""
    lines = file.read_text(encoding="utf-8").splitlines()
    if kind == "of the day":
        assert "date: unknown" in lines and "when was it recorded?" in said
    else:
        assert "date: 2025-03-07  # by the first stamp of log.csv" in lines
        assert YamlFile(file).content["date"] == "2025-03-07"
        assert "The date, 2025-03-07, is that of the first stamp of log.csv" in said
        assert "when was it recorded?" not in said


# ---- a log for each sensor


@pytest.mark.parametrize("apart", [0, 1_762_000_000])
def test_a_log_of_each_sensor_may_count_in_another_unit_by_another_name(apart, tmp_path):
    """The gyros were taken for another recording, all of which was one turn."""
    log = by_hand_log(38)
    time = np.arange(len(log.force)) / RATE
    logs = {
        "a.csv": "time_s,ax,ay,az\n" + written([time, log.force], digits=9),
        "g.csv": "t_ms,gx,gy,gz\n" + written([1000 * (time + apart) + 2, log.rate], digits=15),
    }
    folder = drafted(logs, tmp_path)
    campaign, said = told(folder), comments(folder)
    if apart:
        assert "a.csv and g.csv last as long as each other" in said
        return
    assert campaign["instrument"]["format"]["time"] == {"column": "time_s", "unit": "s"}
    assert campaign["gyro"] == {"log": "g.csv", "format": "gyros-1"}
    assert campaign["formats"]["gyros-1"]["time"] == {"column": "t_ms", "unit": "ms"}
    samples = chain.run(folder, tmp_path / "derived", "decode")["decode/samples"]
    turned = samples["gyro_x"].to_numpy()
    assert np.corrcoef(turned, log.rate[-len(turned) :, 0])[0, 1] > 0.99


# ---- what is said of columns


def test_a_column_of_text_is_called_text_and_no_rarer_sensor(tmp_path):
    """It sent one looking for a second sensor: a date is in no notation that is read."""
    log = by_hand_log(36)
    time = np.arange(len(log.force)) / RATE
    rows = written([90211.5 + time, log.force, log.rate], digits=9).splitlines()
    dates = (
        f"at {60 * second:.0f} after noon,{row}" for second, row in zip(time, rows, strict=True)
    )
    folder = drafted({"log.csv": f"when,t(s),{NAMES}\n" + "\n".join(dates) + "\n"}, tmp_path)
    said = comments(folder)
    assert "text, and not read: when" in said and "without a number" not in said


def test_it_is_said_whose_name_states_the_unit_of_the_time(tmp_path):
    _layout, said = layout_of(logged("t_ms", 10, 37), tmp_path)
    assert "at 100.0 Hz; t_ms counts ms by its name" in said


# ---- stamps of the sensor beside those of arrival


@pytest.mark.parametrize(
    ("secs", "nsecs"),
    [
        ("header.stamp.secs", "header.stamp.nsecs"),
        ("secs", "nsecs"),
        ("header.stamp.sec", "header.stamp.nanosec"),
    ],
)
def test_the_stamps_of_the_sensor_are_preferred_to_those_of_arrival(secs, nsecs, tmp_path):
    """The time of arrival was taken, and the report advised to log the stamps of the sensor."""
    log = by_hand_log(38)
    stamps = np.arange(len(log.force)) * 10**7 + 1717000000 * 10**9
    late = np.random.default_rng(38).exponential(2e-3, len(stamps))
    rows = written([log.force, log.rate], digits=9).splitlines()
    times = (
        f"{stamp / 1e9 + after:.6f},{stamp // 10**9},{stamp % 10**9}"
        for stamp, after in zip(stamps.tolist(), late.tolist(), strict=True)
    )
    text = f"Time,{secs},{nsecs},{NAMES}\n" + "".join(
        f"{time},{row}\n" for time, row in zip(times, rows, strict=True)
    )
    folder = drafted({"log.csv": text}, tmp_path)
    assert told(folder)["instrument"]["format"]["time"] == {
        "columns": [secs, nsecs],
        "units": ["s", "ns"],
    }
    said = comments(folder)
    assert f"{secs}, {nsecs} hold the time in s and ns" in said and "not used: Time" in said
    results = chain.run(folder, tmp_path / "derived", "decode")
    assert np.ptp(np.diff(results["decode/samples"]["time"])) < 1e-9


# ---- counters of rows


@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize("clock", ["Tick[ms]", "time_ms"])
def test_a_clock_with_a_unit_is_preferred_to_a_counter_before_it(first, clock, tmp_path):
    """The counter was taken, and the rate asked; one that begins again made warnings of numpy."""
    log = by_hand_log(39)
    rows = np.arange(len(log.force))
    counter = (rows + first) % (2**8 if first == 0 else 2**24)
    mdps = np.degrees(log.rate) * 1000
    text = f"Seq#,{clock},F1 (m/s^2),F2 (m/s^2),F3 (m/s^2),R1 (mdps),R2 (mdps),R3 (mdps)\n"
    text += written([counter, 5000 + 10 * rows, log.force, mdps], digits=9)
    layout, said = layout_of(text, tmp_path)
    assert layout["time"] == {"column": clock, "unit": "ms"} and "not used: Seq#" in said
    assert layout["gyro"]["unit"] == "deg/s" and layout["gyro"]["counts_per_unit"] == 1000


@pytest.mark.parametrize(("unit", "parts"), [("mdps", 1000), ("dps", None)])
def test_a_counter_that_begins_again_is_no_clock_of_its_own_rate(unit, parts, tmp_path):
    """Of mdps the motion made 100 000 samples a second."""
    log = by_hand_log(39)
    counter = np.arange(len(log.force)) % 2**8
    names = ",".join(f"R{k} ({unit})" for k in (1, 2, 3))
    rows = written([counter, log.force, np.degrees(log.rate) * (parts or 1)], digits=9)
    layout, said = layout_of(f"Seq#,F1,F2,F3,{names}\n{rows}", tmp_path)
    assert layout["time"] == {
        "column": "Seq#",
        "unit": "sample",
        "rate_hz": RATE,
        "wraps_at": 2**8,
    }
    assert layout["gyro"].get("counts_per_unit") == parts and "how many samples" in said


def test_a_clock_of_ms_may_go_on_by_one_from_row_to_row(tmp_path):
    """It was taken for a counter of rows, and 17.6 Hz."""
    log = by_hand_log(30)
    every = np.arange(10 * len(log.force))
    noise = 0.01 * np.random.default_rng(0).standard_normal((len(every), 3))
    force, rate = (np.repeat(own, 10, axis=0) + noise for own in (log.force, log.rate))
    layout, said = layout_of(f"t_ms,{NAMES}\n" + written([every, force, rate]), tmp_path)
    assert layout["time"] == {"column": "t_ms", "unit": "ms"} and "at 1000 Hz" in said
    assert layout["gyro"]["unit"] == "rad/s"

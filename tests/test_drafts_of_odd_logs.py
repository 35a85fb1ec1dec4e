"""`make draft`: logs that are padded, unnamed, misnamed or of which nothing rests."""

import struct

import chain
import numpy as np
import pytest
from drafting import Rates, comments, drafted, moved, told, written
from logs_by_hand import by_hand_log
from moved_by_hand import RATE

from commands.draft.__main__ import draft
from inertial.tables.errors import Refusal

# ---- what is no static position


def at_rest(up: tuple[float, float, float], seconds: float, seed: int = 0) -> np.ndarray:
    """Accelerometers (n, 3) at 100 Hz in one attitude, m/s²."""
    noise = 0.02 * np.random.default_rng(seed).standard_normal((round(100 * seconds), 3))
    return 9.8 * np.array(up) / np.linalg.norm(up) + noise


FACES = [(0, 0, 1), (0, 0, -1), (0, 1, 0), (1, 0, 0)]


def test_zeros_that_fill_a_log_up_are_no_static_position(tmp_path):
    force = np.vstack([at_rest(FACES[i % 3], 5, i) for i in range(3)] + [np.zeros((400, 3))])
    time = np.arange(len(force)) / 100
    folder = drafted({"log.csv": "t,ax,ay,az\n" + written([time, force])}, tmp_path)
    campaign = told(folder)
    assert campaign["instrument"]["format"]["accelerometer"]["unit"] == "m/s2"
    assert [m["up"] for m in campaign["plan"]] == ["+z", "-z", "+y"]
    assert all(m["rows"][1] <= 1500 for m in campaign["plan"])
    assert "gravity has one length" not in comments(folder)


def test_static_positions_in_which_gravity_differs_are_asked_about(tmp_path):
    force = np.vstack([at_rest(FACES[i], 5, i) * (1.25 if i == 2 else 1) for i in range(4)])
    time = np.arange(len(force)) / 100
    folder = drafted({"log.csv": "t,ax,ay,az\n" + written([time, force])}, tmp_path)
    assert told(folder)["instrument"]["format"]["accelerometer"]["unit"] == "m/s2"
    assert "in 4 static positions |f| is 9.8" in comments(folder)
    assert "to 12.25, and gravity has one length" in comments(folder)


# ---- files of three columns without names


def test_files_that_look_alike_are_of_the_sensor_that_they_are_named_for(tmp_path):
    rate = 0.03 + 0.002 * np.random.default_rng(1).standard_normal((500, 3))
    logs = {f"accel_{i}.csv": written([at_rest(FACES[i], 5, i)]) for i in range(3)}
    campaign = told(drafted(logs | {"gyro.csv": written([rate])}, tmp_path, rate=100))
    first, second = campaign["formats"].values()
    assert first["accelerometer"] == {"columns": [1, 2, 3], "unit": "m/s2"}
    assert second["gyro"] == {"columns": [1, 2, 3], "unit": "rad/s"}
    assert "gyro" not in first and "accelerometer" not in second
    assert [m["format"] for m in campaign["plan"]] == ["format-1"] * 3 + ["format-2"]
    told_of = comments(tmp_path / "data/raw/drafted")
    assert "by the names of their files" in told_of and "by their names" not in told_of


def test_files_that_look_alike_and_read_far_less_than_gravity_are_of_gyros(tmp_path):
    rate = 0.03 + 0.002 * np.random.default_rng(1).standard_normal((500, 3))
    logs = {f"{i}.csv": written([at_rest(FACES[i], 5, i)]) for i in range(3)}
    folder = drafted(logs | {"3.csv": written([rate])}, tmp_path, rate=100)
    first, second = told(folder)["formats"].values()
    assert first["accelerometer"]["unit"] == "m/s2" and "accelerometer" not in second
    assert second["gyro"]["columns"] == [1, 2, 3]
    assert "gravity reads 9.8" in comments(folder)


def test_a_file_named_for_a_magnetometer_is_none_of_accelerometers(tmp_path):
    logs = {"acc.csv": written([at_rest(FACES[0], 5)]), "mag.csv": written([at_rest(FACES[1], 5)])}
    with pytest.raises(Refusal, match="of another sensor"):
        drafted(logs, tmp_path)


# ---- where nothing rests


def tumbling(seconds: float, turns: float) -> np.ndarray:
    """Accelerometers (n, 3) at 100 Hz while gravity goes round in body axes, m/s²."""
    angle = np.linspace(0, 2 * np.pi * turns, round(100 * seconds))
    up = np.column_stack([np.sin(angle), np.cos(angle) * np.sin(3 * angle), np.cos(angle)])
    noise = 0.02 * np.random.default_rng(0).standard_normal(up.shape)
    return 9.8 * up / np.linalg.norm(up, axis=1)[:, None] + noise


def test_slow_tumbling_is_no_rest(tmp_path):
    with pytest.raises(Refusal, match=r"at 100.0 Hz, which is assumed") as refusal:
        drafted({"acc.csv": written([tumbling(60, 4)])}, tmp_path)
    assert "RATE=" in refusal.value.cure
    with pytest.raises(Refusal, match="all of it moves") as refusal:
        drafted({"acc.csv": written([np.arange(6000) / 100, tumbling(60, 4)])}, tmp_path)
    assert "RATE=" not in refusal.value.cure


def test_where_nothing_rests_the_length_of_gravity_is_no_length_of_a_mean(tmp_path):
    rest = 0.001 * np.random.default_rng(2).standard_normal((1000, 3))
    logs = {"acc.csv": written([tumbling(60, 4)]), "gyro.csv": written([rest])}
    folder = drafted(logs, tmp_path)
    formats = told(folder)["formats"].values()
    assert [own["accelerometer"]["unit"] for own in formats if "accelerometer" in own] == ["m/s2"]
    assert "the median of |f| is 9.8" in comments(folder)
    assert "acc.csv is not in the plan: in its 60.0 s nothing rests" in comments(folder)


# ---- logs of raw counts, as a microcontroller prints them


def counted(up: tuple[float, float, float], seed: int) -> str:
    """Stamps, µs, accelerometers of 16384 in 1 g and gyros that rest with a bias of −4.2 °/s."""
    force = np.rint(at_rest(up, 3, seed) / 9.80665 * 16384)
    rate = np.rint([-550, 120, -76] + 8 * np.random.default_rng(seed).standard_normal((300, 3)))
    head = "t_us,ax,ay,az,gx,gy,gz\n"
    return head + written([500_000 + 10_000 * np.arange(300), force, rate])


def test_whole_numbers_of_gyros_beside_counts_are_counts_of_a_size_that_is_asked(tmp_path):
    logs = {f"{i}.csv": counted(FACES[i], i) for i in range(3)}
    folder = drafted(logs, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["accelerometer"]["counts_per_unit"] == 16384
    assert layout["gyro"]["counts_per_unit"] == 131  # the range beside 2 g, of most of these
    assert "they read counts, and no turn shows how many are in 1 °/s" in comments(folder)


def test_zeros_before_the_names_are_no_part_of_them(tmp_path):
    """A serial port that is opened late gives a buffer of them."""
    logs = {f"{i}.csv": "\0" * (300 + i) + counted(FACES[i], i) for i in range(3)}
    folder = drafted(logs, tmp_path)
    campaign = told(folder)
    assert campaign["instrument"]["format"]["time"] == {"column": "t_us", "unit": "us"}
    results = chain.run(folder, tmp_path / "derived", "segment")
    assert results["segment/segments"]["manoeuvre"].nunique() == 3


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (("posZ", "negZ", "x_up"), ["x_up.csv: its name says +x up, and it reads +y"]),
        (("posZ", "z-down", "run-x"), []),
        (("negZ", "plus z", "y-"), ["each log reads −g on the axis that its name says"]),
    ],
)
def test_a_name_that_says_another_axis_than_the_log_reads_is_asked_about(names, said, tmp_path):
    logs = {f"{name}.csv": counted(FACES[i], i) for i, name in enumerate(names)}
    text = comments(drafted(logs, tmp_path))
    assert all(sentence in text for sentence in said)
    assert text.count("its name says") == len(said)


# ---- ends of logs without samples


@pytest.mark.parametrize("clock", ["goes on", "stands"])
def test_the_empty_end_of_a_memory_is_no_part_of_a_log(clock, tmp_path):
    """0xFF after 15 s, in the units of each column, and nan; or zeros, while the clock goes on."""
    force = np.vstack([at_rest(FACES[i], 5, i) for i in range(3)])
    warm = 30 + 0.01 * np.random.default_rng(0).standard_normal(1500)
    empty = [4294967.295, -0.0006, -0.0006, -0.0006, np.nan]
    tail = np.tile(empty if clock == "stands" else [0.0] * 5, (4000, 1))
    if clock == "goes on":
        tail[:, 0] = 15 + np.arange(4000) / 100
    rows = np.vstack([np.column_stack([np.arange(1500) / 100, force, warm]), tail])
    folder = drafted({"flash.txt": written([rows], digits=10)}, tmp_path)
    campaign = told(folder)
    layout = campaign["instrument"]["format"]
    assert layout["time"]["column"] == 1
    assert layout["accelerometer"] == {"columns": [2, 3, 4], "unit": "m/s2"}
    assert [m["up"] for m in campaign["plan"]] == ["+z", "-z", "+y"]
    assert max(m["rows"][1] for m in campaign["plan"]) == 1500
    assert "its last 4 000 rows hold no samples" in comments(folder)


def test_an_imu_that_rests_at_the_end_of_its_log_is_no_empty_end(tmp_path):
    """Coarse counts stand still at rest, and the clock does not."""
    force = np.rint(np.vstack([at_rest(FACES[i], 5, i) for i in (3, 0, 2)]) / 9.80665 * 16)
    text = "t,ax,ay,az\n" + written([np.arange(1500) / 100, force])
    folder = drafted({"log.csv": text}, tmp_path)
    assert [m["up"] for m in told(folder)["plan"]] == ["+x", "+z", "+y"]
    assert "hold no samples" not in comments(folder)


# ---- columns without names


def test_counts_without_their_sign_are_known_by_their_leaps(tmp_path):
    """A tabulator, no names, 16 bits unsigned, a constant, pressure and temperature behind."""
    log = by_hand_log(6)
    n, random = len(log.force), np.random.default_rng(6)
    force = np.rint(log.force / 9.80665 * 8192) % 65536
    rate = np.rint(np.degrees(log.rate) * 65.5) % 65536
    air = 97.8 + 0.001 * random.standard_normal(n), 35 + 0.01 * random.standard_normal(n)
    rows = [np.arange(n) / RATE, force, rate, np.zeros(n), *air]
    layout = told(drafted({"log.txt": written(rows, "\t", 8)}, tmp_path))["instrument"]["format"]
    right = {"columns": [2, 3, 4], "unit": "g", "counts_per_unit": 8192, "signed_bits": 16}
    assert layout["accelerometer"] == right
    right = {"columns": [5, 6, 7], "unit": "deg/s", "counts_per_unit": 65.5, "signed_bits": 16}
    assert layout["gyro"] == right


def test_what_hardly_changes_is_no_gravity(tmp_path):
    """Pressure, humidity and temperature of three positions, beside accelerometers in g."""
    force = np.vstack([at_rest(FACES[i], 5, i) for i in (0, 2, 3)]) / 9.80665
    random = np.random.default_rng(7)
    air = [level + 0.001 * random.standard_normal(1500) for level in (101.3, 40.0, 25.0)]
    text = written([np.arange(1500) / 100, *air, force])
    layout = told(drafted({"log.txt": text}, tmp_path))["instrument"]["format"]
    assert layout["accelerometer"] == {"columns": [5, 6, 7], "unit": "g"}


def test_readings_divided_by_the_size_of_another_range_are_asked_about(tmp_path):
    log = by_hand_log(8)
    time = np.arange(len(log.force)) / RATE
    rate = np.degrees(log.rate) / 2
    folder = drafted({"log.txt": written([time, log.force, rate])}, tmp_path)
    gyros = told(folder)["instrument"]["format"]["gyro"]
    assert gyros["unit"] == "deg/s" and gyros["counts_per_unit"] == pytest.approx(0.5, rel=0.03)
    assert "divided by the size of another range, off by the factor 0.5" in comments(folder)


def test_a_number_of_packets_is_no_clock(tmp_path):
    """Packets of other sensors count, too: steps of 1 to 3."""
    log = by_hand_log(9)
    number = np.cumsum(
        np.random.default_rng(9).choice([1, 2, 3], len(log.force), p=[0.6, 0.3, 0.1])
    )
    head = "Packet number,ax,ay,az,gx,gy,gz\n"
    text = head + written([number, log.force, log.rate], digits=9)
    folder = drafted({"log.csv": text}, tmp_path)
    assert told(folder)["instrument"]["format"]["time"] == {
        "rate_hz": pytest.approx(RATE, rel=0.05)
    }
    assert "how many samples a second" in comments(folder)


def test_names_that_state_how_they_are_printed_are_names(tmp_path):
    log = by_hand_log(10)
    sensors = {"RawCompass": log.field, "RawGyro": log.rate, "RawAccel": log.force / 9.80665}
    names = [f"%float({name}{axis})" for name in sensors for axis in "XYZ"]
    head = ",".join(["%int(TimeUS)", *names]) + "\n"
    time = np.arange(len(log.force)) * 10_000
    text = head + written([time, *sensors.values()], digits=9)
    folder = drafted({"log.txt": text}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["accelerometer"]["columns"] == names[6:]
    assert layout["gyro"]["columns"] == names[3:6]
    assert "by their names" in comments(folder)


def test_few_means_without_a_sigma_are_asked_for_it(tmp_path):
    means = np.array([(s * e).tolist() for e in np.eye(3) for s in (9.81, -9.79)] * 2)
    means += 0.01 * np.random.default_rng(11).standard_normal(means.shape)
    folder = drafted({"poses.csv": "acc_x,acc_y,acc_z\n" + written([means])}, tmp_path)
    assert told(folder)["plan"][0]["do"] == "positions"
    assert "poses.csv has 12 means, and fewer than 15 do not show their noise" in comments(folder)


def test_an_object_of_matlab_is_said_to_be_one(tmp_path):
    """A variable of class 17, opaque, which has no shape, as MATLAB writes tables."""
    head = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H2s", 0x0100, b"IM")
    flags = struct.pack("<IIII", 6, 8, 17, 0)
    words = b"".join(struct.pack("<II8s", 1, 8, word) for word in (b"t", b"MCOS", b"table"))
    log = tmp_path / "log.mat"
    log.write_bytes(head + struct.pack("<II", 14, len(flags + words)) + flags + words)
    with pytest.raises(Refusal, match="an object of MATLAB") as refusal:
        draft([log], "drafted", tmp_path / "data")
    assert "matrices" in refusal.value.expected


# ---- what stands between fields and in clocks


def session(stamps: list[str], names: str, *, between: str) -> str:
    """A log with texts as stamps: three faces by accelerometers in mg, z first, at 50 Hz."""
    force = np.vstack([at_rest(FACES[i], 10, i) for i in (0, 2, 3)])[::2] * 1000 / 9.80665
    rows = [
        between.join([stamp, *(f"{value:.3f}" for value in row)])
        for stamp, row in zip(stamps, force[:, ::-1], strict=True)
    ]
    return "\n".join([names, *rows]) + "\n"


def clock(first_s: float, form: str) -> list[str]:
    """The time of the day of 1500 rows, 20 ms apart."""
    ms = np.round(1000 * first_s + 20 * np.arange(1500)).astype(int) % 86_400_000
    return [form.format(k // 3_600_000, k // 60_000 % 60, k // 1000 % 60, k % 1000) for k in ms]


def test_tabs_stand_between_names_that_hold_blanks(tmp_path):
    """Split at blanks the names did not fit; columns were x, y, z in the order of the file."""
    stamps = clock(9 * 3600, "2026-11-20T{:02}:{:02}:{:02}.{:03}")
    text = session(stamps, "time\tacc_z [mg]\tacc_y [mg]\tacc_x [mg]", between="\t")
    campaign = told(drafted({"log.tsv": text}, tmp_path))
    format_ = campaign["instrument"]["format"]
    assert format_["accelerometer"]["columns"] == ["acc_x [mg]", "acc_y [mg]", "acc_z [mg]"]
    assert [m["up"] for m in campaign["plan"]] == ["+z", "+y", "+x"]


@pytest.mark.parametrize(
    ("form", "first_s"),
    [
        ("{:02}:{:02}:{:02}.{:03}", 86_390),
        ("{:02}:{:02}:{:02},{:03}", 0),
        ("{}:{:02}:{:02}.{:03}", 9),
    ],
)
def test_the_time_of_the_day_is_a_clock_also_at_midnight(tmp_path, form, first_s):
    text = session(clock(first_s, form), "Time;z;y;x", between=";")
    folder = drafted({"log.csv": text}, tmp_path)
    time = told(folder)["instrument"]["format"]["time"]
    assert time == {"column": "Time", "unit": "iso8601", "wraps_at": 86_400 * 10**9}
    results = chain.run(folder, tmp_path / "derived", "decode")
    taken = results["decode/samples"]["time"].to_numpy()
    assert len(taken) == 1500 and np.diff(taken).min() >= 0 and 29 <= np.ptp(taken) <= 30


def test_a_column_that_is_filled_now_and_then_labels_nothing(tmp_path):
    """A pressure in every tenth row ended the draft with an exception."""
    rows = session(clock(5, "{:02}:{:02}:{:02}.{:03}"), "Time,z,y,x", between=",").splitlines()
    filled = [f"{row},{1013 if k % 10 == 0 else ''}" for k, row in enumerate(rows[1:])]
    text = "\n".join(["Time,z,y,x,Pressure", *filled]) + "\n"
    campaign = told(drafted({"log.csv": text}, tmp_path))
    assert "label" not in campaign["instrument"]["format"] and len(campaign["plan"]) == 3


def test_a_temperature_that_rises_is_no_clock_where_milliseconds_are(tmp_path):
    """As `T` it was taken for the time, and all of the log "moves"."""
    force = np.vstack([at_rest(FACES[i], 10, i) for i in range(3)])
    warm = np.round(np.linspace(25, 27, len(force)), 2)
    rows = np.column_stack([1034 + 10 * np.arange(len(force)), force, warm])
    text = "".join("ms:{:.0f} ax:{:.3f} ay:{:.3f} az:{:.3f} T:{:.2f}\n".format(*r) for r in rows)
    campaign = told(drafted({"log.txt": text}, tmp_path))
    assert campaign["instrument"]["format"]["time"] == {"column": "ms", "unit": "ms"}
    assert len(campaign["plan"]) == 3


def test_a_clock_that_starts_anew_is_told(tmp_path):
    stamps = [f"{20 * (k if k < 900 else k - 900)}" for k in range(1500)]
    folder = drafted({"log.csv": session(stamps, "ms,z,y,x", between=",")}, tmp_path)
    assert "goes back by 18.0 s before row 901" in comments(folder)


# ---- a journey before or after a calibration

ONE_ROUND = 8.0  # s


def faces_and_turns() -> Rates:
    """Six faces from z up on, on z and y with a round there and back."""
    told: Rates = []
    for axis, to_next in (
        (2, (1, 0, 0)),
        (1, (0, 0, 1)),
        *[(None, (0, 0, 1))] * 2,
        (None, (0, 1, 0)),
    ):
        told.append((10, (0, 0, 0)))
        for way in () if axis is None else (1, -1):
            turn = way * np.eye(3)[axis] * 2 * np.pi / ONE_ROUND
            told += [(ONE_ROUND, tuple(turn)), (5, (0, 0, 0))]
        told.append((2, tuple(np.array(to_next) * np.pi / 4)))
    return [*told, (10, (0, 0, 0))]


def journey(seed: int) -> Rates:
    """Some minutes of motions about any axis, and stops between them."""
    random = np.random.default_rng(seed)
    told: Rates = []
    for number in range(61):
        seconds, rate = (random.uniform(2, 8), 0.0) if number % 2 else (random.uniform(8, 14), 0.5)
        told.append((float(seconds), tuple(rate * random.standard_normal(3))))
    return told


@pytest.mark.slow
@pytest.mark.parametrize("first", [True, False])
def test_a_journey_beside_a_calibration_is_left_out_and_told(tmp_path, first):
    """It made "positions" of the whole log, without a face or a turn."""
    both = [moved(faces_and_turns()), moved(journey(2))]
    log = np.vstack(both if first else both[::-1])
    log[:, 0] = np.arange(len(log)) / 100
    folder = drafted({"trip.csv": "t,ax,ay,az,gx,gy,gz\n" + written([log])}, tmp_path)
    plan = told(folder)["plan"]
    assert {m["do"] for m in plan} == {"rest", "turn"}
    assert {m["up"] for m in plan} == {sign + axis for axis in "xyz" for sign in "+-"}
    assert sum(m["do"] == "turn" and abs(m["degrees"]) == 360 for m in plan) >= 4
    assert "% of it, are in no manoeuvre of the plan" in comments(folder)


def test_rows_that_alternate_are_samples_of_both_sensors(tmp_path):
    """The plan counted lines, of which a sample has two: its manoeuvres were elsewhere."""
    log = moved(faces_and_turns())
    plain = {"plain.csv": "t,ax,ay,az,gx,gy,gz\n" + written([log])}
    lines = [
        f"{t + late:.3f},{sensor},{x:.5f},{y:.5f},{z:.5f}\n"
        for t, *both in log.tolist()
        for sensor, late, (x, y, z) in (("ACC", 0, both[:3]), ("GYR", 0.003, both[3:]))
    ]
    alternating = {"log.csv": "t,sensor,x,y,z\n" + "".join(lines)}
    (tmp_path / "plain").mkdir()
    right = [m.get("rows") for m in told(drafted(plain, tmp_path / "plain"))["plan"]]
    folder = drafted(alternating, tmp_path)
    assert [m.get("rows") for m in told(folder)["plan"]] == right
    results = chain.run(folder, tmp_path / "derived", "segment")
    assert results["segment/segments"]["to_record"].max() <= len(log)
    assert results["segment/findings"].empty


# ---- faces by hand


def test_the_sigma_of_faces_that_lean_is_by_how_much_they_lean(tmp_path):
    """Each leans by 3° about both level axes, one way or the other; sensors have biases of 2°."""
    lean, bias = np.tan(np.radians(3)), np.array([0.3, -0.2, 0.3])
    signs = iter([1, -1, -1, 1, 1, 1, -1, -1, 1, -1, -1, 1])
    rests = []
    for face in np.vstack([np.eye(3), -np.eye(3)]):
        away = np.array([0.0 if along else next(signs) * lean for along in face])
        rests.append(at_rest(tuple(face + away), 5, len(rests)) + bias)
    force = np.vstack(rests)
    time = np.arange(len(force)) / 100
    table = told(drafted({"f.csv": "t,ax,ay,az\n" + written([time, force])}, tmp_path))["table"]
    assert 3 * 3600 <= table["position_sigma_arcsec"] <= 3.5 * 3600


# ---- clocks that are coarse, and what a phone makes of its readings


def test_stamps_of_whole_seconds_are_many_samples_each(tmp_path):
    time = np.floor(0.37 + np.arange(2075) / 100)
    force = np.vstack([at_rest(FACES[i % 4], 5.2, i) for i in range(4)])[: len(time)]
    folder = drafted({"f.csv": "t_s,ax,ay,az\n" + written([time, force])}, tmp_path)
    assert "at 100.0 Hz" in comments(folder)


def test_what_a_phone_has_processed_comes_after_what_its_sensors_read(tmp_path):
    log = moved(faces_and_turns())
    noise = 0.01 * np.random.default_rng(2).standard_normal((2, len(log), 3))
    names = [
        f"{sensor}{axis}"
        for sensor in (
            "motionUserAcceleration",
            "motionRotationRate",
            "accelerometerAcceleration",
            "gyroRotation",
        )
        for axis in "XYZ"
    ]
    columns = [log[:, 0], *noise, log[:, 1:]]
    head = ",".join(["time_s", *names]) + "\n"
    folder = drafted({"phone.csv": head + written(columns)}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["accelerometer"]["columns"] == names[6:9]
    assert layout["gyro"]["columns"] == names[9:]


@pytest.mark.parametrize("name", ["die_degC", "T_C", "Tmp [°C]", "celsius"])
def test_a_temperature_is_known_by_its_unit_too(tmp_path, name):
    force = np.vstack([at_rest(FACES[i % 4], 5, i) for i in range(4)])
    time = np.arange(len(force)) / 100
    warm = 25 + 2 * np.sin(time / 7)
    head = f"time_s,ax,ay,az,{name}\n"
    folder = drafted({"f.csv": head + written([time, force, warm])}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["temperature"] == {"column": name, "unit": "degC"}

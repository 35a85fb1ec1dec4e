"""`make draft`: which columns are the sensors, by names of all kinds, and of which IMU."""

import numpy as np
import pytest
from drafting import comments, drafted, told, written
from logs_by_hand import by_hand_log
from moved_by_hand import RATE


def logged(names: str, *columns: np.ndarray, digits: int = 7) -> str:
    """A log with a time in s at 100 Hz and these columns behind it."""
    time = np.arange(len(columns[0])) / RATE
    return f"t,{names}\n" + written([time, *columns], digits=digits)


# ---- axes in names


@pytest.mark.parametrize(
    "names",
    [
        "X_ACCL,Y_ACCL,Z_ACCL,X_GYRO,Y_GYRO,Z_GYRO",
        "X_ACCL_OUT,Y_ACCL_OUT,Z_ACCL_OUT,X_GYRO_OUT,Y_GYRO_OUT,Z_GYRO_OUT",
        "xAccel,yAccel,zAccel,xGyro,yGyro,zGyro",
        "x acceleration,y acceleration,z acceleration,"
        "x angular velocity,y angular velocity,z angular velocity",
        "AccelX,AccelY,AccelZ,RollRate,PitchRate,YawRate",
        "ax,ay,az,rate_roll,rate_pitch,rate_yaw",
        "ax,ay,az,p,q,r",
        "ax,ay,az,rate_p,rate_q,rate_r",
        "acc_fwd,acc_right,acc_down,gyr_p,gyr_q,gyr_r",
        "Forward Accel (g),Right Accel (g),Down Accel (g),p,q,r",
        "acc_front,acc_left,acc_up,gyro_front,gyro_left,gyro_up",
    ],
)
def test_the_axis_stands_before_the_sensor_or_is_a_word(names, tmp_path):
    """The y of "gyro" and of "velocity" was taken for the axis."""
    log = by_hand_log(20)
    folder = drafted({"log.csv": logged(names, log.force, np.degrees(log.rate))}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["accelerometer"] == {"columns": names.split(",")[:3], "unit": "m/s2"}
    assert layout["gyro"] == {"columns": names.split(",")[3:], "unit": "deg/s"}
    assert "by their names" in comments(folder)


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ("acc_right,acc_fwd,acc_down", "x forward, y right and z down"),
        ("acc_left,acc_forward,acc_up", "x forward, y left and z up"),
    ],
)
def test_directions_are_axes_and_the_draft_says_which(names, said, tmp_path):
    """At rest nothing else tells them: the draft said that no accelerometers were recorded."""
    noise = 0.001 * np.random.default_rng(23).standard_normal((2000, 6))
    text = logged(f"{names},gyr_p,gyr_q,gyr_r", noise + 9.8 * np.eye(6)[1])
    folder = drafted({"log.csv": text}, tmp_path)
    right, forward, down = names.split(",")
    layout, told_of = told(folder)["instrument"]["format"], comments(folder)
    assert layout["accelerometer"] == {"columns": [forward, right, down], "unit": "m/s2"}
    assert layout["gyro"]["columns"] == ["gyr_p", "gyr_q", "gyr_r"]
    assert f"{forward}, {right}, {down}: taken for {said} by their names" in told_of
    assert "none are recorded" not in told_of and "not used" not in told_of
    assert "gyros: the largest reading is 0.00" in told_of
    assert [m["up"] for m in told(folder)["plan"]] == ["+x"]


@pytest.mark.parametrize("between", [",", "\t"])
def test_the_names_stand_above_the_units(between, tmp_path):
    """By number the axes were taken in the order of the columns: z, y, x."""
    log = by_hand_log(20)
    names = "t,az,ay,ax,gz,gy,gx\ns,m/s2,m/s2,m/s2,deg/s,deg/s,deg/s\n"
    time = np.arange(len(log.force)) / RATE
    rows = written([time, log.force[:, ::-1], np.degrees(log.rate)[:, ::-1]])
    text = ("Logger 3\n" + names + rows).replace(",", between)
    folder = drafted({"log.csv": text}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["header_lines"] == 3
    assert layout["accelerometer"]["columns"] == ["ax", "ay", "az"]
    assert layout["gyro"]["columns"] == ["gx", "gy", "gz"]
    assert "gyro.axes" not in comments(folder)


def test_roll_pitch_and_yaw_alone_are_angles(tmp_path):
    """Beside rates whose names say nothing, in an order of their own."""
    log = by_hand_log(21)
    angle = np.degrees(np.arctan2(log.force[:, [1, 0, 2]], log.force[:, [2, 2, 0]]))
    names = "Roll,Pitch,Yaw,acc_x,acc_y,acc_z,u,v,w"
    text = logged(names, angle, log.force, np.degrees(log.rate))
    folder = drafted({"log.csv": text}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["accelerometer"]["columns"] == ["acc_x", "acc_y", "acc_z"]
    assert layout["gyro"] == {"columns": ["u", "v", "w"], "unit": "deg/s"}
    assert "by the motion" in comments(folder)


def test_columns_without_a_sensor_are_no_gyros(tmp_path):
    """Pressure, humidity and temperature beside named accelerometers."""
    log = by_hand_log(22)
    air = np.array([101.3, 40.0, 25.0]) + 0.01 * np.random.default_rng(22).standard_normal(
        log.force.shape
    )
    text = logged("ax,ay,az,pressure,humidity,temperature", log.force, air)
    layout = told(drafted({"log.csv": text}, tmp_path))["instrument"]["format"]
    assert layout["accelerometer"]["columns"] == ["ax", "ay", "az"] and "gyro" not in layout


# ---- an axis that is constant


def test_a_gyro_that_reads_the_same_in_all_rows_is_asked_about(tmp_path):
    """The other two were dropped with it."""
    log = by_hand_log(23)
    rate = np.degrees(log.rate)
    rate[:, 1] = 0.35
    text = logged("ax,ay,az,gx,gy,gz", log.force, rate)
    folder = drafted({"log.csv": text}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["gyro"] == {"columns": ["gx", "gy", "gz"], "unit": "deg/s"}
    assert "gy of log.csv reads the same in all rows; is this axis dead" in comments(folder)
    assert "gyros: none are recorded" not in comments(folder)


def test_three_constant_columns_are_no_sensor(tmp_path):
    log = by_hand_log(24)
    text = logged("ax,ay,az,gx,gy,gz", log.force, np.zeros_like(log.force))
    folder = drafted({"log.csv": text}, tmp_path)
    assert "gyro" not in told(folder)["instrument"]["format"]
    assert "the same in all rows" not in comments(folder)


# ---- two IMUs in one log


@pytest.mark.parametrize(
    "names",
    [
        "imu0_a{},imu0_g{},imu1_a{},imu1_g{}",
        "acc1_{},gyro1_{},acc2_{},gyro2_{}",
        "left.accel.{},left.gyro.{},right.accel.{},right.gyro.{}",
    ],
)
def test_of_two_imus_one_is_taken_and_the_other_told(names, tmp_path):
    log = by_hand_log(25)
    first, second, third, fourth = (
        [name.format(axis) for axis in "xyz"] for name in names.split(",")
    )
    head = ",".join([*third, *first, *second, *fourth])
    rate = np.degrees(log.rate)
    columns = [1.01 * log.force, log.force, rate, 1.01 * rate]
    folder = drafted({"log.csv": logged(head, *columns)}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["accelerometer"]["columns"] == third
    assert layout["gyro"]["columns"] == fourth
    said, others = comments(folder), ", ".join([*first, *second])
    assert f"log.csv holds other accelerometers and gyros, {others}; the draft takes" in said
    assert f"not used: {others}" in said


def test_what_a_filter_made_of_an_imu_is_no_second_one(tmp_path):
    log = by_hand_log(26)
    noise = 0.01 * np.random.default_rng(26).standard_normal(log.force.shape)
    names = "lin_ax,lin_ay,lin_az,ax,ay,az,gx,gy,gz"
    folder = drafted({"log.csv": logged(names, noise, log.force, log.rate)}, tmp_path)
    layout = told(folder)["instrument"]["format"]
    assert layout["accelerometer"]["columns"] == ["ax", "ay", "az"]
    assert "holds other" not in comments(folder)


# ---- units in names, where nothing turns


@pytest.mark.parametrize(
    ("unit", "right"),
    [
        ("deg/h", {"unit": "deg/s", "counts_per_unit": 3600}),
        ("°/h", {"unit": "deg/s", "counts_per_unit": 3600}),
        ("Grad/s", {"unit": "deg/s"}),
        ("mrad/s", {"unit": "rad/s", "counts_per_unit": 1000}),
    ],
)
def test_gyros_that_do_not_turn_have_the_unit_in_their_names(unit, right, tmp_path):
    """Those in °/h were taken for °/s, and those in Grad/s for rad/s."""
    random = np.random.default_rng(24)
    force = np.array([0.0, 0.0, 9.81]) + 0.01 * random.standard_normal((1000, 3))
    rate = np.array([3.0, -2.0, 1.0]) + 0.1 * random.standard_normal((1000, 3))
    names = "ax,ay,az," + ",".join(f"gyro_{axis} [{unit}]" for axis in "xyz")
    folder = drafted({"log.csv": logged(names, force, rate)}, tmp_path)
    gyro = told(folder)["instrument"]["format"]["gyro"]
    assert {key: value for key, value in gyro.items() if key != "columns"} == right


@pytest.mark.parametrize(("unit", "count"), [("deg/h", 3600), ("mdps", 1000)])
def test_gyros_that_turn_in_a_part_of_a_unit_are_in_no_unknown_one(unit, count, tmp_path):
    log = by_hand_log(25)
    names = "ax,ay,az," + ",".join(f"g{axis}_{unit}" for axis in "xyz")
    text = logged(names, log.force, np.rint(np.degrees(log.rate) * count))
    folder = drafted({"log.csv": text}, tmp_path)
    gyro = told(folder)["instrument"]["format"]["gyro"]
    assert (gyro["unit"], gyro["counts_per_unit"]) == ("deg/s", count)
    assert "in no usual unit" not in comments(folder)

"""Logs as people have them on their disks: draft, chain and check give the truth in them."""

import json
from collections.abc import Callable, Mapping

import chain
import numpy as np
import pytest
from logs_by_hand import ByHand, by_hand_log
from moved_by_hand import GRAVITY, RATE

from commands import check
from commands.draft.__main__ import draft
from inertial.estimation.triad import linear_names
from inertial.tables.errors import Refusal

MAX_SIGMA = 4.5  # of some twenty parameters with Gaussian errors, in 1 of 6000 campaigns
G = 9.80665
Files = Mapping[str, str | bytes]


def rows(form: str, *columns: np.ndarray, head: str = "", end: str = "\n") -> str:
    """A line for each sample, after the header."""
    lines = [form % row for row in zip(*(c.tolist() for c in columns), strict=True)]
    return end.join([*([head] if head else []), *lines, ""])


def axes(values: np.ndarray, size: float = 1.0) -> list[np.ndarray]:
    return [*(values / size).T]


def counts(values: np.ndarray, size: float) -> list[np.ndarray]:
    return [*np.rint(values / size).astype(int).T]


def stamps(log: ByHand, unit: float = 1.0) -> np.ndarray:
    return np.arange(len(log.force)) / RATE * unit


# ---- one function a form; values are those of the log, in SI


def serial_labels(log: ByHand) -> Files:
    """As a sketch prints them: `ax:0.12 ay:…`, after a word of greeting."""
    form = "ax:%.5f ay:%.5f az:%.5f gx:%.6f gy:%.6f gz:%.6f"
    text = rows(form, *axes(log.force, G), *axes(np.degrees(log.rate)), end="\r\n")
    return {"serial.txt": "MPU6050 ready\r\n" + text}


def labels_of_counts(log: ByHand) -> Files:
    """`t=0, ax = -12, …`: whole numbers between commas, with a time in ms."""
    form = "t=%d, ax = %d, ay = %d, az = %d, gx = %d, gy = %d, gz = %d"
    columns = [*counts(log.force, G / 16384), *counts(np.degrees(log.rate), 1 / 131)]
    return {"putty.log": rows(form, np.rint(stamps(log, 1e3)).astype(int), *columns)}


def json_lines(log: ByHand) -> Files:
    """An object a line, its time a date."""
    names = ("ax", "ay", "az", "gx", "gy", "gz")
    start = np.datetime64("2026-03-01T10:00:00.000")
    dates = start + np.rint(stamps(log, 1e3)).astype("timedelta64[ms]")
    lines = [
        json.dumps({"time": str(date)} | dict(zip(names, row, strict=True)))
        for date, row in zip(dates, np.hstack([log.force, log.rate]).tolist(), strict=True)
    ]
    return {"log.jsonl": "\n".join(lines)}


def phone(log: ByHand) -> Files:
    """A file for each sensor, z before x, two clocks, and gyros twice as fast, begun later."""
    head, form = "time,seconds_elapsed,z,y,x", "%d,%.7f,%.6f,%.6f,%.6f"
    start, time, fast = 1_700_000_000_000_000_000, stamps(log), log.rate
    when = start + np.rint(time * 1e9).astype(np.int64)
    half = np.arange(0, len(time) - 1, 2)
    force = (log.force[half] + log.force[half + 1]) / 2
    middle = when[half] + int(5e8 / RATE)
    return {
        "Accelerometer.csv": rows(form, middle, time[half], *axes(force[:, ::-1]), head=head),
        "Gyroscope.csv": rows(form, when[40:], time[40:], *axes(fast[40:, ::-1]), head=head),
    }


def either_sensor(log: ByHand) -> Files:
    """As a phone writes both into one file: a row holds either, with its name."""
    lines = []
    for time, force, rate in zip(stamps(log), log.force, log.rate, strict=True):
        for late, word, values in ((0, "ACC", force), (1_300_000, "GYR", rate)):
            numbers = ",".join(f"{value:.6f}" for value in values)
            lines.append(f"{round(time * 1e9) + 10**14 + late},{word},{numbers}")
    return {"sensors.csv": "\n".join(lines)}


def micros(log: ByHand) -> Files:
    """A counter of µs in 32 bits that begins again on the way."""
    ticks = (np.rint(stamps(log, 1e6)).astype(np.int64) + 2**32 - 20_000_000) % 2**32
    head = "micros;ax;ay;az;gx;gy;gz"
    columns = [*axes(log.force), *axes(np.degrees(log.rate))]
    return {"log.csv": rows("%d" + ";%.6f" * 6, ticks, *columns, head=head)}


def without_sign(log: ByHand) -> Files:
    """Registers of 16 bits printed as if they had no sign."""
    values = [*counts(log.force, G / 8192), *counts(np.degrees(log.rate), 1 / 65.5)]
    columns = [stamps(log), *(column % 65536 for column in values)]
    return {"raw.csv": rows("%.2f" + ",%d" * 6, *columns, head="t,ax,ay,az,gx,gy,gz")}


def units_in_header(log: ByHand) -> Files:
    """mg and mdps by their names, BOM and CRLF."""
    head = "T [ms],AccX [mg],AccY [mg],AccZ [mg],GyroX [mdps],GyroY [mdps],GyroZ [mdps]"
    columns = [*axes(log.force, G / 1e3), *axes(np.degrees(log.rate), 1e-3)]
    text = rows("%d" + ",%.2f" * 6, stamps(log, 1e3), *columns, head=head, end="\r\n")
    return {"st.csv": b"\xef\xbb\xbf" + text.encode()}


def quoted(log: ByHand) -> Files:
    """Numbers in quotation marks, and degrees in the header as Windows writes them."""
    head = "time;ax (g);ay (g);az (g);gx (°/s);gy (°/s);gz (°/s)"
    columns = [stamps(log), *axes(log.force, G), *axes(np.degrees(log.rate))]
    return {"export.csv": rows(";".join(['"%.5f"'] * 7), *columns, head=head).encode("cp1252")}


def ros_export(log: ByHand) -> Files:
    """rostopic echo -p: orientation before the rates, covariances, a name of the frame."""
    field = "field.{}.x,field.{}.y,field.{}.z"
    head = ",".join(
        (
            "%time,field.header.seq,field.header.stamp,field.header.frame_id",
            *(f"field.orientation.{c}" for c in "xyzw"),
            field.replace("{}", "angular_velocity"),
            "field.angular_velocity_covariance0",
            field.replace("{}", "linear_acceleration"),
        )
    )
    when = 1_600_000_000_000_000_000 + np.rint(stamps(log, 1e9)).astype(np.int64)
    number = np.arange(len(when))
    turned = np.random.default_rng(0).standard_normal((len(when), 4))
    form = "%d,%d,%d,imu_link" + ",%.6f" * 7 + ",-1" + ",%.6f" * 3
    columns = [when, number, when, *axes(turned), *axes(log.rate), *axes(log.force)]
    return {"imu_data.csv": rows(form, *columns, head=head)}


def beside_others(log: ByHand) -> Files:
    """Quaternion and magnetometer between accelerometers and gyros."""
    other = np.random.default_rng(0).standard_normal((len(log.force), 4))
    head = "timestamp,qw,qx,qy,qz,accel_x,accel_y,accel_z,mag_x,mag_y,mag_z,gyro_x,gyro_y,gyro_z"
    columns = [stamps(log), *axes(other), *axes(log.force), *axes(log.field), *axes(log.rate)]
    return {"fusion.csv": rows("%.3f" + ",%.6f" * 13, *columns, head=head)}


def damaged(log: ByHand) -> Files:
    """The header again in the middle, a blank line, nan, a row cut off, two rows exchanged."""
    head = "time,ax,ay,az,gx,gy,gz"
    columns = [stamps(log), *axes(log.force), *axes(log.rate)]
    lines = rows("%.2f" + ",%.6f" * 6, *columns, head=head).splitlines()
    lines[700], lines[900], lines[1100] = "6.99,nan,nan,nan,nan,nan,nan", "", lines[1100][:30]
    lines[2000:2000] = [head]
    lines[3000], lines[3001] = lines[3001], lines[3000]
    return {"log.csv": "\n".join(lines)}


FORMS: tuple[Callable[[ByHand], Files], ...] = (
    serial_labels,
    labels_of_counts,
    json_lines,
    phone,
    either_sensor,
    micros,
    without_sign,
    units_in_header,
    quoted,
    ros_export,
    beside_others,
    damaged,
)


@pytest.mark.slow
@pytest.mark.parametrize(
    "form",
    [pytest.param(form, id=form.__name__) for form in FORMS],
)
def test_a_log_gives_its_truth_by_draft_and_check(form, tmp_path):
    log = by_hand_log(7)
    for name, content in form(log).items():
        (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    logs = sorted(path for path in tmp_path.iterdir() if path.is_file())
    folder = draft(logs, "drafted", tmp_path / "data", RATE if form is serial_labels else None)
    derived = tmp_path / "data/derived/drafted"
    results = chain.run(folder, derived)
    assert_truth(results, log)
    assert not check.recording_of(derived).spoiled


def assert_truth(results: chain.Results, log: ByHand) -> None:
    """The free parameters of both sensors, and biases in SI."""
    names = [f"symmetric_{pair}" for pair in ("xx", "yy", "zz", "xy", "xz", "yz")]
    accel = results.parameters("accelerometer", "free_positions")
    found = accel.loc[[*names, "bias_x", "bias_y", "bias_z"]]
    right = log.imu.free - np.array([1, 1, 1, 0, 0, 0, 0, 0, 0])
    assert abs(G - GRAVITY) < 0.03  # what the draft guesses, and its sigma
    assert np.abs((found["value"] - right) / found["sigma"]).max() < MAX_SIGMA
    gyro = results.parameters("gyroscope", "free_positions").loc[list(linear_names())]
    right = log.imu.rates - np.append(np.eye(3).ravel(), np.zeros(3))
    assert np.abs((gyro["value"] - right) / gyro["sigma"]).max() < MAX_SIGMA
    assert (gyro["sigma"] < 0.01).all()


def test_accelerations_without_gravity_are_refused(tmp_path):
    """What phones call linear acceleration."""
    log = by_hand_log(7)
    moved = 0.3 * np.random.default_rng(0).standard_normal(log.force.shape)
    head = "time,lin_acc_x,lin_acc_y,lin_acc_z,gx,gy,gz"
    text = rows("%.3f" + ",%.6f" * 6, stamps(log), *axes(moved), *axes(log.rate), head=head)
    (tmp_path / "linear.csv").write_text(text)
    with pytest.raises(Refusal, match="no gravity"):
        draft([tmp_path / "linear.csv"], "drafted", tmp_path / "data")


def test_counts_without_sign_that_are_not_said_to_be_are_refused(tmp_path):
    """By their leaps over the whole range, with the key that undoes them."""
    (content,) = without_sign(by_hand_log(7)).values()
    (tmp_path / "raw.csv").write_text(str(content))
    folder = draft([tmp_path / "raw.csv"], "drafted", tmp_path / "data")
    file = folder / "campaign.yaml"
    assert file.read_text().count(", signed_bits: 16") == 2
    file.write_text(file.read_text().replace(", signed_bits: 16", ""))
    with pytest.raises(Refusal, match="signed_bits: 16 to accelerometer"):
        chain.run(folder, tmp_path / "derived", "decode")

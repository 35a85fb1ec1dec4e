"""What is put into the bytes of a log is in its readings, and nothing else is."""

import numpy as np
import pytest

from injections.injected import drawn, outcome
from injections.rewritten_logs import columns_of, rewritten

COUNTS = {
    "delimiter": ",",
    "header_lines": 1,
    "accelerometer": {"columns": ["ax", "ay", "az"], "unit": "g", "counts_per_unit": 2048},
    "gyro": {"columns": ["gx", "gy", "gz"], "unit": "deg/s", "counts_per_unit": 16.4},
}
SPACED = {
    "comment": "#",
    "accelerometer": {"columns": [2, 3, 4], "unit": "m/s2"},
    "gyro": {"columns": [5, 6, 7], "unit": "rad/s"},
}
A_COUNTS = "n,gx,gy,gz,ax,ay,az\r\n" + "".join(
    f"{i},{i}.0,-2.0,{7 - i}.0,2051,-{i},12\r\n" for i in range(9)
)
A_SPACED = "# time tx ty tz\n" + "".join(
    f"{i}.5\t0.10{i}  -9.8102 0.0  0.001 1e-3 -0.2\n" for i in range(9)
)
ZERO = {"accelerometer": np.zeros((9, 3)), "gyro": np.zeros((9, 3))}


@pytest.mark.parametrize(("layout", "text"), [(COUNTS, A_COUNTS), (SPACED, A_SPACED)])
def test_nothing_added_changes_no_byte(tmp_path, layout, text):
    log = tmp_path / "log.csv"
    log.write_bytes(text.encode())
    rewritten(log, layout, range(2, 11), ZERO)
    assert log.read_bytes() == text.encode()


def test_what_is_added_is_read_to_half_of_the_last_decimal(tmp_path):
    log, random = tmp_path / "log.csv", np.random.default_rng(4)
    log.write_bytes(A_COUNTS.encode())
    added = {sensor: random.normal(0, 30, (9, 3)) for sensor in ZERO}
    rewritten(log, COUNTS, range(2, 11), added)
    before = np.array([line.split(",") for line in A_COUNTS.split()[1:]], float)
    after = np.array([line.split(",") for line in log.read_text().split()[1:]], float)
    change, places = after - before, columns_of(COUNTS, A_COUNTS.split())
    assert not change[:, 0].any()  # its number
    np.testing.assert_allclose(
        change[:, places["accelerometer"]], added["accelerometer"], atol=0.5 + 1e-9
    )
    np.testing.assert_allclose(change[:, places["gyro"]], added["gyro"], atol=0.05 + 1e-9)
    assert log.read_bytes().count(b"\r\n") == 10


def test_a_number_draws_one_injection():
    every = [drawn(number) for number in range(110)]
    assert [(one.recording, one.name, one.ratio) for one in every[:5]] == [
        (one.recording, one.name, one.ratio) for one in map(drawn, range(5))
    ]
    assert 15 < sum(one.is_fault for one in every) < 30


def test_a_recording_as_it_is_has_what_is_known_of_it(recordings):
    assert outcome(-11)["false"] == []  # mikoff-1


def test_an_effect_in_the_bytes_of_a_real_recording_is_found(recordings):
    own = (recordings / "mikoff_mpu9150/imu0.log").read_bytes()
    said = outcome(11)  # an asymmetry of the accelerometers of mikoff-1, at a ratio of 12
    assert said["name"] == "accel_scale_asymmetry" and said["recording"] == "mikoff-1"
    assert said["found"] and not said["beside"]
    assert (recordings / "mikoff_mpu9150/imu0.log").read_bytes() == own


def test_a_log_that_is_linked_is_not_written_through(tmp_path):
    original, log = tmp_path / "original.csv", tmp_path / "log.csv"
    original.write_bytes(A_COUNTS.encode())
    log.hardlink_to(original)
    rewritten(log, COUNTS, range(2, 11), {sensor: np.full((9, 3), 5.0) for sensor in ZERO})
    assert original.read_bytes() == A_COUNTS.encode() != log.read_bytes()

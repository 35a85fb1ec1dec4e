"""What is put into the bytes of a log is in its readings, and nothing else is."""

import numpy as np
import pytest
from scipy import stats

from injections.injected import Beside, drawn, outcome
from injections.rewritten_logs import held, rewritten

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
    rewritten(log, layout, range(2, 11), ZERO, np.random.default_rng(1))
    assert log.read_bytes() == text.encode()


def counts_of(size, lines, random):
    """A log in counts of a size, with 5 decimals, and its readings; in its last half at rest."""
    readings = np.round(random.normal(0, 3, (lines, 6))) * size
    readings[: lines // 2] += np.arange(lines // 2)[:, None] % 41 * size - 20 * size  # it moves
    text = "".join(" ".join(f"{value:.5f}" for value in row) + "\n" for row in readings)
    return text, np.array([line.split() for line in text.splitlines()], float)


PLAIN = {
    "accelerometer": {"columns": [1, 2, 3], "unit": "m/s2"},
    "gyro": {"columns": [4, 5, 6], "unit": "rad/s"},
}


def test_what_is_added_is_there_in_the_mean_though_it_is_less_than_a_count(tmp_path):
    log, random, size = tmp_path / "log.txt", np.random.default_rng(4), 0.0010642
    text, before = counts_of(size, 4000, random)
    log.write_text(text)
    error = np.zeros((4000, 3))
    error[2000:] = [0.3 * size, -0.05 * size, 4.5 * size]
    rewritten(log, PLAIN, range(1, 4001), {"gyro": error}, random)
    after = np.loadtxt(log)
    assert (after[:, :3] == before[:, :3]).all() and (after[:2000] == before[:2000]).all()
    change = (after - before)[2000:, 3:].mean(axis=0)
    np.testing.assert_allclose(change, error[-1], atol=4 * size / 2 / np.sqrt(2000))
    # No reading lies between two counts, so that no count seems smaller than it is.
    off = np.abs(after / size - np.round(after / size))
    assert off.max() < 0.011


def test_what_is_no_count_is_read_to_the_last_decimal_and_exponents_are_numbers(tmp_path):
    log, random = tmp_path / "log.txt", np.random.default_rng(5)
    before = random.normal(0, 1e-3, (500, 6))
    lines = [" ".join(f"{value:.13g}" for value in row) for row in before]
    lines[7] = "1e-3 2 3 -6.601453060284e-05 0.5000000000001 -0.6000000000001"
    before[7] = lines[7].split()
    log.write_text("\n".join(lines) + "\n")
    error = random.normal(0, 1e-3, (500, 3))
    rewritten(log, PLAIN, range(1, 501), {"gyro": error}, random)
    np.testing.assert_allclose(np.loadtxt(log)[:, 3:] - before[:, 3:], error, atol=1e-13)


def test_a_channel_that_is_held_is_written_alike_in_every_line(tmp_path):
    log = tmp_path / "log.txt"
    log.write_text(A_SPACED.replace(" -9.8102 ", " -9.81020 ", 1))
    held(log, SPACED, range(3, 11), ("accelerometer", 1))
    lines = log.read_text().splitlines()
    assert {line.split()[2] for line in lines[2:]} == {"-9.8102"}
    assert lines[1] == A_SPACED.replace(" -9.8102 ", " -9.81020 ", 1).splitlines()[1]


def test_the_limit_beside_a_scatter_is_that_of_the_f_test():
    """By the noncentral F distribution; and of noise alone where no scatter is supposed."""
    beside = Beside(13, 3, 1e-4)
    threshold = stats.f.isf(1e-4, 3, 10)
    for ratio in (5.0, 8.0, 20.0):
        truth = stats.ncf.sf(threshold, 3, 10, ratio**2)
        assert beside.power(ratio) == pytest.approx(truth, abs=0.02)
    assert beside.power(2.0, 3.0) > beside.power(2.0)
    assert Beside(5, 0, 1e-4).power(20.0) == 0


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
    added = {sensor: np.full((9, 3), 5.0) for sensor in ZERO}
    rewritten(log, COUNTS, range(2, 11), added, np.random.default_rng(1))
    assert original.read_bytes() == A_COUNTS.encode() != log.read_bytes()

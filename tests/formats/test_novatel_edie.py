"""novatel-edie, the receiver maker's own reader, reads the same numbers from the same logs.

It names the fields as they are sent, so its accel_y and gyro_y are minus those of the body's y.
"""

import numpy as np
import pytest
from novatel_edie import oem

from inertial.formats.gps_time import NANOSECONDS, WEEK
from inertial.formats.novatel.novatel_reader import read
from laboratory.rawimu import MESSAGES, Samples, log_bytes

N = 200
STEP = 5_000_000  # ns
FIELDS = ("accel_z", "accel_y", "accel_x", "gyro_z", "gyro_y", "gyro_x")


def by_edie(path):
    """Stamp, status and counts of all IMU messages of a log."""
    found = [m for m in oem.FileParser(str(path)) if type(m).__name__.startswith("RAWIMU")]
    # It reads the seconds as a double, which holds a week to 0.12 ns.
    stamps = [m.gps_week * WEEK * NANOSECONDS + round(m.gps_seconds * NANOSECONDS) for m in found]
    counts = [[getattr(m, field) for field in FIELDS] for m in found]
    return stamps, [m.imu_status for m in found], counts


def by_us(path):
    (reading,) = (one.records for one in read(path) if len(one.records.stamp))
    return reading.stamp.tolist(), reading.status.tolist(), reading.counts.tolist()


@pytest.mark.parametrize("message", MESSAGES)
def test_what_the_laboratory_writes_is_the_same_to_both(message, tmp_path):
    random = np.random.default_rng(3)
    counts = random.integers(-(2**31), 2**31, (2, N, 3))
    sent = Samples(2284 * WEEK * NANOSECONDS + STEP * (np.arange(N) - N // 2), *counts)
    path = tmp_path / "log"
    path.write_bytes(log_bytes(sent, message, "80150377", imu_type=33))
    assert by_us(path) == by_edie(path)
    assert by_us(path) == (sent.stamps.tolist(), [0x80150377] * N, sent.sent.tolist())


def test_y_is_sent_with_the_other_sign(tmp_path):
    path = tmp_path / "log"
    one = Samples(np.array([STEP]), np.array([[1, 2, 3]]), np.array([[4, 5, 6]]))
    path.write_bytes(log_bytes(one, "RAWIMUSA", "00000077"))
    (message,) = oem.FileParser(str(path))
    assert (message.accel_x, message.accel_y, message.accel_z) == (1, -2, 3)
    assert (message.gyro_x, message.gyro_y, message.gyro_z) == (4, -5, 6)


@pytest.mark.parametrize("name", ["rawimu_lines.txt", "rawimusx_short.bin"])
def test_real_samples_are_the_same_to_both(recordings, name):
    path = recordings / "novatel_samples" / name
    ours, theirs = by_us(path), by_edie(path)
    if name.endswith(".txt"):  # of several kinds of message we read the one that comes most often
        theirs = tuple(part[: len(ours[0])] for part in theirs)
    assert ours == theirs

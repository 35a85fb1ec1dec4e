"""The bytes of a log, against the two lines of raw data that S0 prints."""

import numpy as np

from laboratory.gps_time import WEEK, gps_nanoseconds
from laboratory.rawimu import Samples, log_bytes

PRINTED = (
    b"%RAWIMUSA,2283,42699.880;2283,42699.879998762,00000077,"
    b"64188,-64,465,-16100,-2,873*3928684b\r\n"
    b"%RAWIMUSA,2283,42711.860;2283,42711.859998756,00000077,"
    b"64186,-1,432,-16100,4,-1037*b6a6925a\r\n"
)


def test_s0_lines_2192_and_2193_byte_for_byte() -> None:
    samples = Samples(
        np.array([gps_nanoseconds(2283, s) for s in (42699.879998762, 42711.859998756)]),
        accelerometer=np.array([[465, 64, 64188], [432, 1, 64186]]),
        gyro=np.array([[873, 2, -16100], [-1037, -4, -16100]]),
    )
    assert log_bytes(samples, "RAWIMUSA", "00000077", b"\r\n") == PRINTED


def test_the_header_rounds_into_the_next_week_before_the_body_does() -> None:
    none = np.zeros((3, 3), dtype=np.int64)
    stamps = np.array([gps_nanoseconds(2283, WEEK - 0.0004 + 0.01 * k) for k in (-1, 0, 1)])
    lines = log_bytes(Samples(stamps, none, none), "RAWIMUSA", "00000077", b"\n").split(b"\n")
    assert lines[0].startswith(b"%RAWIMUSA,2283,604799.990;2283,604799.989600000,")
    assert lines[1].startswith(b"%RAWIMUSA,2284,0.000;2283,604799.999600000,")
    assert lines[2].startswith(b"%RAWIMUSA,2284,0.010;2284,0.009600000,")

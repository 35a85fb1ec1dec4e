"""The names of causes and effects as they are read, and how grave a finding is, in words."""

from __future__ import annotations

from collections.abc import Sequence

from inertial.text.numbers import counted, shortened, whole

# Where the identifier with spaces between its words would not do.
NAMES = {
    "accel_bias_jump": "accelerometer bias jump",
    "accel_bias_ramp": "accelerometer bias ramp",
    "accel_bias_temperature": "accelerometer bias with temperature",
    "accel_cross_products": "accelerometer cross products",
    "accel_cubic": "accelerometer cubic term",
    "accel_hysteresis": "accelerometer hysteresis",
    "accel_random_walk": "random walk of the accelerometer biases",
    "accel_saturation": "accelerometer saturation",
    "accel_scale_asymmetry": "accelerometer scale asymmetry",
    "accel_scale_temperature": "accelerometer scale factor with temperature",
    "accel_vibration_rectification": "vibration rectification of the accelerometers",
    "accel_warm_up": "accelerometer warm-up",
    "accel_drift": "drift of the accelerometers without a law",
    "accel_quadratic": "accelerometer quadratic term",
    "already_compensated": "compensated already",
    "clock_jitter": "jitter of the clock",
    "clock_step": "clock that was set",
    "clock_scale": "clock too fast or too slow",
    "duplicate": "repeated record",
    "earth_rate_omitted": "earth rate left out",
    "gravity_error": "wrong gravity",
    "gyro_accel_misalignment": "gyros rotated against accelerometers",
    "gyro_bias_temperature": "gyro bias with temperature",
    "gyro_drift": "drift of the gyros without a law",
    "gyro_g2_sensitivity": "gyro g²-sensitivity",
    "gyro_g_sensitivity": "gyro g-sensitivity",
    "gyro_random_walk": "random walk of the gyro biases",
    "gyro_scale_cubic": "gyro scale factor with the square of the rate",
    "gyro_scale_g_dependence": "gyro scale factor with acceleration",
    "gyro_scale_quadratic": "gyro scale factor with the rate",
    "gyro_scale_temperature": "gyro scale factor with temperature",
    "gyro_warm_up": "gyro warm-up",
    "heading_error": "wrong heading",
    "latitude_error": "wrong latitude",
    "rate_off": "another sample rate",
    "size_effect": "accelerometers apart from each other",
    "status_invalid": "invalid status",
    "table_angle_scale": "scale of the table's angle",
    "table_axis_non_orthogonality": "table axes out of square",
    "table_position_error": "set position that is off",
    "table_speed_error": "wrong speed of the table",
    "time_backwards": "time goes backwards",
    "unknown_structure": "structure without a name",
    "wrong_day": "another day",
    "wrong_imu_type": "another type of IMU",
}
GRAVITY = {3: "spoils a result", 2: "weakens a result", 1: "good to know"}


def in_words(cause: str) -> str:
    """The name of a cause or an effect as it is read."""
    return NAMES.get(cause) or shortened(cause.replace("_", " "), 60)


def how_grave(severity: int) -> str:
    """What a severity means."""
    return GRAVITY.get(severity, GRAVITY[1])


def tally(severities: Sequence[int]) -> str:
    """How many findings there are, and how many of them are how grave, in one sentence."""
    said = []
    result = "a result"
    for severity, one, many in (
        (3, "spoils {}", "spoil {}"),
        (2, "weakens {}", "weaken {}"),
        (1, "is good to know", "are good to know"),
    ):
        if count := sum(each == severity for each in severities):
            said.append(f"{whole(count)} {(one if count == 1 else many).format(result)}")
            result = "one"
    return f"{counted(len(severities), 'finding')}: {', '.join(said)}."

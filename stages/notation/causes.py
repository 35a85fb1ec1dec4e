"""The names of causes and effects as they are read, and how grave a finding is, in words."""

from __future__ import annotations

from collections.abc import Sequence

from stages.notation.numbers import counted, shortened, whole

# Where the identifier with spaces between its words would not do.
NAMES = {
    "accel_bias_ramp": "accelerometer bias ramp",
    "accel_quadratic": "accelerometer quadratic term",
    "already_compensated": "compensated already",
    "clock_jitter": "jitter of the clock",
    "clock_scale": "clock too fast or too slow",
    "duplicate": "repeated record",
    "gyro_g_sensitivity": "gyro g-sensitivity",
    "rate_off": "another sample rate",
    "status_invalid": "invalid status",
    "time_backwards": "time goes backwards",
    "wrong_day": "another day",
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

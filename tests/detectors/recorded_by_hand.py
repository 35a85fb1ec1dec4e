"""A log as arrays, without any file: what a detector is shown of it."""

import re
from typing import Any

import numpy as np

from inertial.signal.detector import Detector, Event, Given, Log, Piece, Windows

INTERVAL = 0.01  # s
GRAVITY = 9.7936174  # m/s²
NOISE = np.array([1.07e-3] * 3 + [3.49e-5] * 3)  # of S0's data at 100 Hz: m/s², rad/s
COUNT = np.array([1.52587890625e-6] * 3 + [1.0850694444444444e-7] * 3) / INTERVAL
COUNTS = {
    "imar-fsas": (1.52587890625e-6, 1.893803441834125e-9),
    "span-cpt": (1.52587890625e-6, 1.0850694444444444e-7),
    "xw-gi7681": (1.52587890625e-6, 1.0850694444444444e-7),
}
UNKNOWN = np.full(6, np.nan)


def given(**changes: Any) -> Given:
    """A campaign in Wuhan with an IMU of 100 Hz."""
    facts: dict[str, Any] = {
        "gravity": GRAVITY,
        "normal_gravity": 9.7935882,
        "interval": INTERVAL,
        "instrument": "NovAtel SPAN-CPT",
        "date": "2026-11-02",
        "must_be_set": 0x77,
        "must_be_clear": 0,
        "count_sizes": COUNTS,
    }
    return Given(**{**facts, **changes})


def rest(n: int, seed: int = 1, noise: np.ndarray = NOISE, count: np.ndarray = COUNT) -> np.ndarray:
    """Readings at rest, z up, in whole counts, (n, 6)."""
    generator = np.random.default_rng(seed)
    readings = np.array([0.02, -0.01, GRAVITY, 1e-6, 2e-6, 3e-5])
    return np.round((readings + noise * generator.standard_normal((n, 6))) / count) * count


def stamps(n: int, interval: float = INTERVAL) -> np.ndarray:
    """The stamps of an even clock, to 1 ns, (n,), s."""
    return np.round(np.arange(n) * interval, 9)


def piece(values: np.ndarray, time: np.ndarray | None = None, **changes: Any) -> Piece:
    """All of a log in one piece; no time if none is given."""
    n = len(values)
    columns: dict[str, Any] = {
        "record": np.arange(n),
        "line": np.arange(n) + 1,
        "time": np.full(n, np.nan) if time is None else time,
        "values": values,
        "status": np.full(n, float(0x77)),
        "temperature": np.full(n, np.nan),
        "first": 0,
        "after": n,
    }
    return Piece(**{**columns, **changes})


def log(one: Piece, campaign: Given | None = None, **changes: Any) -> Log:
    """What is known of the log that is this piece, from its own arrays."""
    values, time = one.values, one.time
    forward = np.diff(time)[np.diff(time) > 0]
    interval = float(np.median(forward)) if len(forward) else np.nan
    length = max(round(1 / interval), 1) if len(forward) else 1
    starts = np.arange(0, len(values), length)
    equal = np.full(6, np.nan)
    for i in range(6):
        own = values[np.isfinite(values[:, i]), i]
        if len(own) > 1:
            equal[i] = np.mean(own[1:] == own[:-1])

    def over(function: Any, columns: np.ndarray) -> np.ndarray:
        return np.array([function(columns[a : a + length], axis=0) for a in starts])

    with np.errstate(all="ignore"):
        facts: dict[str, Any] = {
            "name": "log",
            "given": campaign or given(),
            "interval": interval,
            "recorded_on": "2026-11-02",
            "quantum": COUNT,
            "noise": NOISE,
            "equal": equal,
            "least": np.fmin.reduce(values, axis=0),
            "most": np.fmax.reduce(values, axis=0),
            "limit": np.full(6, np.inf),
            "count": COUNT,
            "windows": Windows(
                over(np.mean, values),
                over(np.var, values),
                over(np.mean, time),
                over(np.mean, one.temperature),
            ),
            "records": len(values),
        }
    return Log(**{**facts, **changes})


def seen(
    detector: Detector, one: Piece, campaign: Given | None = None, **of_log: Any
) -> list[Event]:
    """What a detector sees in a log that is this piece; its words must be whole sentences."""
    whole = log(one, campaign, **of_log)
    events = [*detector.detect(one, whole), *detector.detect_in_log(whole)]
    for event in events:
        assert_told(detector, event, whole.name)
    return events


def assert_told(detector: Detector, event: Event, name: str) -> None:
    """What it says of an event is in whole sentences, without a number that is none."""
    words = detector.describe(event, name)
    for text in (words.sentence, words.consequence, words.action):
        assert text.endswith("."), text
        assert not re.search(r"\b(nan|inf)\b|  |(?<!\d)-\d|—", text), text

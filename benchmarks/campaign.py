"""The campaign of the benchmarks: six positions, turns about three axes forward and backward.

Of 200 samples per second, 1 mg and 0.02 °/s of white noise in each: six rests of 120 s, and about
each axis 720° at 20 °/s forward and backward. The IMU is the demo's, misaligned by half a degree
and biased; the table is so accurate that only the noise matters, and gravity is known.
"""

from collections.abc import Mapping
from dataclasses import replace
from math import radians, sqrt, tan
from pathlib import Path
from typing import Any

import laboratory

ROOT = Path(__file__).parent.parent
RATE = 200.0  # Hz
FORCE_NOISE = 1e-3 * 9.80665  # m/s² per sample
TURN_NOISE = 0.02  # °/s per sample
REST_SECONDS = 120.0
STILL_SECONDS = 6.5  # before and after a turn
TURN_DEGREES = 720.0
TURN_RATE = 20.0  # °/s; accelerations are as much per second
ARCSECONDS = 0.1  # sigma of the table's positions and angles

LEANING = [0.0, 1.0, tan(radians(0.1))]  # +y, 0.1° off towards z

AXES = "xyz"
RESTS = {f"{axis}-{way}": up + axis for axis in AXES for way, up in (("up", "+"), ("down", "-"))}
TURNS = {
    f"{axis}-{way}": (f"+{axis}", sign)
    for axis in AXES
    for way, sign in (("forward", 1), ("backward", -1))
}


def document(seed: int, *, longer: int = 1, times: int = 1, rate: float = RATE) -> dict[str, Any]:
    """The specification for the simulated laboratory.

    `longer`: factor of the durations of rests and turns; `times`: repetitions of the plan.
    The noise density is that of the sensors, so the noise of a sample depends on `rate`, Hz.
    """
    demo = laboratory.read(ROOT / "data/simulated/demo.yaml").document
    receiver = {**demo["receiver"], "rate_hz": rate}
    root_hour = 60 / sqrt(RATE)  # from a deviation per sample to a random walk per √h
    once: list[dict[str, Any]] = [
        {"id": name, "do": "rest", "up": up, "seconds": REST_SECONDS * longer}
        for name, up in RESTS.items()
    ] + [
        {"id": name, "do": "turn", "up": up, "degrees": sign * TURN_DEGREES * longer}
        | {"rate_deg_s": TURN_RATE, "accel_deg_s2": TURN_RATE}
        for name, (up, sign) in TURNS.items()
    ]
    again = [{**one, "id": f"{one['id']}-{k + 1}"} for k in range(1, times) for one in once]
    plan = once + again
    return {
        **demo,
        "campaign": {
            **demo["campaign"],
            "instrument": {
                "name": "that of the benchmarks",
                "rate_hz": rate,
                "axes": ["z", "-y", "x"],
                "format": {"kind": "rawimus"},
                "gyro": {"count_rad": receiver["gyro_count_rad"]},
                "accelerometer": {"count_m_s": receiver["accelerometer_count_m_s"]},
            },
            "site": {**demo["campaign"]["site"], "gravity_sigma_m_s2": 1e-6},
            "table": {
                "name": "three-axis",
                "heading_deg": None,
                "position_sigma_arcsec": ARCSECONDS,
                "angle_sigma_arcsec": ARCSECONDS,
            },
            "plan": [{**manoeuvre, "log": log_of(manoeuvre["id"])} for manoeuvre in plan],
        },
        "receiver": receiver,
        "handling": {"still_s": STILL_SECONDS},
        "noise": {
            "angle_random_walk_deg_sqrt_h": TURN_NOISE * root_hour,
            "velocity_random_walk_m_s_sqrt_h": FORCE_NOISE * root_hour,
            "gyro_rate_random_walk_deg_h_sqrt_h": 0,
            "accelerometer_random_walk_m_s2_sqrt_h": 0,
        },
        "effects": {},
        "faults": [],
        "seed": seed,
    }


def log_of(manoeuvre: str) -> str:
    """The log of a manoeuvre: each has its own."""
    return f"{manoeuvre}.asc"


def performed(specified: Mapping[str, Any]) -> laboratory.Recording:
    """The recording of the simulated laboratory."""
    return laboratory.perform(laboratory.specify(specified))


def tilted(specified: Mapping[str, Any]) -> laboratory.Recording:
    """The same, but with one rest 0.1° off the attitude in the campaign file."""
    plan = specified["campaign"]["plan"]
    crooked = [{**one, "up": LEANING} if one["id"] == "y-up" else one for one in plan]
    true = performed({**specified, "campaign": {**specified["campaign"], "plan": crooked}})
    return replace(true, campaign={**true.campaign, "plan": plan})

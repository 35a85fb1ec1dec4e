"""Twelve families of laws that are in no catalogue, as the laboratory is told of them.

Each has plans that show it, and forms: numbers that are drawn, or taken evenly for the Bayes
classifier. Its size goes by one key and three axes.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from hidden_plans import PLANS, SPANS

Random = np.random.Generator
Document = dict[str, Any]
COLUMNS = "chamber"  # the plan `rates` in a chamber whose air is warmed and cooled


@dataclass(frozen=True)
class Family:
    """`name`: of the effect of the laboratory; `key`: of its size, three numbers; `form`: the
    other parameters from numbers between 0 and 1, and the span of the plan, s."""

    title: str
    name: str
    key: str
    plans: tuple[str, ...]
    numbers: int
    form: Callable[[Any, float], Mapping[str, Any]]
    sensor: str = "gyro"

    def told(self, numbers: Any, plan: str, sizes: Any) -> Document:
        """What the laboratory is told."""
        own = dict(self.form(numbers, SPANS.get(plan, SPANS["rates"])))
        return {self.name: own | {self.key: [float(size) for size in sizes]}}


def _between(share: float, low: float, high: float) -> float:
    return float(low + share * (high - low))


ANY = ("positions", "stops", "rates")
FAMILIES = (
    Family("cubic drift", "gyro_cubic_drift", "k_deg_h_h3", ANY, 0, lambda u, t: {}),
    Family(
        "telegraph",
        "gyro_telegraph",
        "height_deg_h",
        ANY,
        1,
        lambda u, t: {"dwell_s": _between(u[0], 0.08, 0.25) * t},
    ),
    Family(
        "sine of time",
        "cyclic_drift",
        "gyro_deg_h",
        ANY,
        2,
        lambda u, t: {"period_s": t / _between(u[0], 2, 15), "phase_deg": 360 * float(u[1])},
    ),
    Family(
        "another level for a while",
        "gyro_disturbance",
        "size_deg_h",
        ANY,
        2,
        lambda u, t: {
            "from_s": _between(u[0], 0.15, 0.5) * t,
            "to_s": (_between(u[0], 0.15, 0.5) + _between(u[1], 0.15, 0.35)) * t,
        },
    ),
    Family(
        "drift that begins later",
        "gyro_late_drift",
        "ramp_deg_h_h",
        ANY,
        1,
        lambda u, t: {"from_s": _between(u[0], 0.3, 0.7) * t},
    ),
    Family(
        "power of the rate",
        "gyro_rate_power",
        "at_10_deg_s_deg_h",
        ("rates",),
        1,
        lambda u, t: {"power": _between(u[0], 1.3, 1.7)},
    ),
    Family(
        "sine of the angle",
        "gyro_stray_field",
        "size_deg_h",
        ("positions", "stops"),
        2,
        lambda u, t: {"order": _between(u[0], 1.3, 9.7), "phase_deg": 360 * float(u[1])},
    ),
    Family(
        "product of two forces",
        "gyro_anisoelasticity",
        "k_deg_h_g2",
        ("rates",),
        0,
        lambda u, t: {},
    ),
    Family(
        "rate of the temperature",
        "gyro_temperature_rate",
        "k_deg_h_k_min",
        (COLUMNS,),
        0,
        lambda u, t: {},
    ),
    Family(
        "temperature coefficient that drifts",
        "gyro_coefficient_drift",
        "k_deg_h_k_h",
        ("rates",),
        0,
        lambda u, t: {},
    ),
    Family("memory of the force", "gyro_remanence", "offset_deg_h", ANY, 0, lambda u, t: {}),
    Family(
        "sine of time, accelerometers",
        "cyclic_drift",
        "accelerometer_micro_g",
        ANY,
        2,
        lambda u, t: {"period_s": t / _between(u[0], 2, 15), "phase_deg": 360 * float(u[1])},
        "accel",
    ),
)


def plan_document(plan: str, **changes: Any) -> Document:
    """What the laboratory is told of a plan."""
    if plan != COLUMNS:
        return PLANS[plan](**changes)
    document = PLANS["rates"](**changes)
    ramps = [(300, 27), (250, 22), (150, 26)]  # s of rest, then °C
    steps = [
        step
        for seconds, to in ramps
        for step in ({"hold_s": seconds}, {"to_deg_c": to, "rate_k_min": 1.5})
    ]
    document["temperature"] = {
        "start_deg_c": 22,
        "chamber": {"time_constant_s": 40, "steps": steps},
    }
    return document

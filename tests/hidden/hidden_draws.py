"""What is hidden in a campaign: drawn by number, so that every draw can be made again.

A quarter is clean, and hard to be silent on: random walk, noise of the table, noise that is not the
data sheet's. The others hide one effect or two, in a random direction, as large as the wanted
signal-to-noise ratio says; or what is in no catalogue.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import chain
import numpy as np

G = 9.80665
DEGREE_PER_HOUR = np.radians(1 / 3600)  # rad/s
ARC_SECOND = np.radians(1 / 3600)
MICRO_G = 1e-6 * G
RATIOS = (5.0, 6.0, 8.0, 10.0, 15.0)
SPAN = 2900.0  # s, from the first to the last sample of the demo's plan


@dataclass(frozen=True)
class Way:
    """How the laboratory hides an effect: the parameters for values in the model's units.

    `names`: of the model's parameters, in the order of the values; `scan`: of the laboratory's
    parameter that the model scans, and between which values it is drawn.
    """

    names: tuple[str, ...]
    told: Callable[[np.ndarray], dict[str, Any]]
    scan: tuple[str, float, float] | None = None


def _three(key: str, unit: float, stem: str, scan: tuple[str, float, float] | None = None) -> Way:
    names = tuple(f"{stem}_{axis}" for axis in "xyz")
    return Way(names, lambda v: {key: (v / unit).tolist()}, scan)


def _level(first: str, second: str) -> Way:
    keys = {"north": "north_arcsec", "east": "east_arcsec"}

    def told(v: np.ndarray) -> dict[str, Any]:
        return {
            keys[name]: float(x / ARC_SECOND) for name, x in zip((first, second), v, strict=True)
        }

    return Way((first, second), told)


WAYS: Mapping[str, Way] = {
    "gyro_g_sensitivity": Way(
        tuple(f"g_{i}{j}" for i in "xyz" for j in "xyz"),
        lambda v: {"matrix_deg_h_g": (v.reshape(3, 3) * G / DEGREE_PER_HOUR).tolist()},
    ),
    "gyro_g2_sensitivity": _three("k_deg_h_g2", DEGREE_PER_HOUR / G**2, "g2"),
    "gyro_scale_asymmetry": _three("asymmetry_ppm", 1e-6, "a"),
    "gyro_bias_ramp": _three("ramp_deg_h_h", DEGREE_PER_HOUR / 3600, "c"),
    "gyro_warm_up": _three("start_deg_h", DEGREE_PER_HOUR, "b", ("time_constant_s", 200.0, 900.0)),
    "gyro_bias_jump": _three("size_deg_h", DEGREE_PER_HOUR, "b", ("at_s", 300.0, 2300.0)),
    "accel_quadratic": _three("k2_micro_g_g2", 1e-6 / G, "k2"),
    "accel_bias_ramp": _three("ramp_m_s2_h", 1 / 3600, "c"),
    "accel_bias_jump": _three("size_micro_g", MICRO_G, "b", ("at_s", 300.0, 2300.0)),
    "accel_hysteresis": _three("offset_micro_g", MICRO_G, "h"),
    "lever_arm": _three("arm_m", 1.0, "r"),
    "table_tilt": _level("north", "east"),
    "table_wobble": _level("north", "east"),
}
CLEAN: tuple[dict[str, Any], ...] = (
    {},
    {"gyro_rate_random_walk_deg_h_sqrt_h": 0.3},
    {"table_sway_m_s_sqrt_h": [0.02, 0.01]},
    {"angle_random_walk_deg_sqrt_h": 0.016, "velocity_random_walk_m_s_sqrt_h": 0.0045},
)
OUTSIDE: Mapping[str, dict[str, Any]] = {
    "gyro_telegraph": {"height_deg_h": [2.0, 0, 0], "dwell_s": 400},
    "gyro_cubic_drift": {"k_deg_h_h3": [0, 30.0, 0]},
}
KINDS = ("clean", "single", "single", "single", "two", "outside")


@dataclass(frozen=True)
class Draw:
    """One campaign: what is hidden in it, in the laboratory's words, and how clearly.

    `truth`: for each effect its parameters in the model's units; `ratio`: wanted signal-to-noise
    ratio of each.
    """

    number: int
    kind: str
    effects: dict[str, dict[str, Any]]
    truth: dict[str, dict[str, float]]
    noise: dict[str, Any]
    ratio: float

    def document(self) -> dict[str, Any]:
        """What the laboratory is told."""
        document = chain.demo(seed=10_000 + self.number, effects=self.effects)
        document["noise"] = {**document["noise"], **self.noise}
        return document


def draw(number: int, size: Callable[[str, float | None, np.ndarray], float]) -> Draw:
    """The draw of a number.

    `size`: the signal-to-noise ratio that values of an effect have in this plan, by its name and
    the value of what is scanned.
    """
    random = np.random.default_rng([2026, number])
    kind = KINDS[number % len(KINDS)]
    ratio = float(random.choice(RATIOS))
    if kind == "clean":
        return Draw(number, kind, {}, {}, CLEAN[number // len(KINDS) % len(CLEAN)], 0.0)
    if kind == "outside":
        name = str(random.choice(list(OUTSIDE)))
        return Draw(number, kind, {name: OUTSIDE[name]}, {}, {}, 0.0)
    chosen = random.choice(list(WAYS), 2 if kind == "two" else 1, replace=False)
    effects, truth = {}, {}
    for name in map(str, chosen):
        way = WAYS[name]
        at = None if way.scan is None else float(random.uniform(*way.scan[1:]))
        direction = random.normal(size=len(way.names))
        unit = size(name, at, direction)
        values = direction * (ratio / unit)
        effects[name] = way.told(values) | ({way.scan[0]: at} if way.scan else {})
        truth[name] = dict(zip(way.names, values.tolist(), strict=True))
    return Draw(number, kind, effects, truth, {}, ratio)

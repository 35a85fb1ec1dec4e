"""How the laboratory is told of every effect of the catalogue, and which plans show it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

G = 9.80665
DEGREE = np.radians(1.0)
DEGREE_PER_HOUR = DEGREE / 3600  # rad/s
ARC_SECOND = DEGREE / 3600
PPM, MICRO_G = 1e-6, 1e-6 * G
BOTH = ("positions", "stops", "rates")

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Way:
    """How the laboratory hides an effect: its parameters for values in the model's units.

    `names`: of the model's parameters, in the order of the values; `plans`: those that show it;
    `scan`: of the laboratory's parameter that the model scans, and between which values it is
    drawn, as shares of the campaign's span or as they are; `fixed`: the only values that it has,
    where it is there or not.
    """

    names: tuple[str, ...]
    told: Callable[[Array], dict[str, Any]]
    plans: tuple[str, ...] = BOTH
    scan: tuple[str, float, float] | None = None
    share: bool = False  # whether the scan is a share of the span


def _three(key: str, unit: float, stem: str, **more: Any) -> Way:
    names = tuple(f"{stem}_{axis}" for axis in "xyz")
    return Way(names, lambda v: {key: (v / unit).tolist()}, **more)


def _matrix(key: str, unit: float, stem: str, **more: Any) -> Way:
    names = tuple(f"{stem}_{i}{j}" for i in "xyz" for j in "xyz")
    return Way(names, lambda v: {key: (v.reshape(3, 3) / unit).tolist()}, **more)


def _one(key: str, unit: float, name: str, **more: Any) -> Way:
    return Way((name,), lambda v: {key: float(v[0] / unit)}, **more)


def _level(first: str, second: str, **more: Any) -> Way:
    keys = {"north": "north_arcsec", "east": "east_arcsec"}

    def told(v: Array) -> dict[str, Any]:
        return {
            keys[name]: float(x / ARC_SECOND) for name, x in zip((first, second), v, strict=True)
        }

    return Way((first, second), told, **more)


def _drifting(v: Array) -> dict[str, Any]:
    keys = ("north_arcsec_h", "east_arcsec_h")
    return dict(zip(keys, (v / ARC_SECOND * 3600).tolist(), strict=True))


def _products(v: Array) -> dict[str, Any]:
    """The laboratory's columns are yz, zx, xy; the model's xy, yz, zx."""
    return {"matrix_micro_g_g2": (v.reshape(3, 3)[:, [1, 2, 0]] / (PPM / G)).tolist()}


def _relaxing(v: Array) -> dict[str, Any]:
    """In the turn, and as it ends."""
    keys = ("in_turn_deg_h", "after_deg_h")
    return {
        key: (v[i : i + 3] / DEGREE_PER_HOUR).tolist() for key, i in zip(keys, (0, 3), strict=True)
    }


def _leaning(v: Array) -> dict[str, Any]:
    lean, quarter = v / ARC_SECOND
    return {"lean_arcsec": float(lean), "quarter_arcsec": float(quarter)}


TURNS, RATES = ("stops", "rates"), ("rates",)
MEMORY = ("positions", "rates")  # in `stops` every rest but the first follows a turn backwards
AT: dict[str, Any] = {"scan": ("at_s", 0.12, 0.85), "share": True}
RELAXES: dict[str, Any] = {"scan": ("time_constant_s", 8.0, 25.0)}
TAU: dict[str, Any] = {"scan": ("time_constant_s", 200.0, 900.0)}

WAYS: Mapping[str, Way] = {
    "gyro_g_sensitivity": _matrix("matrix_deg_h_g", DEGREE_PER_HOUR / G, "g"),
    "gyro_g2_sensitivity": _three("k_deg_h_g2", DEGREE_PER_HOUR / G**2, "g2"),
    "gyro_scale_asymmetry": _three("asymmetry_ppm", PPM, "a"),
    "gyro_scale_quadratic": _three("k2_ppm_per_deg_s", PPM / DEGREE, "k", plans=TURNS),
    "gyro_scale_cubic": _three("k3_ppm_per_deg_s_2", PPM / DEGREE**2, "k", plans=TURNS),
    "gyro_scale_g_dependence": _three("k_ppm_g", PPM / G, "k", plans=TURNS),
    "gyro_bias_ramp": _three("ramp_deg_h_h", DEGREE_PER_HOUR / 3600, "c"),
    "gyro_scale_ramp": _three("k_ppm_h", PPM / 3600, "k", plans=RATES),
    "gyro_warm_up": _three("start_deg_h", DEGREE_PER_HOUR, "b", **TAU),
    "gyro_bias_temperature": _three("k_deg_h_k", DEGREE_PER_HOUR, "k", plans=RATES),
    "gyro_scale_temperature": _three("k_ppm_k", PPM, "k", plans=RATES),
    "gyro_bias_jump": _three("size_deg_h", DEGREE_PER_HOUR, "b", **AT),
    "gyro_hysteresis": _three("offset_deg_h", DEGREE_PER_HOUR, "h", plans=MEMORY),
    "gyro_bias_sense": _three("offset_deg_h", DEGREE_PER_HOUR, "b", plans=MEMORY),
    "gyro_relaxation": Way(
        tuple(f"{stem}_{axis}" for stem in "db" for axis in "xyz"), _relaxing, **RELAXES
    ),
    "gyro_relaxation_sense": _three("offset_deg_h", DEGREE_PER_HOUR, "b", **RELAXES),
    "gyro_relaxation_braking": _three("offset_deg_h", DEGREE_PER_HOUR, "b", **RELAXES),
    "accel_quadratic": _three("k2_micro_g_g2", PPM / G, "k2"),
    "accel_cubic": _three("k3_micro_g_g3", PPM / G**2, "k3", plans=RATES),
    "accel_cross_products": Way(
        tuple(f"k_{i}_{pair}" for i in "xyz" for pair in ("xy", "yz", "zx")), _products, RATES
    ),
    "accel_scale_asymmetry": _three("asymmetry_micro_g_g", PPM, "a"),
    "accel_bias_ramp": _three("ramp_m_s2_h", 1 / 3600, "c"),
    "accel_scale_ramp": _three("k_ppm_h", PPM / 3600, "k", plans=RATES),
    "accel_warm_up": _three("start_micro_g", MICRO_G, "b", **TAU),
    "accel_bias_temperature": _three("k_micro_g_k", MICRO_G, "k", plans=RATES),
    "accel_scale_temperature": _three("k_ppm_k", PPM, "k", plans=RATES),
    "accel_bias_jump": _three("size_micro_g", MICRO_G, "b", **AT),
    "accel_scale_jump": _three(
        "k_ppm", PPM, "k", plans=RATES, scan=("at_s", 0.58, 0.86), share=True
    ),
    "accel_hysteresis": _three("offset_micro_g", MICRO_G, "h", plans=RATES),
    "lever_arm": _three("arm_m", 1.0, "r"),
    "mounting_shift": _three("rotation_arcsec", ARC_SECOND, "theta", **AT),
    "size_effect": _matrix("arms_mm", 1e-3, "r"),
    "table_tilt": _level("north", "east"),
    "table_tilt_ramp": Way(("north", "east"), _drifting),
    "table_tilt_jump": _level("north", "east", **AT),
    "table_axis_non_orthogonality": Way(("lean", "quarter"), _leaning, RATES),
    "table_inner_axis": _one("lean_arcsec", ARC_SECOND, "lean", plans=RATES),
    "table_wobble": _level("north", "east"),
    "table_angle_scale": _one("scale_ppm", PPM, "e", plans=RATES),
    "latitude_error": _one("error_deg", DEGREE, "dphi", plans=TURNS),
    "heading_error": _one("error_deg", DEGREE, "dpsi", plans=TURNS),
    "earth_rate_omitted": _one("share", 1.0, "s", plans=TURNS),
}
# The laboratory knows a share of the earth's rate between nothing and all of it.
POSITIVE = ("earth_rate_omitted",)
REMEMBERING = ("accel_hysteresis",)  # depends on how the table moved between two positions

# Each is a decoy: every calibration estimates something that does the same, or the equations know
# it not at all, so silence is right, and so is the truth; but for plans of `WAYS` that show it.
# Usual sizes of the catalogue.
ABSORBED: Mapping[str, Callable[[float], dict[str, Any]]] = {
    "gravity_error": lambda u: {"error_mgal": 5 * u},
    "clock_scale": lambda u: {"fast_ppm": 20 * u},
    "table_speed_error": lambda u: {"rate_ppm": 100 * u},
    "table_angle_scale": lambda u: {"scale_ppm": 10 * u},
    "gyro_accel_misalignment": lambda u: {"rotation_mrad": [u, -u, 0.5 * u]},
    "gyro_latency": lambda u: {"lag_ms": 3 * abs(u)},
    "accel_latency": lambda u: {"lag_ms": 3 * abs(u)},
    "table_position_error": lambda u: {"sigma_arcsec": 2 * abs(u)},
    "accel_vibration_rectification": lambda u: {
        "k_micro_g_g2": [100 * u, 0, -100 * u],
        "vibration_g": 0.002,
        "from_s": 690,
        "to_s": 1410,
    },
}


def absorbed(name: str, plan: str) -> bool:
    """Whether an effect is a decoy in a plan."""
    return name in ABSORBED and not (name in WAYS and plan in WAYS[name].plans)


# Effects that are alike in some plan: one of them is there, in that plan.
MATES: tuple[tuple[str, str], ...] = (
    ("stops", "gyro_scale_quadratic"),
    ("stops", "gyro_scale_cubic"),
    ("stops", "gyro_scale_g_dependence"),
    ("positions", "accel_quadratic"),
    ("positions", "accel_scale_asymmetry"),
    ("positions", "accel_bias_ramp"),
    ("positions", "accel_bias_jump"),
    ("positions", "mounting_shift"),
    ("stops", "latitude_error"),
    ("stops", "gyro_g_sensitivity"),
    ("rates", "gyro_scale_ramp"),
    ("rates", "table_tilt"),
    ("rates", "table_axis_non_orthogonality"),
    ("positions", "lever_arm"),
    ("stops", "size_effect"),
)

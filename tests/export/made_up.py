"""Made-up calibrations, as the stage hands them to the writers of the formats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from inertial.campaign.measurement import measurement_of
from stages.export.calibration import PARAMETERS, Calibration, Mount, Triad, Use
from stages.export.examples import Example

REASON = (
    "no whole turn about y, its angle known to a few degrees, was recorded: add one of 360° about y"
)
ERRORS = {
    "accelerometer": [[0.003, 0.002, 0.0075], [-0.0027, -0.004, -0.0008], [-0.0076, 0.0007, 0.002]],
    "gyroscope": [[0.0006, 0.0025, 0.0076], [-0.0024, -0.00002, -0.0007], [-0.0076, 0.0008, 6e-4]],
}
BIAS = {"accelerometer": [-0.0523, 0.0507, -0.0188], "gyroscope": [1.3e-5, -2.1e-5, 9e-6]}
SIGMA = {"accelerometer": 1e-5, "gyroscope": 2e-7}
VERDICT: dict[str, Any] = {
    "verdict": "usable",
    "sentence": "It is usable.",
    "condition": None,
    "method": "joint",
    "reason": "they show no effect",
}
USE = Use(seconds=60.0, rate_rms=0.35, force_rms=1.0, correlation=1.0)
CAMPAIGN: dict[str, Any] = {
    "campaign": "spring",
    "simulated": False,
    "compensated": False,
    "instrument": "NovAtel SPAN-CPT",
    "serial": "A-017",
    "date": "2026-11-02",
    "laboratory": None,
    "operator": None,
    "notes": None,
    "table": "three-axis",
    "rate": 100.0,
}
EVIL = [
    "x\nCAL_ACC0_XOFF,9",
    "x\r1\t1\tCAL_ACC0_XOFF\t9\t9",
    "a: b # c",
    "- x",
    "no",
    "0017",
    "1e5",
    "2026-11-02",
    "null",
    '"quoted" \\n \\',
    "'",
    "[\n 1,\n 2\n]",
    "{}",
    "%YAML 1.1",
    "---",
    "...",
    "&a *a !!python/object:os.system",
    "\0\x07\x1b[31m\x7f\x85\u2028\u2029\ufeff",
    "Prüfling 日本 🛰",
    "",
    " ",
    "x" * 500,
]


def triad(kind: str, missing: Sequence[str] = (), method: str = "joint") -> Triad:
    """Three sensors of which the numbers in `missing` were not determined."""
    values = np.append(np.array(ERRORS[kind]).ravel(), BIAS[kind])
    there = np.array([name not in missing for name in PARAMETERS])
    values = np.where(there, values, np.nan)
    generator = np.random.default_rng(7)
    root = generator.normal(size=(12, 12)) * SIGMA[kind]
    covariance = (root @ root.T)[np.ix_(there, there)]
    sigma = np.full(12, np.nan)
    sigma[there] = np.sqrt(np.diag(covariance))
    return Triad(
        kind,
        f"{kind}/{method}",
        matrix=np.eye(3) + values[:9].reshape(3, 3),
        matrix_sigma=sigma[:9].reshape(3, 3),
        bias=values[9:],
        bias_sigma=sigma[9:],
        ids=tuple(
            f"{kind}/{method}/{n}" for n, kept in zip(PARAMETERS, there, strict=True) if kept
        ),
        covariance=covariance,
        reasons=dict.fromkeys(missing, REASON),
        fit=None,
        verdict=VERDICT,
    )


def mount(name: str = "as mounted", missing: Mapping[str, Sequence[str]] | None = None) -> Mount:
    """A mount with a reading at rest; `missing` by kind."""
    left = missing or {}
    rest = Example(
        "mean over rest", "x-up", "x-up.asc", 0, 2000, None, np.array([9.8, 0, 0, 0, 0, 0])
    )
    return Mount(
        name,
        triad("accelerometer", left.get("accelerometer", ())),
        triad("gyroscope", left.get("gyroscope", ())),
        [rest],
    )


def calibration(*mounts: Mount, **changes: Any) -> Calibration:
    """A whole calibration; `changes` are of the campaign's own facts."""
    noise = [
        {
            "channel": f"{sensor}_{axis}",
            "density": density * (1 + 0.1 * number),
            "sigma": None,
            "least": 0.9 * density,
            "most": 1.3 * density,
            "stretches": 12,
            "data_sheet": None,
            "terms": {},
        }
        for sensor, density in (("accel", 1.05e-4), ("gyro", 3.4e-6))
        for number, axis in enumerate("xyz")
    ]
    gravity = {
        "quantity": "gravity",
        "value": 9.7936174,
        "sigma": 5e-5,
        "unit": "m/s²",
        "origin": "stated in the campaign file",
    }
    return Calibration(
        campaign=CAMPAIGN | changes,
        inputs=[{"file": "x-up.asc", "size": 9, "sha256": "ab"}],
        use=USE,
        known=[gravity],
        noise=noise,
        rate=100.0,
        temperature=None,
        mounts=mounts or [mount()],
        made_by=[{"stage": "plan", "settings": "{}", "code": "c0", "inputs": []}],
    )


def named(name: str) -> Calibration:
    """A calibration in which every text from outside is `name`."""
    texts = ("campaign", "instrument", "serial", "date", "notes", "laboratory", "operator", "table")
    whole = mount(name, {"gyroscope": ["cross_xy", "bias_y"]})
    reasons = dict.fromkeys(whole.gyroscope.reasons, name)
    odd = replace(whole, gyroscope=replace(whole.gyroscope, reasons=reasons))
    return calibration(odd, mount("other"), **dict.fromkeys(texts, name))


WALK = {"accel": (None, 4e-7), "gyro": (2e-9, None)}  # value, or upper limit; of x, and 1.1 and 1.2
INSTABILITY = {"accel": 6e-5, "gyro": None}


def with_terms(whole: Calibration) -> Calibration:
    """The same with the terms of the noise, as an hour at rest would show them."""
    noise = []
    for row in whole.noise:
        sensor, _unused, axis = row["channel"].partition("_")
        more = 1 + 0.1 * "xyz".index(axis)
        (walk, limit), instability = WALK[sensor], INSTABILITY[sensor]
        rest = {"p_value": 0.1, "data_sheet": None, "seconds": 3600.0, "unit": "by IEEE 952"}
        terms = {
            name: {
                "detected": value is not None,
                "value": value and value * more,
                "sigma": value and 0.1 * value,
                "upper": upper and upper * more,
                **rest,
            }
            for name, value, upper in (
                ("bias_instability", instability, 1e-8),
                ("random_walk", walk, limit),
            )
        }
        noise.append(row | {"terms": terms})
    return replace(whole, noise=noise)


# Value and unit of every number of an effect; those in CONSTANTS have no sigma.
EFFECTS: dict[str, dict[str, dict[str, tuple[float, str]]]] = {
    "accelerometer": {
        "accel_quadratic": {"k2_x": (2e-5, "(m/s²)/(m/s²)²"), "k2_z": (-1e-5, "(m/s²)/(m/s²)²")},
        "accel_bias_jump": {"b_x": (1e-3, "m/s²"), "t0": (30.0, "s")},
    },
    "gyroscope": {
        "gyro_g_sensitivity": {"g_xx": (3e-6, "(rad/s)/(m/s²)"), "g_yx": (-2e-6, "(rad/s)/(m/s²)")},
        "gyro_scale_asymmetry": {"a_z": (4e-4, "1")},
        "gyro_warm_up": {"b_y": (2e-5, "rad/s"), "tau": (90.0, "s")},
    },
}
CONSTANTS = ("t0", "tau")


def with_effects(plain: Triad) -> Triad:
    """The same three sensors with EFFECTS in their model, each of one part in a hundred."""
    rows = [
        {
            "id": f"{plain.id_prefix}/{effect}.{name}",
            "sensor": "accel" if plain.kind == "accelerometer" else "gyro",
            "effect": effect,
            "parameter": f"{effect}.{name}",
            "value": value,
            "sigma": None if name in CONSTANTS else abs(value) / 100,
            "unit": unit,
            "meaning": "made up",
        }
        for effect, numbers in EFFECTS[plain.kind].items()
        for name, (value, unit) in numbers.items()
    ]
    measurement = measurement_of(rows)
    own = measurement.accelerometer if plain.kind == "accelerometer" else measurement.gyro
    estimated = [row for row in rows if row["sigma"] is not None]
    return replace(
        plain,
        effects=own.effects,
        ids=(*plain.ids, *(str(row["id"]) for row in estimated)),
        covariance=block_diag(plain.covariance, np.diag([row["sigma"] ** 2 for row in estimated])),
    )


def moving_mount(name: str = "as mounted") -> Mount:
    """A mount whose sensors have effects, with readings at rest and in a turn."""
    plain = mount(name)
    turn = Example(
        *("one sample of a turn", "z-forward", "z.asc", 70, 71, 90),
        np.array([0.21, -0.4, 9.7, 0.002, -0.001, -1.05]),
        time=45.25,
        temperature=300.0,
    )
    return replace(
        plain,
        accelerometer=with_effects(plain.accelerometer),
        gyroscope=with_effects(plain.gyroscope),
        examples=[replace(plain.examples[0], time=12.5), turn],
    )

"""Real recordings: their logs, what a person adds to the draft, and what is known of the IMU.

Sources of all numbers: SOURCE.md of each recording. None has a sigma.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import chain
import numpy as np
from ruamel.yaml import YAML

from commands.draft.__main__ import draft

Three = tuple[float, float, float]
STANDARD_GRAVITY = 9.80665
UNITS = {"m/s2": 1.0, "g": STANDARD_GRAVITY, "rad/s": 1.0, "deg/s": np.radians(1)}
STAGES = {"accel": "accelerometer", "gyro": "gyroscope"}
SENSORS = {"accel": "accelerometer", "gyro": "gyro"}


@dataclass(frozen=True)
class Known:
    """Three numbers of one sensor, x, y, z: biases in a unit, or scales.

    unit: m/s2, g, deg/s or counts of a bias; % of a scale factor error; counts/(m/s2) or
    counts/(deg/s) of a scale.
    """

    sensor: str
    quantity: str
    unit: str
    values: Three

    def ours(self, results: chain.Results, campaign: Mapping[str, Any]) -> np.ndarray:
        """Value and sigma of the result, in the same unit, (3, 2)."""
        names = [f"{self.quantity}_{axis}" for axis in "xyz"]
        both = [
            results.parameters(STAGES[self.sensor], method).reindex(names)[["value", "sigma"]]
            for method in ("joint", "free_positions")
        ]
        values = both[0].fillna(both[1]).to_numpy(float)
        count = self._count(campaign)
        if self.quantity == "bias":
            return values / (count if self.unit == "counts" else UNITS[self.unit])
        if self.unit == "%":
            return 100 * values
        own = UNITS[self.unit.removeprefix("counts/(").removesuffix(")")]
        return (values + np.array([1, 0])) * own / count

    def _count(self, campaign: Mapping[str, Any]) -> float:
        """What one of the unit of the log is in SI."""
        formats = [campaign["instrument"].get("format", {}), *campaign.get("formats", {}).values()]
        triad = next(f[SENSORS[self.sensor]] for f in formats if SENSORS[self.sensor] in f)
        return UNITS[triad["unit"]] / triad.get("counts_per_unit", 1)


@dataclass(frozen=True)
class Recording:
    """Logs by pattern, and the answers to what the draft asks: Hz; gravity and its sigma, m/s²."""

    name: str
    logs: str
    rate: float | None = None
    gravity: tuple[float, float] | None = None
    known: Sequence[Known] = field(default_factory=tuple)

    def drafted(self, recordings: Path, data: Path) -> Path:
        """The folder of its campaign as `make draft` writes it, with the answers."""
        folder = draft(sorted(recordings.glob(self.logs)), self.name, data, self.rate)
        if self.gravity is not None:
            file = folder / "campaign.yaml"
            value, sigma = self.gravity
            stated = f"gravity_m_s2: {value}, gravity_sigma_m_s2: {sigma}}}"
            text = re.sub(r"gravity_m_s2: .*\}.*", stated, file.read_text(encoding="utf-8"))
            file.write_text(text, encoding="utf-8")
        return folder


def told(folder: Path) -> dict[str, Any]:
    """A campaign file."""
    content: dict[str, Any] = YAML(typ="safe").load(folder / "campaign.yaml")
    return content


def _mikoff(number: int, scale: Three, bias: Three) -> Recording:
    return Recording(
        f"mikoff-{number}",
        f"mikoff_mpu9150/imu{number - 1}.log",
        gravity=(9.81, 0.01),
        known=(Known("accel", "bias", "m/s2", bias), Known("accel", "scale", "%", scale)),
    )


RECORDINGS = (
    Recording(
        "imu-tk",
        "imu_tk_xsens/*.mat",
        gravity=(9.81744, 0.005),
        known=(
            Known("accel", "bias", "counts", (33123 - 32768, 33276 - 32768, 32360 - 32768)),
            Known("accel", "scale", "counts/(m/s2)", (414.46, 412.01, 414.65)),
        ),
    ),
    Recording(
        "gesture",
        "gesture_multipos/*.mat",
        known=(
            Known("accel", "bias", "counts", (19, 856, 1022)),
            Known("accel", "scale", "counts/(m/s2)", (1 / 0.00478, 1 / 0.00477, 1 / 0.00473)),
        ),
    ),
    *(
        Recording(
            f"snu-{number}",
            f"snu_multipos/imu_good{number}.txt",
            gravity=(9.79871, 0.005),
            known=(Known("accel", "bias", "m/s2", (0.0056, -0.0004, 0.355)),),
        )
        for number in (1, 2, 3)
    ),
    _mikoff(1, (0.363, 0.315, 0.647), (0.103, 0.097, 0.344)),
    _mikoff(2, (0.471, 0.482, 0.932), (0.09, 0.07, 0.338)),
    _mikoff(3, (0.382, 0.355, 0.78), (0.096, 0.008, -0.045)),
    _mikoff(4, (0.263, 0.448, 0.721), (0.065, 0.092, -0.009)),
    _mikoff(5, (0.251, 0.286, 0.804), (0.07, 0.036, 0.182)),
    Recording(
        "cuyo",
        "mpu6050_cuyo/example_data_calibration.csv",
        known=(
            Known("accel", "bias", "counts", (711.516, -358.505, -1840.128)),
            Known(
                "accel",
                "scale",
                "counts/(m/s2)",
                (1 / 0.00060201, 1 / 0.00059684, 1 / 0.00058592),
            ),
            Known("gyro", "bias", "counts", (-427.46, 147.95, -80.72)),
        ),
    ),
    Recording(
        "softdream",
        "softdream_sixpos/*.txt",
        known=(Known("gyro", "bias", "deg/s", (0.41, 1.29, -4.30)),),
    ),
    Recording(
        "imucal-labelled",
        "imucal_ferraris/annotated_session.csv",
        rate=204.8,
        gravity=(9.81, 0.01),
        known=(
            Known("accel", "bias", "counts", (-6.019, -48.288, -28.966)),
            Known("accel", "scale", "counts/(m/s2)", (208.546, 208.001, 214.785)),
            Known("gyro", "scale", "counts/(deg/s)", (16.678, 16.188, 16.253)),
        ),
    ),
    Recording(
        "imucal-continuous",
        "imucal_ferraris/example_ferraris_session.csv",
        rate=102.4,
        gravity=(9.81, 0.01),
    ),
    Recording("sunsided", "sunsided_mpu6050/*.mat"),
    Recording(
        "ctu",
        "ctu_prague/*.mat",
        known=(Known("gyro", "scale", "%", (-0.50, -0.02, 0.55)),),
    ),
)

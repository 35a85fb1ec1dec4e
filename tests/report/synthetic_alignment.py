"""What the stage alignment says of the synthetic campaign: a bias of 20 °/h to the east, 6 °/s."""

from __future__ import annotations

from math import cos, pi, radians, sin
from typing import Any

from tests.report.synthetic_values import Rows

BIAS, RATE = radians(20) / 3600, radians(6)
COMMON = {"mount": "", "alignment": "z-up", "readings": "recorded"}


def alignments() -> Rows:
    def row(method: str, quantity: str, value: float, sigma: float, **more: Any) -> dict[str, Any]:
        nothing = {"direction": None, "per_bias": None, "known": None, "unit": "rad"}
        own = {"method": method, "quantity": quantity, "value": value, "sigma": sigma}
        return COMMON | nothing | own | more

    azimuth = {"direction": "x", "known": radians(25)}
    return [
        row("static", "tilt_x", 5e-4, 5e-6),
        row("static", "azimuth", radians(-39.8), radians(1.2), **azimuth, per_bias=5000.0),
        row("rotation", "azimuth", radians(26), radians(1.4), **azimuth, per_bias=0.0),
        row("rotation", "level_rate", 5.5e-5, 1.4e-6, known=5.59e-5, unit="rad/s"),
    ]


def attitude_errors() -> Rows:
    rows = []
    for name, rate in (("z-forward", RATE), ("z-up", 0.0)):
        for second in range(0, 66, 5):
            angle = rate * second
            error = (sin(angle) / rate, (1 - cos(angle)) / rate) if rate else (float(second), 0.0)
            east, north = (BIAS * each for each in error)
            rows.append(
                COMMON
                | {"manoeuvre": name, "modulated": rate > 0, "seconds": float(second)}
                | {"east": east, "north": north, "up": 1e-6 * second, "sigma": 1.5e-5 * second**0.5}
                | {"predicted_east": east, "predicted_north": north, "predicted_up": 0.0}
                | {"predicted_sigma": 1e-6}
            )
    return rows


def modulation_gains() -> Rows:
    still, modulated = BIAS * 65, 2 * BIAS / RATE
    return [
        COMMON
        | {"modulated": "z-forward", "still": "z-up", "seconds": 65.0}
        | {"still_error": still, "still_sigma": 1.2e-4}
        | {"modulated_error": modulated, "modulated_sigma": 8e-5}
        | {
            "factor": still / modulated,
            "factor_sigma": 0.15,
            "predicted_factor": RATE * 65 * pi / 2 / pi,
        }
    ]

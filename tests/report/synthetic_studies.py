"""The tables of synthetic studies: two pairs of turns, the rests of both sensors."""

from __future__ import annotations

import numpy as np

from tests.report.synthetic_values import DEGREE, SENSOR, Rows

SCALE = {"x": 6.151e-4, "y": -1.62e-5}
NOISE = 3e-6
RATE = 10 * DEGREE


def studies(generator: np.random.Generator) -> dict[str, Rows]:
    """Rows of the nine tables by name."""
    turns = [f"{axis}-{way}" for axis in SCALE for way in ("forward", "backward")]
    return {
        "epochs": [row for name in _parameters() for row in _epochs(*name, generator)],
        "spreads": [row for name in _parameters() for row in _spreads(*name)],
        "windows": [
            row
            for axis in SCALE
            for start in np.linspace(0, 16, 60)
            for row in _window(axis, "set rate", start, np.pi, generator)
        ],
        "growing": [
            row
            for axis in SCALE
            for angle in np.linspace(5, 340, 40) * DEGREE
            for row in _window(axis, "set rate", 0.0, float(angle), generator)
        ],
        "middles": [
            row
            for axis in SCALE
            for by in ("whole turn", "set rate", "own angle", "other turns")
            for row in _window(axis, by, 8.0, 2 * np.pi if by == "whole turn" else np.pi, generator)
        ],
        "time_angle": [row for turn in turns for row in _angles(turn, generator)],
        "motions": [row for turn in turns for row in _motions(turn)],
        "encoder": _encoder(turns),
        "bandwidths": bandwidths(),
        "not_studied": [
            {"study": "turns", "subject": "z-backward", "reason": "240.38° of 360° recorded"}
        ],
    }


def bandwidths() -> Rows:
    """A gyro of 53 Hz by the encoder, one with a limit only, and an accelerometer without."""

    def row(sensor: str, axis: str, by: str, *numbers: float | None, reason: str = "") -> dict:
        own = dict(zip(("value", "sigma", "lower"), numbers, strict=True))
        place = {"id": f"studies/{sensor}/bandwidth_{axis}/{by}", "mount": "", "sensor": sensor}
        return place | own | {"axis": axis, "by": by, "turns": 2, "reason": reason}

    return [
        row("gyro", "x", "encoder", 53.05, 0.42, 52.4),
        row("gyro", "y", "ramps", None, None, 35.0),
        row("accel", "z", "ramps", None, None, None, reason="nothing changes fast"),
    ]


def _encoder(turns: list[str]) -> Rows:
    def row(manoeuvre: str | None, quantity: str, value: float, sigma: float, unit: str) -> dict:
        own = {"manoeuvre": manoeuvre, "quantity": quantity, "value": value, "sigma": sigma}
        return own | {"unit": unit, "order": None, "p_value": None}

    eccentric = {"order": 1.0, "p_value": 0.5}
    return [
        row(None, "delay", 3.0e-3, 3e-6, "s") | {"p_value": 0.2},
        row(None, "low_pass", 3.0e-3, 3e-6, "s"),
        row(None, "sine", 5.03e-5, 1.4e-6, "rad") | eccentric,
        row(None, "cosine", -2.98e-5, 1.4e-6, "rad") | eccentric,
        *(row(turn, "scale", 5.61e-4, 4e-6, "1") for turn in turns),
        row(turns[0], "ripple", 1.45e-5, 2e-9, "rad") | {"order": 12.0, "p_value": 1e-9},
    ]


def _parameters() -> list[tuple[str, str, str, float]]:
    names = [("accelerometer", f"bias_{a}", "m/s²", 1e-4) for a in "xyz"]
    names += [("accelerometer", f"scale_{a}", "1", 1e-5) for a in "xyz"]
    names += [("accelerometer", "cross_xy", "1", 1e-5), ("gyroscope", "bias_x", "rad/s", 1e-6)]
    return names


def _key(stage: str, name: str, unit: str) -> dict[str, str]:
    return {"sensor": SENSOR[stage], "method": "rests", "quantity": name, "unit": unit}


def _epochs(stage: str, name: str, unit: str, sigma: float, generator: np.random.Generator) -> Rows:
    values = sigma * generator.standard_normal(40)
    running = np.cumsum(values) / np.arange(1, 41)
    return [
        _key(stage, name, unit)
        | {"seconds": k + 1.0, "single": values[k], "single_sigma": sigma}
        | {"running_mean": running[k], "running_mean_sigma": sigma / (k + 1) ** 0.5}
        for k in range(40)
    ]


def _spreads(stage: str, name: str, unit: str, sigma: float) -> Rows:
    return [
        _key(stage, name, unit)
        | {"seconds": seconds, "epochs": round(300 / seconds)}
        | {"single_variance": 1.21 * sigma**2 / seconds, "running_variance": 1e-3 * sigma**2}
        | {"white_variance": sigma**2 / seconds}
        for seconds in (0.01, 0.1, 1.0, 10.0)
    ]


def _window(axis: str, by: str, start: float, angle: float, generator: np.random.Generator) -> Rows:
    cut = 0.0 if by in ("whole turn", "own angle") else NOISE * (np.pi / angle) ** 0.5
    sigma = {"whole turn": NOISE, "own angle": NOISE, "set rate": 1e-4}.get(by, 1.2 * cut)
    return [
        {"axis": axis, "forward": f"{axis}-forward", "backward": f"{axis}-backward", "by": by}
        | {"from_s": start, "samples": round(angle / RATE * 100), "angle": angle}
        | {"scale": SCALE[axis] + cut * generator.standard_normal(), "scale_sigma": sigma}
        | {"cut_sigma": cut, "bias": 1e-6, "bias_sigma": 4e-7}
    ]


def _angles(turn: str, generator: np.random.Generator) -> Rows:
    time = np.linspace(0, 38, 60)
    sigma = 4e-6 * np.sqrt(time * (38 - time) / 38)
    noise = np.cumsum(generator.standard_normal(60)) * 1e-6
    return [
        {"manoeuvre": turn, "seconds": t, "angle": RATE * t + n, "sigma": s, "set_angle": RATE * t}
        | {"swing": 2e-6}
        for t, s, n in zip(time, sigma, noise, strict=True)
    ]


def _motions(turn: str) -> Rows:
    rows = [("speed", RATE * (1 + 2e-6), 5e-7, RATE, "rad/s")]
    for ramp in ("spin-up", "spin-down"):
        rows.append((f"{ramp} seconds", 2.0004, 4e-4, 2.0, "s"))
        rows.append((f"{ramp} acceleration", 5.001 * DEGREE, 2e-5, 5 * DEGREE, "rad/s²"))
    names = ("quantity", "value", "sigma", "set_value", "unit")
    return [{"manoeuvre": turn} | dict(zip(names, row, strict=True)) for row in rows]

"""What is hidden and not sought in the blocks of means; and noise that is hard to be silent on."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

Random = np.random.Generator
Told = tuple[dict[str, Any], dict[str, Any]]  # effects, changes of the noise


@dataclass(frozen=True)
class Hard:
    """Noise that asks for names where there is nothing to name; `hidden`: what is true of it.

    `twin`: what it does to the 24 parameters is measured.
    """

    name: str
    hidden: tuple[str, ...]
    told: Callable[[Random], Told]
    twin: bool = False


def between(random: Random, least: float, most: float) -> float:
    """A number, its logarithm uniform."""
    return float(np.exp(random.uniform(np.log(least), np.log(most))))


# Figures of the SPAN-CPT's data sheet, as in data/instruments.yaml.
SHEET = {"angle_random_walk_deg_sqrt_h": 0.0667, "velocity_random_walk_m_s_sqrt_h": 0.0324}
WALKS = {"gyro": "gyro_rate_random_walk_deg_h_sqrt_h"}
WALKS["accel"] = "accelerometer_random_walk_m_s2_sqrt_h"

HARD: tuple[Hard, ...] = (
    Hard("plain", (), lambda r: ({}, {})),
    Hard(
        "random walk of the gyros",
        ("gyro_random_walk",),
        lambda r: ({}, {WALKS["gyro"]: between(r, 0.05, 0.5)}),
    ),
    Hard(
        "noise that goes with the attitude",
        (),
        lambda r: ({}, {"table_sway_m_s_sqrt_h": r.uniform(0.0, 0.04, 2).tolist()}),
    ),
    Hard(
        "noise off the data sheet by up to 30 %",
        (),
        lambda r: ({}, {key: value * r.uniform(0.7, 1.3) for key, value in SHEET.items()}),
    ),
    Hard(
        "oscillation at 20 Hz",
        ("oscillation",),
        lambda r: (
            {
                "oscillation": {
                    "frequency_hz": 20,
                    "amplitude_rad_s": between(r, 1e-3, 1e-2),
                    "axis": str(r.choice(["+x", "+y", "+z"])),
                }
            },
            {},
        ),
        twin=True,
    ),
    Hard(
        "random walk of the accelerometers",
        ("accel_random_walk",),
        lambda r: ({}, {WALKS["accel"]: between(r, 1e-4, 1e-3)}),
    ),
)


@dataclass(frozen=True)
class Elsewhere:
    """An effect of the catalogue that is sought in the spectrum, in the noise, in the samples.

    `hidden`: its name, and what it may truly be called too; `plan`: one that shows it.
    """

    hidden: tuple[str, ...]
    plan: str
    told: Callable[[Random], Told]


def _ringing(random: Random) -> Told:
    ringing = {
        "frequency_hz": float(random.uniform(5, 45)),
        "amplitude_rad_s": between(random, 2e-4, 1e-2),
        "axis": str(random.choice(["+x", "+y", "+z"])),
        "nonlinearity": float(random.uniform(0, 0.5)),
    }
    return {"oscillation": ringing}, {}


def _ripple(random: Random) -> Told:
    ripple = {
        "order": float(random.integers(8, 240) / 4),
        "amplitude_arcsec": between(random, 2, 20),
        "phase_deg": float(random.uniform(0, 360)),
    }
    return {"table_ripple": ripple}, {}


def _eccentricity(random: Random) -> Told:
    sine, cosine = between(random, 10, 100) * direction(random, 2)
    return {"table_eccentricity": {"sin_arcsec": float(sine), "cos_arcsec": float(cosine)}}, {}


def _dead_band(random: Random) -> Told:
    return {"gyro_dead_band": {"width_deg_h": random.uniform(3, 14, 3).tolist()}}, {}


def direction(random: Random, axes: int = 3) -> Any:
    """A random direction, (axes,)."""
    drawn = random.normal(size=axes)
    return drawn / np.linalg.norm(drawn)


def _near(random: Random, reading: float, sigma: float) -> float:
    """A limit that cuts into the noise of samples about a reading, or all of it.

    A scatter of a thousandth in the scale factors is as much as their noise, so the share that is
    cut off differs from axis to axis.
    """
    return float(reading + sigma * random.uniform(-2, 1))


def _turned_too_far(random: Random) -> Told:
    turn = f"{random.choice(list('xyz'))}-up-{random.choice([20, 40, 80])}-forward"
    return {"turn_angle_error": {"turn": turn, "further_arcsec": between(random, 60, 600)}}, {}


def _axis_off(random: Random) -> Told:
    north, east = between(random, 30, 200) * direction(random, 2)
    position = f"{random.choice(list('xyz'))}-{random.choice(['up', 'down'])}"
    lean = {"position": position, "north_arcsec": float(north), "east_arcsec": float(east)}
    return {"table_axis_error": lean}, {}


def _from_another_zero(random: Random) -> Told:
    shift = float(random.choice([-1, 1])) * between(random, 60, 300)
    told = {"shift_arcsec": shift, "at_s": float(random.uniform(400, 1000))}
    if random.uniform() < 0.5:  # the outer axis turns the case where z is up or down
        told["upright"] = str(random.choice(["+x", "-x", "+y", "-y"]))
    return {"table_zero_shift": told}, {}


ELSEWHERE: tuple[Elsewhere, ...] = (
    Elsewhere(("oscillation",), "positions", _ringing),
    Elsewhere(("table_ripple",), "positions", _ripple),
    Elsewhere(("table_eccentricity",), "rates", _eccentricity),
    Elsewhere(tuple(f"gyro_dead_band_{axis}" for axis in "xyz"), "rates", _dead_band),
    Elsewhere(
        ("gyro_random_walk",),
        "positions",
        lambda r: ({}, {WALKS["gyro"]: between(r, 0.3, 2)}),
    ),
    Elsewhere(
        ("gyro_flicker", "gyro_random_walk"),
        "positions",
        lambda r: ({"gyro_flicker": {"instability_deg_h": between(r, 0.3, 2)}}, {}),
    ),
    Elsewhere(
        ("gyro_saturation",),
        "positions",
        lambda r: ({"gyro_saturation": {"limit_deg_s": [_near(r, 10.0, 0.011)] * 3}}, {}),
    ),
    Elsewhere(
        ("accel_saturation",),
        "positions",
        lambda r: ({"accel_saturation": {"limit_g": [_near(r, 0.99867, 0.00055)] * 3}}, {}),
    ),
    Elsewhere(("table_ripple",), "rates", _ripple),
    Elsewhere(
        ("table_ripple", "oscillation"),  # one rate alone: 720 periods a turn are 20 Hz
        "positions",
        lambda r: (
            {
                "oscillation": {
                    "order": 720,
                    "amplitude_rad_s": between(r, 2e-4, 1e-2),
                    "axis": str(r.choice(["+x", "+y", "+z"])),
                }
            },
            {},
        ),
    ),
    Elsewhere(("turn_angle_error",), "rates", _turned_too_far),
    Elsewhere(("table_axis_error",), "stops", _axis_off),
    Elsewhere(("table_zero_shift", "table_zero_shift_outer"), "stops", _from_another_zero),
)

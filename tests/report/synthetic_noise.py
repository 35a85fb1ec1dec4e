"""Allan deviation, spectrum and terms of the noise, as two hours at rest would give them."""

from __future__ import annotations

import numpy as np

from inertial import tables
from tests.report.synthetic_values import DEGREE, Rows

HOUR = 3600.0
G = 9.80665
STRETCH = 2 * HOUR
RATE = 100.0
LINE = 12.5  # Hz, an oscillation of the table
ROOT_BINS = 60  # averaged periodograms
# Quantisation, white noise, bias instability, random walk, ramp of the x sensor; a term that is
# not in the data is 0. The other axes have a little more.
TRUE = {
    "gyro": (
        0.0,
        0.0667 * DEGREE / 60 * 0.8,
        0.12 * DEGREE / HOUR,
        0.5 * DEGREE / HOUR / 60,
        0.0,
    ),
    "accel": (0.0, 0.0065 / 60, 9e-6 * G, 0.0, 0.0),
}
NAMES = ("quantisation", "white_noise", "bias_instability", "random_walk", "ramp")
UNITS = {
    "gyro": ("rad", "rad/√s", "rad/s", "rad/s/√s", "rad/s²"),
    "accel": ("m/s", "m/s/√s", "m/s²", "m/s²/√s", "m/s³"),
}
LEVEL = {"x": 1.0, "y": 1.25, "z": 1.6}
UPPER = {"gyro": (2e-7, 0, 0, 0, 3e-11), "accel": (4e-5, 0, 0, 6e-7, 8e-9)}
SHEET = {"gyro": (None, 0.0667 * DEGREE / 60), "accel": (None, 0.0324 / 60)}


def variance(terms: tuple[float, ...], tau: np.ndarray) -> np.ndarray:
    """Allan variance at averaging times (IEEE Std 952, annex C)."""
    q, n, b, k, r = terms
    powers = (3 / tau**2, 1 / tau, 2 * np.log(2) / np.pi + 0 * tau, tau / 3, tau**2 / 2)
    return np.asarray(sum(c**2 * p for c, p in zip((q, n, b, k, r), powers, strict=True)))


def density(terms: tuple[float, ...], f: np.ndarray) -> np.ndarray:
    """Power density of both sides at frequencies (IEEE Std 952, annex C)."""
    q, n, b, k, r = terms
    w = 2 * np.pi * f
    return np.asarray(q**2 / RATE * w**2 + n**2 + b**2 / w + k**2 / w**2 + r**2 / w**3)


def terms_of(channel: str) -> tuple[float, ...]:
    sensor, _unused, axis = channel.partition("_")
    return tuple(LEVEL[axis] * value for value in TRUE[sensor])


def allan() -> Rows:
    generator = np.random.default_rng(7)
    tau = np.geomspace(0.01, STRETCH / 9, 45)
    rows: Rows = []
    for channel in tables.CHANNELS:
        model = np.sqrt(variance(terms_of(channel), tau))
        degrees = np.maximum(1.5 * STRETCH / tau, 2.0).clip(max=1e6)
        found = model * np.sqrt(generator.chisquare(degrees) / degrees)
        part = 1 / np.sqrt(2 * degrees)
        rows += [
            {
                "channel": channel,
                "tau": t,
                "deviation": d,
                "lower": d / (1 + p),
                "upper": d * (1 + 1.3 * p),
                "degrees": e,
                "model": m,
                "stretches": 2,
            }
            for t, d, p, e, m in zip(tau, found, part, degrees, model, strict=True)
        ]
    return rows


def spectra() -> Rows:
    generator = np.random.default_rng(8)
    frequency = np.geomspace(1e-3, RATE / 2, 140)
    rows: Rows = []
    for channel in tables.CHANNELS:
        model = density(terms_of(channel), frequency)
        degrees = np.clip(2 * ROOT_BINS * frequency / 0.1, 6, 4000)
        found = model * generator.chisquare(degrees) / degrees
        line = (np.abs(frequency / LINE - 1) < 0.04) & channel.startswith("accel")
        rows += [
            {
                "channel": channel,
                "frequency": f,
                "density": d * (30 if bad else 1),
                "degrees": e,
                "model": m,
                "line": bool(bad),
            }
            for f, d, e, m, bad in zip(frequency, found, degrees, model, line, strict=True)
        ]
    return rows


def terms() -> Rows:
    rows: Rows = []
    for channel in tables.CHANNELS:
        sensor = channel[:-2]
        for i, (name, value) in enumerate(zip(NAMES, terms_of(channel), strict=True)):
            found = value > 0
            sheet = SHEET[sensor]
            rows.append(
                {
                    "channel": channel,
                    "term": name,
                    "detected": found,
                    "stepped": False,
                    "tilted": False,
                    "value": value if found else None,
                    "sigma": value * (0.002, 0.002, 0.06, 0.2, 0.2)[i] if found else None,
                    "upper": None if found else UPPER[sensor][i],
                    "unit": UNITS[sensor][i],
                    "p_value": 1e-9 if found else 0.4,
                    "data_sheet": sheet[1] if i == 1 else None,
                    "seconds": STRETCH,
                }
            )
    return rows


def levels() -> Rows:
    return [
        {
            "channel": channel,
            "white_noise": terms_of(channel)[1],
            "sigma": 0.002 * terms_of(channel)[1],
            "source": "common",
            "degrees": 1e5,
        }
        for channel in tables.CHANNELS
    ]

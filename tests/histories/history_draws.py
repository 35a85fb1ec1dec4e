"""Simulated histories of one parameter: what the next calibration found, and whether it jumped.

They share no code with the estimation. A history has 3 to 12 calibrations, 0.3 to 1.5 years
apart, whose sigmas differ by 30 % about 1; then comes the next. Beside the sigmas it has one of:
nothing, a scatter of the days, a random walk, a steady drift, or all of these, each of 0.5 to 20
sigmas in a year.
"""

from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.estimation import history_of_values as estimated
from inertial.estimation.history_of_values import History, jump, predicted

KINDS = ("nothing", "days", "walk", "drift", "all")
FEWEST, MOST = 3, 12
JUMP_SIZES = (0.0, 10.0, 30.0)  # sigmas; with days that scatter by 1 sigma
LEVEL = 0.01
SEED = 71


@dataclass(frozen=True)
class Drawn:
    """A history with its next calibration as the last value."""

    kind: str
    values: Array
    sigma: Array
    times: Array


def drawn(number: int) -> Drawn:
    """One of the kinds in turn."""
    generator = np.random.default_rng((SEED, number))
    kind = KINDS[number % len(KINDS)]
    n = int(generator.integers(FEWEST, MOST + 1)) + 1
    gaps = generator.uniform(0.3, 1.5, n - 1)
    times = np.append(0, np.cumsum(gaps))
    sigma = np.exp(0.3 * generator.normal(size=n))
    days, walk, drift = (
        float(np.exp(generator.uniform(np.log(0.5), np.log(20)))) if kind in (one, "all") else 0.0
        for one in ("days", "walk", "drift")
    )
    values = 1000 * generator.normal() + drift * generator.choice((-1, 1)) * times
    values = values + np.cumsum(np.append(0, walk * np.sqrt(gaps) * generator.normal(size=n - 1)))
    values = values + days * generator.normal(size=n) + sigma * generator.normal(size=n)
    return Drawn(kind, values, sigma, times)


def outcome(part: str, number: int) -> dict[str, Any]:
    """Of one job: of the next calibration, or of a jump."""
    found = _next(number) if part == "next" else _jump(number)
    return {"code": code(), "part": part, "number": number, **found}


def _next(number: int) -> dict[str, Any]:
    one = drawn(number)
    known = History(one.values[:-1], one.sigma[:-1], one.times[:-1])
    prediction = predicted(known, one.times[-1:], known.unit)
    value = one.values[-1]
    return {
        "kind": one.kind,
        "calibrations": len(known.values),
        "holds": bool(prediction.low[0] <= value <= prediction.high[0]),
        "width": float(prediction.high[0] - prediction.low[0]),
    }


def _jump(number: int) -> dict[str, Any]:
    generator = np.random.default_rng((SEED, 1, number))
    size = JUMP_SIZES[number % len(JUMP_SIZES)]
    n = int(generator.integers(5, MOST + 1))
    times = np.cumsum(generator.uniform(0.3, 1.5, n))
    sigma = np.exp(0.3 * generator.normal(size=n))
    values = generator.normal(size=n) + sigma * generator.normal(size=n)
    before = int(generator.integers(0, n - 1))
    values[before + 1 :] += size
    found = jump(History(values, sigma, times), generator)
    named = found is not None and found.p_value < LEVEL
    right = named and found is not None and found.before == before
    return {"size": size, "calibrations": n, "named": bool(named), "right": bool(right)}


@cache
def code() -> str:
    """A hash of the code that an outcome rests on, as it was at the start."""
    files = (Path(__file__), Path(estimated.__file__))
    return sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:16]

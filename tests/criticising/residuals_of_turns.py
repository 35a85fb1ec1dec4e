"""Residuals of gyros in steady turns, made up: noise, ripples of the table, a ringing case."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from inertial.campaign.steady_residuals import SteadyTurn

NOISE = 3.5e-5  # rad/s of a sample at 100 Hz: 0.012 °/√h
STEP = 0.01  # s
ARC_SECOND = np.radians(1 / 3600)
MATRIX = np.array([[1.0006, 0.0025, 0.0075], [-0.0024, 1.0, -0.0007], [-0.0076, 0.0008, 1.0006]])


def turns(
    seed: int,
    ripples: Sequence[tuple[float, float, float]] = (),
    ringing: Sequence[tuple[float, float, str]] = (),
    rates: Sequence[float] = (20, -20),
    axes: str = "xyz",
    walk: float = 0.0,
) -> list[SteadyTurn]:
    """Whole turns about each axis at each rate, °/s, spun up with half the rate per second.

    `ripples`: order, a and b in rad; `ringing`: Hz, rad/s and axis, with a phase by chance in each
    turn; `walk`: rad/s/√s, a random walk of each gyro in each turn.
    """
    rng = np.random.default_rng(seed)
    made = []
    for axis in axes:
        for speed in rates:
            turn = still(axis, speed)
            n = len(turn.truth)
            truth = NOISE * rng.standard_normal((n, 3))
            truth += walk * np.sqrt(STEP) * np.cumsum(rng.standard_normal((n, 3)), axis=0)
            half = turn.rate * STEP / 2
            for order, a, b in ripples:
                edges = np.append(turn.angle - half, turn.angle[-1] + half)
                ahead = a * np.sin(order * edges) + b * np.cos(order * edges)
                truth += np.outer(np.diff(ahead) / STEP, turn.about)
            for hertz, size, where in ringing:
                truth[:, "xyz".index(where)] += line(n, hertz, size, rng.uniform(0, 2 * np.pi))
            made.append(replace(turn, truth=truth))
    return made


def locked(seed: int, hertz: float, size: float, where: str) -> list[SteadyTurn]:
    """Turns in which the case begins to ring when the turn begins: one phase in all of them."""
    made = []
    for turn in turns(seed):
        truth = turn.truth.copy()
        truth[:, "xyz".index(where)] += line(len(truth), hertz, size, 0.3)
        made.append(replace(turn, truth=truth))
    return made


def rippling(
    seed: int,
    orders: Sequence[tuple[float, float]],
    power: float = 1.0,
    rates: Sequence[float] = (20, -20, 40, -40),
    axes: str = "xyz",
) -> list[SteadyTurn]:
    """Turns of a table whose rate ripples, from another tooth of its gear on in each turn.

    `orders`: with its amplitude in rad/s at the first rate; `power`: of the rate, as which the
    amplitude goes.
    """
    rng = np.random.default_rng(seed)
    made = []
    for turn in turns(seed + 1000, rates=rates, axes=axes):
        truth = turn.truth.copy()
        share = (np.degrees(abs(turn.rate)) / abs(rates[0])) ** power
        for order, size in orders:
            phase = rng.uniform(0, 2 * np.pi)
            sampled = line(len(truth), turn.hertz(order), share * size, phase)
            truth += np.outer(sampled, turn.about)
        made.append(replace(turn, truth=truth))
    return made


def still(axis: str, speed: float) -> SteadyTurn:
    """A whole turn at `speed`, °/s, without noise."""
    rate = np.radians(speed)
    n = round((360 / abs(speed) - 2.0) / STEP)
    # A spin-up of 2 s turns by the rate times 1 s.
    angle = rate * (1.0 + STEP * (np.arange(n) + 0.5))
    about = np.eye(3)["xyz".index(axis)]
    name = f"{axis} {speed:g}"
    zero = np.zeros((n, 3))
    return SteadyTurn(name, about, MATRIX, zero, zero, angle, STEP, True, tilted=False)


def line(n: int, hertz: float, size: float, phase: float) -> np.ndarray:
    """The mean over each sample of a sine, (n,)."""
    time = STEP * np.arange(n)
    return size * np.sinc(hertz * STEP) * np.sin(2 * np.pi * hertz * time + phase)

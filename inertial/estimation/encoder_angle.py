"""A gyro against the encoder of the table, through a turn from rest to rest.

    ∫ω̃ dt = (1 + s) E(t − τ) + b t + c + Σ a_n sin nE + b_n cos nE

E is the angle that the encoder reads. s is the scale factor's error of the gyro less that of the
encoder: of all gyros alike, nothing tells which of the two is off. τ is the delay of the gyro less
the latency of the encoder, told in the ramps alone; where the encoder is known to be prompt, it is
the lag of the gyro, of a first-order low pass the time constant, and 1/(2πτ) its bandwidth. The
harmonics are errors of the encoder that repeat with each turn: its eccentricity is n = 1. A ripple
of the drive is a motion that both see, and stands in the encoder's own course.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.probability import f_sf
from inertial.estimation.time_angle import Valued

Array = NDArray[np.float64]

BIN_S = 0.05  # s, between edges whose angles are compared
MAX_STEPS = 5  # of Gauss and Newton, for the delay alone is not linear
ORDERS = (1, 2)  # of the encoder's own errors
MIN_TURNED = 1.5 * np.pi  # rad, below which these are not told from scale factor and bias
RIPPLE_ORDERS = np.arange(3.0, 60.25, 0.25)  # of the drive, periods in a turn
MIN_PERIOD_SAMPLES = 4.0  # of a ripple


@dataclass(frozen=True)
class AgainstEncoder:
    """What the gyro reads beyond the encoder.

    `scale`: 1; `bias`: rad/s, the earth's rate in it; `delay`: s, by which the gyro is later;
    `harmonics`: rad, by order, sine and cosine; empty for less than three quarters of a turn.
    `excess`: chi-squared per degree of freedom; where above 1 the sigmas are enlarged.
    """

    scale: Valued
    bias: Valued
    delay: Valued
    harmonics: dict[int, tuple[Valued, Valued]]
    excess: float


def against_encoder(rates: Array, angle: Array, step: float, density: float) -> AgainstEncoder:
    """Compare n samples of a gyro, rad/s, with the encoder at their ends, rad; both (n,).

    `step`: s, of a sample; `density`: rad/√s, white noise of the gyro.
    """
    length = max(round(BIN_S / step), 1)
    edges = np.arange(0, len(rates), length)
    time = step * np.arange(len(rates))
    summed = np.cumsum(rates) * step
    read = np.diff(summed[edges])
    speed = np.gradient(angle, step)
    count = float(np.min(np.abs(np.diff(angle))[np.diff(angle) != 0], initial=0.0))
    sigma = float(np.hypot(density * np.sqrt(length * step), count / np.sqrt(6)))
    delay, orders = 0.0, ORDERS if np.ptp(angle) > MIN_TURNED else ()
    for _ in range(MAX_STEPS):
        late = np.interp(time[edges] - delay, time, angle)
        rate = np.interp(time[edges] - delay, time, speed)
        columns = [np.diff(late), np.diff(time[edges]), -np.diff(rate)]
        for n in orders:
            columns += [
                np.diff(np.sin(n * late)),
                np.diff(np.cos(n * late)),
            ]
        design = np.column_stack(columns)
        solution, *_rest = np.linalg.lstsq(design, read, rcond=None)
        delay += float(solution[2])
    residual = read - design @ solution
    freedom = max(len(read) - design.shape[1], 1)
    excess = float(residual @ residual) / sigma**2 / freedom
    spread = sigma * np.sqrt(max(excess, 1.0) * np.diag(np.linalg.pinv(design.T @ design)))
    found = [Valued(float(v), float(s)) for v, s in zip(solution, spread, strict=True)]
    return AgainstEncoder(
        Valued(found[0].value - 1, found[0].sigma),
        found[1],
        Valued(delay, found[2].sigma),
        {n: (found[3 + 2 * i], found[4 + 2 * i]) for i, n in enumerate(orders)},
        excess,
    )


def corrected(angle: Array, harmonics: Mapping[int, tuple[float, float]]) -> Array:
    """The angle of the table, (n,), rad, by that of its encoder and the errors of this."""
    waves = (a * np.sin(n * angle) + b * np.cos(n * angle) for n, (a, b) in harmonics.items())
    return np.asarray(angle + sum(waves, np.zeros(len(angle))))


@dataclass(frozen=True)
class Ripple:
    """The strongest harmonic of the angle in the steady part: its amplitude, rad, and chance."""

    order: float
    amplitude: Valued
    p_value: float


def ripple(angle: Array) -> Ripple | None:
    """The ripple of the drive as the encoder reads it at n even times of the steady part, (n,)."""
    turned = abs(float(angle[-1] - angle[0]))
    per_sample = turned / (len(angle) - 1)
    orders = RIPPLE_ORDERS[
        (RIPPLE_ORDERS * turned > 4 * np.pi)
        & (RIPPLE_ORDERS * per_sample * MIN_PERIOD_SAMPLES < 2 * np.pi)
    ]
    if not len(orders):
        return None
    # A drive that speeds up slowly is no ripple: a parabola goes out.
    slow = np.linalg.qr(np.vander(np.linspace(-1, 1, len(angle)), 3))[0]
    even = angle[0] + (angle[-1] - angle[0]) * np.linspace(0, 1, len(angle))
    rest = angle - slow @ (slow.T @ angle)
    total, best = float(rest @ rest), (0.0, 0.0, np.zeros(2), np.eye(2))
    for order in orders:
        waves = np.column_stack([np.sin(order * even), np.cos(order * even)])
        waves -= slow @ (slow.T @ waves)
        normal = waves.T @ waves
        part = np.linalg.solve(normal, waves.T @ rest)
        reduced = float(part @ normal @ part)
        if reduced > best[0]:
            best = reduced, float(order), part, np.linalg.inv(normal)
    reduced, order, part, inverse = best
    freedom = len(angle) - 5
    left = max(total - reduced, np.finfo(float).tiny) / freedom
    chance = float(f_sf(reduced / 2 / left, 2, freedom))
    size = float(np.linalg.norm(part))
    sigma = float(np.sqrt(left * np.trace(inverse) / 2))
    return Ripple(order, Valued(size, sigma), min(1.0, chance * len(orders)))

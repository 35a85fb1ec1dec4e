"""A gyro against the encoder of the table, through a turn from rest to rest.

    ∫ω̃ dt = (1 + s) (E(t − τ) + κ/2 Ë(t − τ)) + b t + c + Σ a_n sin nE + b_n cos nE

E is the angle that the encoder reads. s is the scale factor's error of the gyro less that of the
encoder: of all gyros alike, nothing tells which of the two is off. The two filters, gyro over
encoder, are known by their cumulants: τ is the mean delay of the gyro less that of the encoder, in
the ramps alone; κ the variance of the delay. A time by which one of them is read late has none, and
a first-order low pass of time constant L has the mean L and the variance L². So

    L = √κ,   bandwidth 1/(2πL),   τ − L = dead time of the gyro less latency of the encoder,

where κ is known to be above 0: in a ramp of acceleration a it is an angle of κ a/2. Otherwise low
pass, dead time and latency are one class, of which τ is known. A dead time and a latency always
are. The harmonics are errors of the encoder that repeat with each turn: its eccentricity is n = 1.
A ripple of the drive is a motion that both see, and stands in the encoder's own course.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_interp_spline

from inertial.arrays import Array, Booleans
from inertial.estimation.probability import f_sf
from inertial.estimation.time_angle import Valued

BIN_S = 0.05  # s, between edges whose angles are compared
SETTLED = 8.0  # time constants, after which e⁻⁸ of an answer is left
LONGEST_SETTLING_S = 0.3  # s
MAX_CHANGE = 0.2  # of the acceleration near an edge, relative to the largest ones
ACCELERATING = 0.98  # quantile of the accelerations, for the largest one may be an impact
CURVED_S = 0.01  # s, to either side at least, of which the acceleration is a difference
THIRD = 0.6745 * np.sqrt(20 / 12)  # median of the third differences of angles, over their count
MAX_ROUNDED = 1e-3  # of the acceleration of ramps, that counts of the encoder add: else κ is lost
MAX_STEPS = 5  # of Gauss and Newton, for the delay alone is not linear
ORDERS = (1, 2)  # of the encoder's own errors
MIN_TURNED = 1.5 * np.pi  # rad, below which these are not told from scale factor and bias
RIPPLE_ORDERS = np.arange(3.0, 60.25, 0.25)  # of the drive, periods in a turn
MIN_PERIOD_SAMPLES = 4.0  # of a ripple


@dataclass(frozen=True)
class AgainstEncoder:
    """What the gyro reads beyond the encoder.

    `scale`: 1; `bias`: rad/s, the earth's rate in it; `delay`: s, by which the gyro is later;
    `spread`: s², κ, the variance of this delay; `harmonics`: rad, by order, sine and cosine; empty
    for less than three quarters of a turn. Where chi-squared is above its degrees of freedom, the
    sigmas are enlarged.
    """

    scale: Valued
    bias: Valued
    delay: Valued
    spread: Valued
    harmonics: dict[int, tuple[Valued, Valued]]


def against_encoder(rates: Array, angle: Array, step: float, density: float) -> AgainstEncoder:
    """Compare n samples of a gyro, rad/s, with the encoder at their ends, rad; both (n,).

    `step`: s, of a sample; `density`: rad/√s, white noise of the gyro.
    """
    found = _compared(rates, angle, step, density, 0.0)
    # A slow low pass settles later: the edges shortly after a change of acceleration go out, too.
    if found.spread.value > found.spread.sigma:
        settled = SETTLED * float(np.sqrt(found.spread.value))
        found = _compared(rates, angle, step, density, min(settled, LONGEST_SETTLING_S))
    return found


def _compared(
    rates: Array, angle: Array, step: float, density: float, settled: float
) -> AgainstEncoder:
    """The comparison; `settled`: s, within which the low pass of the gyro settles."""
    time: Array = step * np.arange(len(rates), dtype=np.float64)
    count = _count(angle)
    course = make_interp_spline(time, angle, k=3)
    near = BIN_S

    def curved(at: Array) -> Array:
        at = np.clip(at, near, time[-1] - near)
        return np.asarray((course(at + near) - 2 * course(at) + course(at - near)) / near**2)

    edges = np.arange(0, len(rates), max(round(BIN_S / step), 1))
    ramps = float(np.quantile(np.abs(curved(np.asarray(time[edges]))), ACCELERATING))
    near = max(CURVED_S, 2 * step, min(BIN_S, float(np.sqrt(count / (MAX_ROUNDED * ramps)))))
    edges = edges[_calm(np.asarray(time[edges]), curved, near, settled)]
    read = np.diff((np.cumsum(rates) * step)[edges])
    speed = np.gradient(angle, step)
    sigma = np.hypot(density * np.sqrt(np.diff(time[edges])), count / np.sqrt(6))
    delay, orders = 0.0, ORDERS if np.ptp(angle) > MIN_TURNED else ()
    for _ in range(MAX_STEPS):
        at = np.clip(time[edges] - delay, 0.0, time[-1])
        late, rate, gain = course(at), np.interp(at, time, speed), curved(at)
        columns = [np.diff(late), np.diff(time[edges]), -np.diff(rate), np.diff(gain) / 2]
        for n in orders:
            columns += [np.diff(np.sin(n * late)), np.diff(np.cos(n * late))]
        design = np.column_stack(columns) / sigma[:, None]
        solution, *_rest = np.linalg.lstsq(design, read / sigma, rcond=None)
        delay += float(solution[2])
    residual = read / sigma - design @ solution
    freedom = max(len(read) - design.shape[1], 1)
    excess = float(residual @ residual) / freedom
    spread = np.sqrt(max(excess, 1.0) * np.diag(np.linalg.pinv(design.T @ design)))
    found = [Valued(float(v), float(s)) for v, s in zip(solution, spread, strict=True)]
    return AgainstEncoder(
        Valued(found[0].value - 1, found[0].sigma),
        found[1],
        Valued(delay, found[2].sigma),
        found[3],
        {n: (found[4 + 2 * i], found[5 + 2 * i]) for i, n in enumerate(orders)},
    )


def _count(angle: Array) -> float:
    """One count of the encoder, rad, by the roughness of its angles in motion, (n,)."""
    moving = np.abs(np.diff(angle)[1:-1])
    rough = np.abs(np.diff(angle, 3))[moving > moving.max() / 2]
    return float(np.median(rough)) / THIRD if len(rough) else 0.0


def _calm(edges: Array, curved: Callable[[Array], Array], near: float, settled: float) -> Booleans:
    """The edges, (k,), s, where the acceleration of the table is the same before and after."""
    size = np.abs(curved(edges))
    ago = np.arange(0.0, settled + near, near)[:, None]
    change = np.abs(curved(edges - ago + near) - curved(edges - ago - near)).max(axis=0)
    calm = change <= MAX_CHANGE * np.quantile(size, ACCELERATING)
    calm[[0, -1]] = True
    return np.asarray(calm if calm.sum() > len(calm) / 2 else np.ones(len(calm), bool))


def low_pass(spread: Valued, least: float) -> Valued | None:
    """The time constant, s, of a first-order low pass by κ; none below `least` sigmas of that."""
    if spread.value <= least * spread.sigma:
        return None
    constant = float(np.sqrt(spread.value))
    return Valued(constant, spread.sigma / (2 * constant))


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

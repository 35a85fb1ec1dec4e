"""The bandwidth of a gyro as of a first-order low pass, y = u − L dy/dt: 1/(2πL), in Hz.

By ramps of the rate. In a constant acceleration a that begins and ends, a response with the delays
τ, of the variance κ, gives the angle

    ∫ω̃ dt = θ(t − mean τ) + κ a/2    within the ramp,    κ = L²,

so κ stands in the corners of the ramp and the mean delay in when it began. Against the encoder of
the table (`encoder_angle`) κ is that of the gyro. Without one the ramps are those that the gyro
itself reads: the table is taken to turn evenly, to accelerate evenly, to turn evenly again, with
all four times and the speed unknown. A drive that rounds the corners then adds a κ of its own, and
only a lower limit of the bandwidth is the gyro's. A second-order low pass of damping 1/√2 has no κ,
only a delay.

By noise at rest, whose density a low pass behind its source lessens as it does rates. What it does
to the rates before that source the noise does not say.

Source: IEEE Std 1431-2004, 12.10 (frequency response); IEEE Std 528-2019, 'bandwidth'.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from inertial.arrays import Array
from inertial.estimation.probability import chi2_isf, norm_isf
from inertial.estimation.time_angle import Valued

MIN_SIGMAS = 3.0  # of κ above 0, from which a low pass is certain
CONFIDENCE = 0.95  # of a lower limit, one-sided
BIN_S = 0.05  # s, between edges whose angles are compared
SETTLED = 8.0  # time constants, after which e⁻⁸ of an answer is left
SHARES = (0.1, 0.9)  # of the speed, by which a ramp is found
MIN_EDGES = 4  # within each ramp
MAX_STEPS = 12  # of Gauss and Newton
MAX_SHIFT_S = 1e-6  # s, of the corners, after which they are found


@dataclass(frozen=True)
class Bandwidth:
    """Hz. Where no low pass is certain `value` and `sigma` are None; `lower`: its lower limit."""

    value: float | None
    sigma: float | None
    lower: float | None


def first_order(spread: Valued) -> Bandwidth:
    """The bandwidth by the variance of the delay, s²."""
    most = spread.value + float(norm_isf(1 - CONFIDENCE)) * spread.sigma
    lower = _hertz(np.sqrt(most)) if most > 0 else None
    if spread.value <= MIN_SIGMAS * spread.sigma:
        return Bandwidth(None, None, lower)
    hertz = _hertz(np.sqrt(spread.value))
    return Bandwidth(hertz, hertz * spread.sigma / (2 * spread.value), lower)


def _hertz(constant: float) -> float:
    return float(1 / (2 * np.pi * constant))


# ---- By the ramps that the gyro reads.


def spread_by_ramps(rates: Array, step: float, density: float) -> Valued | None:
    """κ, s², of gyro and drive together, by a turn from rest to rest, (n,), rad/s, positive.

    `step`: s, of a sample; `density`: rad/√s, white noise. Where residuals exceed that the sigma is
    enlarged. None where a ramp is too short for edges within it, or the rest before it is.
    """
    length = max(round(BIN_S / step), 1)
    edges = length * np.arange(len(rates) // length + 1)
    time = np.asarray(edges * step, np.float64)
    angle: Array = np.append(0.0, np.cumsum(rates))[edges] * step
    start = _found(time, angle)
    if start is None:
        return None
    unknowns, settled = start, 0.0
    for settled in (0.0, SETTLED):
        unknowns, sigma = _fitted(time, angle, density, unknowns, settled)
        if not np.isfinite(sigma):
            return None
    return Valued(float(unknowns[-1]), sigma)


def _found(time: Array, angle: Array) -> Array | None:
    """Speed, bias, the four corners and κ = 0, by when the rate passes shares of the speed."""
    rate, middle = np.diff(angle) / np.diff(time), (time[1:] + time[:-1]) / 2
    speed = float(np.median(rate[rate > rate.max() / 2]))
    corners = []
    for sign in (1, -1):
        at = []
        for share in SHARES:
            above = np.flatnonzero(rate > share * speed)
            i = int(above[0] if sign > 0 else above[-1] + 1)
            if not 0 < i < len(rate):
                return None
            part = (share * speed - rate[i - 1]) / (rate[i] - rate[i - 1])
            at.append(middle[i - 1] + part * (middle[i] - middle[i - 1]))
        lasts = abs(at[1] - at[0]) / (SHARES[1] - SHARES[0])
        first = at[0] - SHARES[0] * lasts if sign > 0 else at[1] - (1 - SHARES[1]) * lasts
        corners += [first, first + lasts]
    return np.array([speed, 0.0, *corners, 0.0])


def _fitted(
    time: Array, angle: Array, density: float, start: Array, settled: float
) -> tuple[Array, float]:
    """The unknowns and the sigma of κ; NaN where they are not determined."""
    unknowns = start.copy()
    near = max(settled * float(np.sqrt(max(start[-1], 0.0))), 1.01 * float(time[1] - time[0]))
    for _ in range(MAX_STEPS):
        corners = unknowns[2:6]
        calm = (np.abs(time[:, None] - corners) > near).all(axis=1)
        at = time[calm]
        inside = [np.sum((at > a) & (at < b)) for a, b in (corners[:2], corners[2:])]
        if min(*inside, np.sum(at < corners[0])) < MIN_EDGES:
            return unknowns, np.nan
        course, columns = _course(at, unknowns)
        weights = 1 / (density * np.sqrt(np.diff(at)))
        design = np.diff(columns, axis=0) * weights[:, None]
        residual = (np.diff(angle[calm]) - np.diff(course)) * weights
        shift, *_rest = np.linalg.lstsq(design, residual, rcond=None)
        unknowns = unknowns + shift
        if np.abs(shift[2:6]).max() < MAX_SHIFT_S:
            break
    residual = residual - design @ shift
    excess = float(residual @ residual) / max(len(residual) - len(unknowns), 1)
    covariance = np.linalg.pinv(design.T @ design) * max(excess, 1.0)
    return unknowns, float(np.sqrt(covariance[-1, -1]))


def _course(time: Array, unknowns: Array) -> tuple[Array, Array]:
    """The angle read at n times, and its derivatives to the unknowns, (n, 7)."""
    speed, bias, *corners, spread = unknowns
    shape, curved = np.zeros(len(time)), np.zeros(len(time))
    of_corners = []
    for sign, first, after in ((1, *corners[:2]), (-1, *corners[2:])):
        lasts = after - first
        share = np.clip((time - first) / lasts, 0.0, 1.0)
        shape += sign * (share**2 * lasts / 2 + np.maximum(time - after, 0.0))
        curved += sign * ((time > first) & (time < after)) / lasts
        of_after = -sign * share**2 / 2
        of_corners += [-sign * share - of_after, of_after]
    columns = [
        shape + spread / 2 * curved,
        time,
        *(speed * each for each in of_corners),
        speed * curved / 2,
    ]
    return speed * columns[0] + bias * time, np.column_stack(columns)


# ---- By noise.

HIGHEST = 0.25  # of the sampling rate: beyond it quantisation and the filters of sampling act
LOWEST = 0.01  # of the sampling rate: below it the bias drifts
CONSTANTS = np.append(0.0, np.geomspace(0.05, 20.0, 121))  # samples, time constants that are tried
ROUNDS = 6  # of weights by the model
MIN_BINS = 8
Shape = Callable[[Array, float], Array]


def by_noise(frequency: Array, density: Array, degrees: Array, interval: float) -> Bandwidth | None:
    """The bandwidth of white noise at rest, by b bins of its density.

        S(f) = N² G(f; L) + Q² 4 sin²(πfT)/T

    G is that of means over T of a continuous noise through the low pass, or of a filter of the
    samples; which of them is not known, so half of what they differ by is added to the sigma.
    `frequency`: Hz; `density`: both-sided; `degrees`: of freedom of each bin; `interval`: T, s.
    None where there are too few bins.
    """
    turn = frequency * interval
    used = (turn > LOWEST) & (turn < HIGHEST)
    if used.sum() < MIN_BINS:
        return None
    bins = turn[used], density[used], degrees[used]
    found = [_likeliest(shape, *bins) for shape in (of_means, of_samples)]
    lower = [each.lower for each in found if each.lower is not None]
    values = [each.value for each in found if each.value is not None]
    limit = min(lower) / interval if len(lower) == len(found) else None
    if len(values) < len(found):
        return Bandwidth(None, None, limit)
    sigma = np.hypot(max(each.sigma or 0.0 for each in found), np.ptp(values) / 2)
    return Bandwidth(float(np.mean(values)) / interval, float(sigma) / interval, limit)


def _likeliest(shape: Shape, turn: Array, density: Array, degrees: Array) -> Bandwidth:
    """By the likelihood of the bins, each χ²; per sample."""
    deviance = np.array([_deviance(shape(turn, L), turn, density, degrees) for L in CONSTANTS])
    best = int(np.argmin(deviance))
    above = deviance - deviance[best]
    limit = float(chi2_isf(2 - 2 * CONFIDENCE, 1))
    i = best + int(np.argmax(above[best:] > limit))
    lower = None
    if i > best:
        lower = _hertz(float(np.interp(limit, above[i - 1 : i + 1], CONSTANTS[i - 1 : i + 1])))
    if above[0] < MIN_SIGMAS**2 or not 1 < best < len(CONSTANTS) - 1:
        return Bandwidth(None, None, lower)
    # A parabola through those of three logarithms.
    logs = np.log(CONSTANTS[best - 1 : best + 2])
    curve, slope, _ = np.polyfit(logs - logs[1], above[best - 1 : best + 2], 2)
    hertz = _hertz(np.exp(logs[1] - slope / (2 * curve)))
    return Bandwidth(hertz, hertz / float(np.sqrt(curve)), lower)


def _deviance(shape: Array, turn: Array, density: Array, degrees: Array) -> float:
    """−2 log of the likelihood with the likeliest N and Q."""
    shapes = np.column_stack([shape, np.sin(np.pi * turn) ** 2])
    scale = float(np.average(density, weights=degrees))
    model = np.full(len(density), scale)
    for _ in range(ROUNDS):
        weights = np.sqrt(degrees) * scale / model
        sizes, _norm = nnls(shapes * weights[:, None], density / scale * weights)
        model = np.maximum(scale * shapes @ sizes, 1e-9 * scale)
    return float(np.sum(degrees * (np.log(model) + density / model)))


def of_means(turn: Array, constant: float) -> Array:
    """G of means of white noise of density 1 through a low pass, (b,); L in samples, fT.

    By the autocovariances of the means, c₀ = 1 − L (1 − a), c_j = L/2 (1 − a)² a^(j−1),
    a = exp(−1/L).
    """
    if constant == 0:
        return np.ones_like(turn)
    decay, cosine = np.exp(-1 / constant), np.cos(2 * np.pi * turn)
    series = (cosine - decay) / (1 - 2 * decay * cosine + decay**2)
    return np.asarray(1 - constant * (1 - decay) + constant * (1 - decay) ** 2 * series)


def of_samples(turn: Array, constant: float) -> Array:
    """G of samples of white noise, each constant over its interval, through a low pass, (b,)."""
    if constant == 0:
        return np.ones_like(turn)
    decay, share = np.exp(-1 / constant), constant * (1 - np.exp(-1 / constant))
    before = np.exp(-2j * np.pi * turn)
    return np.asarray(np.abs(1 - share + share * (1 - decay) * before / (1 - decay * before)) ** 2)

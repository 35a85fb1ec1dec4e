"""White noise and random walk for a filter: measured, and with the calibration's own errors.

A filter such as Kalibr's or an autopilot's knows two numbers of a sensor: the density N of its
white noise and the random walk K of its bias. From them it takes the variance of an integral over
T as

    N² T + K² T³ / 3                                                                           (1)

Corrected readings have an error e = −M⁻¹ (δM · x + δb) of which the filter knows nothing: δM and δb
by the covariance of the result, and what a format cannot correct at all. In a stated motion, x =
gravity (accelerometers) + a part with mean 0, rms q about or along each axis and correlation
exp(−t/τ), its integral over T has two parts:

    constant: variance c² T²,   c² = var δb + tr(var δM) g²/3, gravity in any direction
    moving:   variance 2 m² τ (T − τ (1 − e^(−T/τ))),   m² = tr(var δM) q²

What is constant wanders like a bias: K² grows by 3 c²/T. What moves scatters like noise: N² grows
by its variance over T. Then (1) gives at T exactly the variance of the integral with these errors.
A bias instability B that was measured grows K² by 3 · (2 ln 2 / π) B² / T, the random walk of the
same Allan deviation at T, and a ramp R by 3 R² T / 4, of the same integral. Quantisation is left
out: its integral does not grow with time.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

from inertial.arrays import Array
from inertial.campaign.records import Row
from inertial.estimation.noise_model import FLOOR_VARIANCE
from inertial.physics.effect import Reading, Truth
from inertial.physics.motion import stretches
from inertial.tables import AXES
from inertial.text.parameters import SENSOR_OF
from inertial.text.units import STANDARD_GRAVITY
from stages.export.calibration import PARAMETERS, Triad, Use

INSTANT = 1e-6  # s, duration of a probe


@dataclass(frozen=True)
class FilterNoise:
    """White noise and random walk of the bias of a channel: measured, and for a filter.

    measured_density, measured_walk : (rad/s)/√Hz or (m/s²)/√Hz, and per √s; the walk none where no
        static stretch was long enough
    walk_is_limit : no random walk is significant, and this is its upper limit
    density, walk : for a filter, in the same units; the walk none where none was measured
    own_density, own_walk : what the calibration's own errors contribute, none where not known
    """

    axis: str
    measured_density: float
    measured_walk: float | None
    walk_is_limit: bool
    density: float
    walk: float | None
    own_density: float | None
    own_walk: float | None


def filter_noise(
    triad: Triad, noise: Sequence[Row], use: Use, left: tuple[Array, Array] | None = None
) -> list[FilterNoise]:
    """Of each sensor of a triad whose noise was measured.

    left : offset and scale (3,) of a format that corrects axis by axis, (reading − offset) × scale;
        none where readings are corrected by all of the result
    """
    sensor = SENSOR_OF[triad.kind]
    errors = calibration_errors(triad, use, left)
    found = []
    for row in noise:
        of, _unused, axis = row["channel"].partition("_")
        if of == sensor:
            constant, moving = errors.get(axis, (None, None))
            found.append(_of_channel(axis, row, use, constant, moving))
    return found


def _of_channel(
    axis: str, row: Row, use: Use, constant: float | None, moving: float | None
) -> FilterNoise:
    """`constant`, `moving`: mean squares c² and m² of the errors."""
    terms: Mapping[str, Row] = row["terms"]
    detected = {name: term["value"] for name, term in terms.items() if term["detected"]}
    walk = detected.get("random_walk")
    limit = terms.get("random_walk", {}).get("upper") if walk is None else None
    measured = walk if walk is not None else limit
    density = row["density"]
    drift = 3 * FLOOR_VARIANCE * detected.get("bias_instability", 0.0) ** 2 / use.seconds
    drift += 3 * detected.get("ramp", 0.0) ** 2 * use.seconds / 4
    own_density = None if moving is None else sqrt(moving * use.moving)
    own_walk = None if constant is None else sqrt(3 * constant / use.seconds)
    return FilterNoise(
        axis,
        density,
        measured,
        limit is not None,
        sqrt(density**2 + (own_density or 0.0) ** 2),
        None if measured is None else sqrt(measured**2 + drift + (own_walk or 0.0) ** 2),
        own_density,
        own_walk,
    )


def calibration_errors(
    triad: Triad, use: Use, left: tuple[Array, Array] | None
) -> dict[str, tuple[float, float]]:
    """Axis → mean squares (c², m²) of the errors of corrected readings, (rad/s)² or (m/s²)².

    An axis of which not all is determined has none.
    """
    inverse = triad.inverse
    if inverse is None or not np.isfinite(triad.bias).all():
        return {}
    count = len(PARAMETERS)
    covariance = np.zeros((4, 3, 4, 3))  # of −M⁻¹ δM and −M⁻¹ δb: first index M's column, or bias
    own = triad.covariance[:count, :count]
    matrix = own[:9, :9].reshape(3, 3, 3, 3)
    covariance[:3, :, :3, :] = np.einsum("ai,ikjl,bj->kalb", inverse, matrix, inverse)
    covariance[3, :, 3, :] = inverse @ own[9:, 9:] @ inverse.T
    remaining = np.zeros((4, 3))
    if left is not None:
        offset, scale = left
        remaining[:3] = (scale[:, None] * triad.matrix - np.eye(3)).T
        remaining[3] = scale * (triad.bias - offset)
    constant_of_effects, moving_of_effects = (
        (np.zeros(3), np.zeros(3)) if left is None else _effects(triad, use)
    )
    errors = {}
    for i, axis in enumerate(AXES):
        square = covariance[:, i, :, i] + np.outer(remaining[:, i], remaining[:, i])
        matrix_part = float(np.trace(square[:3, :3]))
        gravity = STANDARD_GRAVITY**2 / 3 * matrix_part if triad.kind == "accelerometer" else 0.0
        constant = float(square[3, 3]) + gravity + constant_of_effects[i]
        moving = matrix_part * use.rms(triad.kind) ** 2 + moving_of_effects[i]
        if np.isfinite(constant) and np.isfinite(moving):
            errors[axis] = (float(constant), float(moving))
    return errors


def _effects(triad: Triad, use: Use) -> tuple[Array, Array]:
    """Mean squares of what the effects of the model add: under gravity, and by the motion, (3,)."""
    probes = np.vstack([np.eye(3), -np.eye(3)])
    still = np.zeros_like(probes)

    def added(rate: Array, force: Array) -> Array:
        motion = stretches(np.zeros(6), np.full(6, INSTANT), np.full(6, np.nan))
        truth, total = Truth(rate, force), np.zeros_like(probes)
        for one in triad.removable:
            reading = one.effect.reads(Reading(still, still), truth, motion, one.values)
            total += np.nan_to_num(reading.gyro if triad.kind == "gyroscope" else reading.accel)
        return total

    gravity = (added(still, STANDARD_GRAVITY * probes) ** 2).mean(axis=0)
    by_rate = (added(use.rate_rms * probes, still) ** 2).sum(axis=0) / 2
    by_force = (added(still, use.force_rms * probes) ** 2).sum(axis=0) / 2
    return gravity, by_rate + by_force

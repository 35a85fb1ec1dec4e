"""The accelerometers by the sources' own formulas, beside the joint estimate.

`six_position`: S0 (3-6), all rests alike. `up_and_down`: S1, two positions with tilt, where the
plan has no more. `pooled_positions`: S3, stops at one attitude pooled. All have the sigmas that the
sources leave out.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from inertial.campaign.estimates import NAMES, Estimates, Wanted
from inertial.campaign.static_positions import StaticPosition
from inertial.estimation.accelerometer_formulas import (
    Upright,
    pooled_positions,
    six_position_formula,
    up_and_down,
)
from inertial.estimation.accelerometers import Reference, StaticForce
from inertial.estimation.triad import UNKNOWNS, errors_of
from inertial.tables import AXES


def add_six_positions(
    estimates: Estimates,
    planned: Sequence[tuple[StaticPosition, StaticForce]],
    reference: Reference,
    scatter: float,
    wanted: float,
) -> None:
    """S0's formula from the rests of the plan; where they do not span it, S1's from pairs.

    `scatter`: m/s², between rests; `wanted`: m/s², required sigma of a bias, from which the
    length of the rests follows.
    """
    rests = [rest for _, rest in planned]
    solved = six_position_formula(rests, *reference[:3], scatter) if rests else None
    if solved is None:
        _add_up_and_down(estimates, rests, reference, scatter)
        return
    unknowns, covariance = solved
    estimates.add("six_position", NAMES, errors_of(unknowns), covariance, {})
    ideal = six_position_formula(
        [replace(rest, sigma=np.zeros(3)) for rest in rests], *reference[:3]
    )
    assert ideal is not None  # it depends on the same attitudes
    seconds = float(np.mean([position.seconds.sum() for position, _ in planned]))
    for i, axis in enumerate(AXES, UNKNOWNS - 3):
        sigma, floor = (float(np.sqrt(of[i, i])) for of in (covariance, ideal[1]))
        estimates.add_wanted("six_position", axis, Wanted(sigma, floor, seconds), wanted)


def _add_up_and_down(
    estimates: Estimates,
    rests: Sequence[StaticForce],
    reference: Reference,
    scatter: float,
) -> None:
    for i, axis in enumerate(AXES):
        readings = [
            Upright(float(rest.up[i]), float(rest.mean[i]), float(np.hypot(rest.sigma[i], scatter)))
            for rest in rests
            if abs(rest.up[i]) > 1 - 1e-9 and np.isfinite(rest.mean[i] * rest.sigma[i])
        ]
        result = up_and_down(readings, *reference[:3])
        if result is not None:
            values = np.array([result.bias, result.scale])
            sigmas = np.array([result.bias_sigma, result.scale_sigma])
            names = (f"bias_{axis}", f"scale_{axis}")
            estimates.add("up_and_down", names, values, np.diag(sigmas**2), {})


def add_pooled_positions(
    estimates: Estimates,
    rests: Sequence[StaticForce],
    reference: Reference,
    scatter: float,
) -> None:
    """S3's formula, for plans with rotations both ways and stops at common positions."""
    pooled = pooled_positions(rests, *reference[:3], scatter)
    if pooled is not None:
        values = errors_of(pooled.values)
        estimates.add("pooled_positions", NAMES, values, pooled.covariance, {})

"""The azimuths of static positions by the final result, where the heading is not known.

The joint estimate has azimuths of its own, but without the effects of the result: a g-sensitivity
that it lacks turns them, by degrees for a good gyro. Here the horizontal component of the earth's
rate is fitted to what the result leaves of the readings at rest; its size is that of the site
where they determine the azimuth, see `inertial/estimation/horizontal_earth_rate.py`.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.rate_segments import position_of
from inertial.campaign.static_positions import StaticPosition
from inertial.estimation.gyroscope_equations import horizontal_axes, horizontal_names
from inertial.estimation.horizontal_earth_rate import MAX_AZIMUTH_SIGMA
from inertial.physics.motion import Motion, cross, turned

Array = NDArray[np.float64]
Residuals = Callable[[Sequence[Motion]], Sequence[Array]]

PRIOR_INFORMATION = 2.0  # of each component: its variance is half the square of the known size
ITERATIONS = 4  # linearisations of the known size about the last azimuth


def with_azimuths(
    data: CampaignData,
    positions: Sequence[StaticPosition],
    motions: Sequence[Motion],
    matrix: Array,
    residuals_at: Residuals,
) -> list[Motion]:
    """The motions with the azimuths that fit the gyros.

    `matrix`: M of the gyros, (3, 3); `residuals_at`: the gyros at rest less those predicted for
    these motions, (k, 3) for each, rad/s.
    """
    places: dict[str, list[int]] = {}
    found = list(motions)
    for number, position in enumerate(positions):
        if names := horizontal_names(position_of(position.manoeuvre, data.heading)):
            places.setdefault(names[0][1], []).append(number)
            found[number] = replace(motions[number], north=np.zeros_like(motions[number].north))
    left = residuals_at(found)
    level = data.result.site.earth_level
    for numbers in places.values():
        axes = {n: _horizontal_axes(positions[n], data.heading) for n in numbers}
        size = _horizontal([(positions[n], axes[n], left[n]) for n in numbers], level * matrix)
        for n in numbers:
            found[n] = replace(found[n], north=found[n].north + axes[n] @ size)
    return found


def _horizontal_axes(position: StaticPosition, heading: float | None) -> Array:
    """Those of the set position as the table now stands, (3, 2), in body axes."""
    first = horizontal_axes(position_of(position.manoeuvre, heading))[0]
    first = turned(first, position.about, position.angle)
    return np.column_stack([first, cross(position.up_now, first)])


def _horizontal(rests: Sequence[tuple[StaticPosition, Array, Array]], gain: Array) -> Array:
    """The horizontal earth rate along both axes, (2,), relative to its known size.

    `rests`: with the axes, (3, 2), and the residuals; `gain`: of M and the known size, rad/s.
    """
    information, right = np.zeros((2, 2)), np.zeros(2)
    for position, axes, left in rests:
        columns = gain @ axes
        each = np.where(np.isfinite(left), position.seconds[:, None], 0) / position.density**2
        weights = np.nan_to_num(each)
        information = information + (columns.T * weights.sum(axis=0)) @ columns
        right = right + columns.T @ (weights * np.nan_to_num(left)).sum(axis=0)
    if not information.any():  # at a pole, or without readings
        return np.zeros(2)
    prior = PRIOR_INFORMATION * np.eye(2)
    found: Array = np.asarray(np.linalg.solve(information + prior, right), np.float64)
    for _ in range(ITERATIONS):
        along = found / float(np.linalg.norm(found))
        across = np.array([-along[1], along[0]])
        determined = float(across @ information @ across)
        if determined < MAX_AZIMUTH_SIGMA**-2:
            return found
        step = float(across @ (right - information @ along)) / determined
        found = along + step * across
    return found / float(np.linalg.norm(found))

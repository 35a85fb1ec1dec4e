"""A scale factor that changed between campaigns by more than the others: one drifted calibration.

`common_scale` has one variance for the changes of all IMUs and axes. A single axis of a single
IMU that drifted feeds it, and hides a table's error that all the others show. Beside free tables
and IMUs, and given the variance θ of the changes, the drop D of chi-squared without one value is
chi-squared of one degree, whatever the tables' errors are. Its chance is averaged over the θ that
the others leave possible: where only changes scatter this is the externally studentised residual
(Cook & Weisberg 1982).

Several may hide each other: the most outlying are taken out one by one, up to a share of all, and
as many are outliers as the last that is significant among those still there (Rosner 1983,
Technometrics 25, 165). They are no part of what the tables are compared by.
"""

from dataclasses import dataclass

import numpy as np

from inertial.arrays import Booleans
from inertial.estimation.probability import chi2_sf
from inertial.model_selection.common_scale import (
    CHANGES,
    MIN_DEGREES,
    Comparison,
    Residuals,
    chances_of_changes,
    comparisons,
)

MAX_SHARE = 0.25  # of the changes, that may be outliers
MOST = 10  # outliers that are sought


@dataclass(frozen=True)
class OutlyingChange:
    """A scale factor that is off in one campaign.

    `others`: campaigns of the same IMU that show the axis: of a single one nothing tells which of
    the two is off; `size`: as a share, with `sigma`; `p_value`: of any value of the search.
    """

    imu: str
    campaign: str
    others: tuple[str, ...]
    axis: int
    size: float
    sigma: float
    p_value: float


def without_outlying(compared: Comparison, level: float) -> tuple[Comparison, list[OutlyingChange]]:
    """The comparison by all others, and the outliers; `level`: accepted chance of any false one."""
    most = min(int(MAX_SHARE * compared.degrees), MOST)
    kept, there = compared, [compared]
    found: list[OutlyingChange] = []
    while len(found) < most and kept.degrees > MIN_DEGREES:
        one, campaign = _clearest(kept)
        left = list(comparisons(kept.of.without(campaign, one.axis)))
        if len(left) != 1 or set(left[0].tables) != set(compared.tables):
            break
        kept = left[0]
        found.append(one)
        there.append(kept)
    count = max((n for n, one in enumerate(found, 1) if one.p_value <= level), default=0)
    return there[count], found[:count]


def _clearest(compared: Comparison) -> tuple[OutlyingChange, int]:
    """The most outlying value, and the number of its campaign."""
    _, tried = compared.possible
    every = [
        compared.residuals(compared.scale * change, sums)
        for change, sums in zip(CHANGES, tried, strict=True)
    ]
    drops = np.array([one.drops for one in every])
    squares = np.array([one.square for one in every])
    weights = chances_of_changes(squares[:, None, None] - drops, compared.degrees - 1)
    chances = np.sum(weights * chi2_sf(drops, 1), axis=0)
    chances = np.where(tested := _tested(compared, every[0]), chances, np.inf)
    row, axis = divmod(int(np.argmin(chances)), chances.shape[1])
    own = weights[:, row, axis]
    shifts = np.array([one.shifts[row, axis] for one in every])
    sigmas = np.array([one.sigmas[row, axis] for one in every])
    return (
        OutlyingChange(
            compared.of.imus[row],
            compared.of.campaigns[row],
            tuple(compared.of.campaigns[i] for i in _alike(compared, row, axis) if i != row),
            axis,
            float(own @ shifts),
            float(np.sqrt(own @ sigmas**2)),
            min(float(chances[row, axis]) * int(tested.sum()), 1.0),
        ),
        row,
    )


def _tested(compared: Comparison, residuals: Residuals) -> Booleans:
    """Which values (c, 3) are; of two of an axis either tells the same, and the later is."""
    tested = np.isfinite(residuals.sigmas)
    imus = np.unique(compared.of.imus, return_inverse=True)[1]
    for axis in range(tested.shape[1]):
        shown = np.flatnonzero(np.isfinite(compared.of.values[:, axis]))
        _, first, count = np.unique(imus[shown], return_index=True, return_counts=True)
        tested[shown[first[count == 2]], axis] = False
    return tested


def _alike(compared: Comparison, row: int, axis: int) -> list[int]:
    """The campaigns of the same IMU that show the axis."""
    shown = np.isfinite(compared.of.values[:, axis])
    imu = compared.of.imus[row]
    return [i for i, one in enumerate(compared.of.imus) if one == imu and shown[i]]

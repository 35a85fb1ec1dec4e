"""Two straight lines that meet in a knee, fitted to readings against one quantity.

    reading = c + below · min(x − knee, 0) + above · max(x − knee, 0) + noise

It has four unknowns, as many as a cubic, so the two are compared by what they leave.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.inference.tails import ratio_bound

Array = NDArray[np.float64]

BESIDE = 3  # readings on either side of a knee, at least
PLACES = 500  # that are tried
UNKNOWNS = 4
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Knee:
    """The likeliest knee.

    `between`: where it is with 95 % confidence; `slopes`, `sigmas`: below and above, wherever in
    reach the knee is; `left`: what the lines leave, root of the mean square per freedom, which
    counts as noise.
    """

    at: float
    between: tuple[float, float]
    slopes: tuple[float, float]
    sigmas: tuple[float, float]
    left: float

    @property
    def sigma(self) -> float:
        """Of its place, as wide as the interval."""
        return (self.between[1] - self.between[0]) / (2 * 1.96)


def knee_of(at: Array, readings: Array) -> Knee | None:
    """The knee of readings, (n,), that ascend in `at`; None where they are too few for one."""
    if len(at) <= max(2 * BESIDE, UNKNOWNS) or not at[BESIDE - 1] < at[-BESIDE]:
        return None
    places = np.linspace(at[BESIDE - 1], at[-BESIDE], PLACES)
    squares = np.array([_fit(_lines(at, place), readings)[1] for place in places])
    best = int(np.argmin(squares))
    freedom = len(at) - UNKNOWNS
    variance = squares[best] / freedom
    bar = squares[best] + variance * ratio_bound(1 - CONFIDENCE, 1, freedom)
    inside = places[squares <= bar]
    knee = float(places[best])
    lines = _lines(at, knee)
    values, _ = _fit(lines, readings)
    # A knee that moves takes the line that it leaves with it.
    moved = -np.where(at < knee, values[1], values[2])
    columns = np.column_stack([lines, moved])
    covariance = variance * np.linalg.pinv(columns.T @ columns)
    below, above = np.sqrt(np.diag(covariance))[1:3].tolist()
    return Knee(
        knee,
        (float(inside[0]), float(inside[-1])),
        (float(values[1]), float(values[2])),
        (below, above),
        float(np.sqrt(variance)),
    )


def _lines(at: Array, knee: float) -> Array:
    away = at - knee
    return np.column_stack([np.ones(len(at)), np.minimum(away, 0.0), np.maximum(away, 0.0)])


def _fit(columns: Array, readings: Array) -> tuple[Array, float]:
    """Least squares, and the sum of the squares that are left."""
    values: Array = np.linalg.lstsq(columns, readings, rcond=None)[0].astype(np.float64)
    rest = readings - columns @ values
    return values, float(rest @ rest)

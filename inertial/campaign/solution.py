"""The joint result of one mount as the forward model takes it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.records import Known, Manoeuvre, rows_of
from inertial.estimation.gyroscopes import Position
from inertial.estimation.triad import BIAS, linear_names
from inertial.physics.forward import Site, Triad
from inertial.physics.motion import level_axes
from inertial.physics.vectors import cross
from inertial.tables import AXES

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Solution:
    """M and bias of both triads, the site, and what was found of each position.

    A triad that is not wholly determined is None. `walks`: random walks of the biases of gyros and
    accelerometers, rad/s/√s and m/s²/√s.
    """

    gyro: Triad | None
    accelerometer: Triad | None
    site: Site
    found: Mapping[tuple[str, str], float]  # position and quantity → value, rad or rad/s
    walks: tuple[float, float] = (0.0, 0.0)

    def upright(self, m: Manoeuvre) -> Array:
        """The direction that points up at the start of a manoeuvre, its tilt included, (3,)."""
        assert m.up is not None  # a manoeuvre without it is not simulated
        lean = np.zeros(3)
        for i, axis in enumerate(level_axes(m.up)):
            lean = lean + self.found.get((m.position, f"tilt {i}"), 0.0) * axis
        return np.asarray(m.up + cross(lean, m.up))

    def north(self, position: Position) -> Array:
        """The direction of the level earth rate in body axes, times its size over the known one.

        NaN where neither mark and heading nor the gyros tell the azimuth.
        """
        if position.north is not None:
            return position.north
        axes, name = level_axes(position.up), position.name
        if position.mark is not None:
            axes, name = (position.mark, cross(position.up, position.mark)), "the table"
        parts = [self.found.get((name, f"level {i}"), np.nan) for i in (0, 1)]
        return np.asarray((parts[0] * axes[0] + parts[1] * axes[1]) / self.site.earth_level)


def solution_of(
    parameters: tuple[pd.DataFrame, pd.DataFrame],
    positions: tuple[pd.DataFrame, pd.DataFrame],
    known: Mapping[str, Known],
    suffix: str,
    fits: tuple[pd.DataFrame, pd.DataFrame] | None = None,
) -> Solution:
    """The joint result of the mount `suffix`; tables of accelerometer and gyroscope, in this order.

    The azimuth of a position counts as found where its level earth rate is known to a third.
    """
    method = f"joint{suffix}"
    level = known["earth_rate_level"].number
    found = {
        (row["position"], row["quantity"]): row["value"]
        for table in positions
        for row in rows_of(table)
        if row["method"] == method
        and (row["quantity"].startswith("tilt") == (table is positions[0]))
        and (row["quantity"].startswith("tilt") or row["sigma"] < level / 3)
    }
    site = Site(known["gravity"].number, known["earth_rate_up"].number, level)
    gyro, accelerometer = (triad_of(table, method) for table in reversed(parameters))
    walks = [_walk_of(fit, method) for fit in reversed(fits)] if fits else [0.0, 0.0]
    return Solution(gyro, accelerometer, site, found, (walks[0], walks[1]))


def _walk_of(fit: pd.DataFrame, method: str) -> float:
    """The random walk of the bias by a method."""
    walks = [row["random_walk"] for row in rows_of(fit) if row["method"] == method]
    return float(walks[0] or 0.0) if walks else 0.0


def triad_of(parameters: pd.DataFrame, method: str) -> Triad | None:
    """M and bias by a method; none where they are not wholly determined."""
    values = {r["parameter"]: r["value"] for r in rows_of(parameters) if r["method"] == method}
    names = linear_names()
    if any(values.get(name) is None for name in names):
        return None
    errors = np.array([values[name] for name in names[:-3]], dtype=np.float64).reshape(3, 3)
    bias = np.array([values[name] for name in BIAS], dtype=np.float64)
    assert len(bias) == len(AXES)
    return Triad(np.eye(3) + errors, bias)

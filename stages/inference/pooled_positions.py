"""The accelerometers by S3: stops at the same attitude count as one position.

    N_a = M A,   M̂ = N_a Aᵀ (A Aᵀ)⁻¹

The stop that the forward turn reaches and the stop that the backward turn reaches are averaged
first, whatever their length, which lessens the table's position error by √2 where the two are
independent. A holds (g u, 1) of each attitude, as in S0.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stages.inference.linear_formula import Readings, Solution
from stages.inference.six_position import Rest
from stages.inference.spanned import spanned
from stages.model.motion import level_axes
from stages.model.vectors import cross

Array = NDArray[np.float64]


def pooling(ups: Array) -> tuple[Array, Array]:
    """Which rests stand at the same attitude.

    Parameters
    ----------
    ups : (n, 3), upward directions in body axes

    Returns
    -------
    attitudes (m, 3), and the shares of the rests in their means (m, n)
    """
    attitudes, number = np.unique(np.round(ups, 9) + 0.0, axis=0, return_inverse=True)
    members = number.ravel()[None, :] == np.arange(len(attitudes))[:, None]
    return attitudes, members / members.sum(axis=1, keepdims=True)


def pooled_positions(
    rests: Sequence[Rest],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    scatter: float = 0.0,
) -> Solution | None:
    """M and bias, m/s², with their covariance; None where the attitudes do not span them.

    Rests of one `position` share its tilt. `scatter`, m/s², is by what readings differ from rest
    to rest beyond that.
    """
    if not rests:
        return None
    ups = np.array([rest.up for rest in rests])
    attitudes, shares = pooling(ups)
    span = spanned(np.column_stack([gravity * attitudes, np.ones(len(attitudes))]))
    means = np.array([rest.mean for rest in rests])
    if not span.determined.all() or not np.isfinite(means).all():
        return None
    weights = np.broadcast_to(span.inverse @ shares, (3, 4, len(rests)))
    matrix = np.einsum("kj,jr->rk", weights[0], means)[:, :3]
    readings = Readings(means, np.hypot(np.array([rest.sigma for rest in rests]), scatter))
    for j, rest in enumerate(rests):
        readings.suffer("gravity", "", j, matrix @ rest.up * gravity_sigma)
        for i, axis in enumerate(level_axes(rest.up)):
            lean = gravity * cross(axis, rest.up) * position_sigma
            readings.suffer(f"tilt {i}", rest.position, j, matrix @ lean)
    return readings.solution(weights, np.ones((3, 4), dtype=np.bool_))

"""The accelerometers from rests: weighted least squares, and the six-position formula of S0.

    mean reading = M · (g u + δ × g u) + bias + noise

u is the direction that points up, in body axes; δ the tilt of the position, two
unknowns with the sigma of the table; g one unknown with the sigma of gravity.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from stages.inference.least_squares import Estimate, System
from stages.inference.triad import UNKNOWNS
from stages.model.motion import level_axes

Array = NDArray[np.float64]

# Vague priors: M within 1 of the unit matrix, the bias within 10 m/s².
PRIOR = np.append(np.eye(3).ravel(), np.zeros(3))
PRIOR_SIGMA = np.append(np.ones(9), np.full(3, 10.0))


@dataclass(frozen=True)
class Rest:
    """One stretch at an attitude: mean readings, m/s², NaN where not recorded, and their sigma.

    `traces`: how the means change per unit of the parameters of effects.
    """

    position: str
    up: Array  # (3,)
    mean: Array  # (3,)
    sigma: Array  # (3,)
    traces: Mapping[str, Array] = field(default_factory=dict)  # effect parameter → (3,) per unit


def weighted(
    rests: Sequence[Rest],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    scatter: float = 0.0,
) -> Estimate:
    """The twelve parameters of smallest variance from any number of rests.

    `scatter`, m/s², is by what the readings differ from rest to rest beyond noise and tilt.
    """
    matrix = np.eye(3)
    for _ in range(3):  # M stands before the tilts and gravity, so their columns are made anew
        system = equations(rests, gravity, gravity_sigma, position_sigma, scatter, matrix)
        estimate = system.solve()
        matrix = estimate.values[:9].reshape(3, 3)
    return estimate


def equations(
    rests: Sequence[Rest],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    scatter: float,
    matrix: Array,
    wide: Mapping[str, float] | None = None,
) -> System:
    """The equations of all rests, linear about M = `matrix`.

    Unknowns: M by rows, bias, gravity, the tilts, and the effects in `wide` with their sigmas.
    """
    positions = list(dict.fromkeys(rest.position for rest in rests))
    effects = list(wide or {})
    names = [("parameter", str(i)) for i in range(UNKNOWNS)] + [("gravity", "")]
    names += [(f"tilt {i}", position) for position in positions for i in (0, 1)]
    names += [("effect", name) for name in effects]
    tilts = np.full(2 * len(positions), position_sigma)
    prior = np.concatenate([PRIOR, [gravity], np.zeros(len(names) - UNKNOWNS - 1)])
    widths = np.array(list((wide or {}).values()))
    prior_sigma = np.concatenate([PRIOR_SIGMA, [gravity_sigma], tilts, widths])

    ups = np.array([rest.up for rest in rests])
    means = np.array([rest.mean for rest in rests])
    design = np.zeros((len(rests), 3, len(names)))
    along = ups @ matrix.T
    for row in range(3):
        design[:, row, 3 * row : 3 * row + 3] = gravity * ups
        design[:, row, 9 + row] = 1.0
    design[:, :, UNKNOWNS] = along
    level = np.array([level_axes(up) for up in ups])  # (n, 2, 3)
    place = UNKNOWNS + 1 + 2 * np.array([positions.index(rest.position) for rest in rests])
    for axis in (0, 1):
        lean = np.cross(level[:, axis], gravity * ups) @ matrix.T
        design[np.arange(len(rests)), :, place + axis] = lean
    for column, name in enumerate(effects, len(names) - len(effects)):
        traces = [rest.traces.get(name, np.zeros(3)) for rest in rests]
        design[:, :, column] = np.array(traces)
    observed = (means + gravity * along).ravel()
    sigma = np.hypot(np.array([rest.sigma for rest in rests]).ravel(), scatter)
    there = np.isfinite(observed) & np.isfinite(sigma)
    rows = design.reshape(-1, len(names))[there]
    return System(rows, observed[there], sigma[there], prior, prior_sigma, UNKNOWNS, tuple(names))


def formula(
    rests: Sequence[Rest],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    scatter: float = 0.0,
) -> tuple[Array, Array] | None:
    """M̂ = L Aᵀ (A Aᵀ)⁻¹ as S0 (3-6) has it, all rests alike, with the covariance it has.

    L holds the means, A = [g u; 1]. None where the rests do not span the four columns.

    Returns
    -------
    the twelve unknowns (M by rows, bias) and their covariance
    """
    truth = np.vstack([np.column_stack([gravity * r.up for r in rests]), np.ones(len(rests))])
    means = np.column_stack([rest.mean for rest in rests])
    if np.linalg.matrix_rank(truth) < 4 or not np.isfinite(means).all():
        return None
    inverse = truth.T @ np.linalg.inv(truth @ truth.T)  # (n, 4)
    solution = means @ inverse  # (3, 4)
    # The solution is linear in the means, channel by channel; the tilts and gravity join them.
    spread = np.zeros((3 * len(rests), 3 * len(rests)))
    shared = np.zeros(3 * len(rests))
    for i, rest in enumerate(rests):
        rows = slice(3 * i, 3 * i + 3)
        spread[rows, rows] += np.diag(rest.sigma**2 + scatter**2)
        shared[rows] = rest.up
        for j, other in enumerate(rests):
            if rest.position == other.position:
                level = np.eye(3) - np.outer(rest.up, other.up)
                spread[rows, 3 * j : 3 * j + 3] += (position_sigma * gravity) ** 2 * level
    spread += gravity_sigma**2 * np.outer(shared, shared)
    weights = np.vstack(
        [np.kron(inverse[:, k], np.eye(3)[row]) for row in range(3) for k in range(3)]
        + [np.kron(inverse[:, 3], np.eye(3)[row]) for row in range(3)]
    )
    unknowns = np.append(solution[:, :3].ravel(), solution[:, 3])
    return unknowns, weights @ spread @ weights.T

"""The equations of one channel: its row of M, its bias, the effects, and the errors."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from inertial.estimation.least_squares import System
from stages.extension.channels import Mean

Array = NDArray[np.float64]

UNKNOWNS = 4  # of a channel: three of M and the bias
VAGUE = (0.1, 0.1, 0.1, 1.0)  # their sigmas beforehand, about the joint result


def system_of(
    means: Sequence[Mean], names: Sequence[str], channel: int, shown: Sequence[str], walk: float
) -> System | None:
    """The equations of one channel; None where it has no reading.

    `names`: of all traces, of which the effects `shown` are unknowns; `walk`: of the bias, per √s.
    """
    some = [m for m in means if np.isfinite(m.residual[channel]) and np.isfinite(m.sigma[channel])]
    if not some:
        return None
    sigma = np.array([mean.sigma[channel] for mean in some])
    kept = [names.index(name) for name in shown]
    own = np.array([np.append(mean.truth, 1.0) for mean in some])
    of_effects = np.array([mean.traces[channel, kept] for mean in some])
    errors = {key: size for mean in some for key, (_, size) in mean.errors.items()}
    columns = {key: np.zeros(len(some)) for key in errors}
    for row, mean in enumerate(some):
        for key, (change, _) in mean.errors.items():
            columns[key][row] = change[channel]
    design = np.hstack([own, of_effects, *(column[:, None] for column in columns.values())])
    unknowns = [("parameter", str(i)) for i in range(UNKNOWNS)]
    unknowns += [*(("effect", name) for name in shown), *columns]
    observed = np.array([mean.residual[channel] for mean in some])
    rows = np.column_stack([design, observed]) / sigma[:, None]
    if walk:  # from one stretch to the next, in units of the noise
        walked = walk**2 * _walked(some) / np.outer(sigma, sigma)
        lower = np.linalg.cholesky(np.eye(len(some)) + walked)
        rows = solve_triangular(lower, rows, lower=True)
    return System(
        rows[:, :-1],
        rows[:, -1],
        np.ones(len(some)),
        np.zeros(len(unknowns)),
        np.array([*VAGUE, *np.ones(len(shown)), *errors.values()]),
        UNKNOWNS,
        tuple(unknowns),
    )


def _walked(means: Sequence[Mean]) -> Array:
    """How long two stretches have walked together since the first one, s, (n, n)."""
    time = np.array([mean.time for mean in means])
    since = np.nan_to_num(time - np.nanmin([*time, np.inf]))
    return np.asarray(np.minimum.outer(since, since))

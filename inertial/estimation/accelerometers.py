"""The accelerometers from rests: weighted least squares, and the six-position formula of S0.

    mean reading = M · (g u + δ × g u) + bias + noise

u is the direction that points up, in body axes; δ the tilt of the position, two
unknowns with the sigma of the table; g one unknown with the sigma of gravity.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.elimination import EquationBlock, Name, compressed, eliminate
from inertial.estimation.gyroscope_rows import whitened
from inertial.estimation.least_squares import Estimate, System
from inertial.estimation.random_walk import Stretch, linear_trend, with_drifts
from inertial.estimation.sensitivities import NONE, Traces
from inertial.estimation.triad import UNKNOWNS
from inertial.estimation.variance_components import ScatterFit, walk_search, with_random_walk
from inertial.physics.motion import all_level_axes
from inertial.physics.vectors import cross

Array = NDArray[np.float64]

# Vague priors: M within 1 of the unit matrix, the bias within 10 m/s².
PRIOR = np.append(np.eye(3).ravel(), np.zeros(3))
PRIOR_SIGMA = np.append(np.ones(9), np.full(3, 10.0))
BIAS = 9  # where the three biases stand
WALK = 2e-3  # m/s²/√s, 10 mg/√h: a hundred times that of the poorest sensors
SCATTER = (1e-7, 1.0)  # m/s²: how much rests may differ beyond the noise


@dataclass(frozen=True)
class Rest:
    """One stretch at an attitude: mean readings, m/s², NaN where not recorded, and their sigma.

    `traces`: how the means change per unit of the parameters of effects; `stretch`: of time.
    """

    position: str
    up: Array  # (3,)
    mean: Array  # (3,)
    sigma: Array  # (3,)
    traces: Traces = NONE
    stretch: Stretch | None = None


def weighted(
    rests: Sequence[Rest],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    scatter: float = 0.0,
    walk: float = 0.0,
    wide: Mapping[str, float] | None = None,
) -> Estimate:
    """The twelve parameters of smallest variance from any number of rests.

    `scatter`, m/s², is by what the readings differ from rest to rest beyond noise and tilt; `walk`,
    m/s²/√s, by what the bias walks from one to the next, see `random_walk`; `wide`: sigmas of
    further unknowns, whose traces the rests have.
    """
    given = (gravity, gravity_sigma, position_sigma)
    matrix = np.eye(3)
    for _ in range(3):  # M stands before the tilts and gravity, so their columns are made anew
        estimate = equations(rests, *given, scatter, matrix, wide, walk).solve()
        matrix = estimate.values[:9].reshape(3, 3)
    return estimate


def fitted(
    rests: Sequence[Rest],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    noise_degrees: float = np.inf,
    wide: Mapping[str, float] | None = None,
) -> ScatterFit:
    """The estimate with that scatter and that random walk which the data ask for."""
    given = (gravity, gravity_sigma, position_sigma)
    estimate = weighted(rests, *given, wide=wide)
    matrix = estimate.values[:9].reshape(3, 3)

    def fit(scatter: float, walk: float) -> Estimate:
        return equations(rests, *given, scatter, matrix, wide, walk).solve_shared()

    def between(groups: Sequence[Stretch]) -> Callable[[float], float]:
        some = [replace(r, stretch=s) for r, s in zip(rests, groups, strict=True)]
        return lambda size: (
            equations(some, *given, size, matrix, wide, grouped=True).solve_shared().deviance
        )

    stretches = [rest.stretch for rest in rests if rest.stretch is not None]
    rivals = [
        between([Stretch(rest.position) for rest in rests]),
        between([Stretch(str(np.round(rest.up, 3))) for rest in rests]),
    ]
    if stretches:
        straight = linear_trend(stretches)
        rivals.append(between([straight(rest.stretch or Stretch("")) for rest in rests]))
    noise = float(np.nanmedian([*(rest.sigma for rest in rests), np.full(3, np.nan)]))
    found = with_random_walk(
        fit, SCATTER, walk_search(stretches, noise, WALK), rivals, noise_degrees
    )
    if found.scatter or found.random_walk:
        estimate = weighted(rests, *given, found.scatter, found.random_walk, wide)
    return replace(found, estimate=estimate)


def equations(
    rests: Sequence[Rest],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    scatter: float,
    matrix: Array,
    wide: Mapping[str, float] | None = None,
    walk: float = 0.0,
    *,
    grouped: bool = False,
) -> System:
    """The equations of all rests, linear about M = `matrix`; `scatter`, `walk` as in `weighted`.

    `grouped`: rests of one stretch have one scatter together.
    Unknowns: M by rows, bias, gravity, the effects in `wide` with their sigmas; apart: the tilts.
    """
    wide = wide or {}
    names = [("parameter", str(i)) for i in range(UNKNOWNS)] + [("gravity", "")]
    names += [("effect", name) for name in wide]
    prior = np.concatenate([PRIOR, [gravity], np.zeros(len(wide))])
    rows = _rows(rests, gravity, matrix, prior, list(wide))
    noise = np.array([rest.sigma for rest in rests])
    drifts = grouped or bool(walk)  # else the scatter is that of each rest by itself
    noise = noise if drifts else np.hypot(noise, scatter)
    together: dict[tuple[str, Stretch | None], list[int]] = {}
    for i, rest in enumerate(rests):
        together.setdefault((rest.position, rest.stretch if drifts else None), []).append(i)
    parts: list[tuple[EquationBlock, Stretch]] = []
    sigma: dict[Name, float] = {}
    for number, ((position, stretch), some) in enumerate(together.items()):
        tilts = tuple((f"tilt {axis}", position) for axis in (0, 1))
        sigma |= dict.fromkeys(tilts, position_sigma)
        part = whitened(rows[some].reshape(-1, rows.shape[-1]), noise[some].ravel(), tilts)
        part = replace(part, rows=compressed(part.rows))
        parts.append((part, stretch or Stretch(f"rest {number}")))
    every, of_drifts = with_drifts(parts, len(prior), BIAS, scatter if drifts else 0.0, walk)
    left, eliminated = eliminate(every, len(prior), sigma | of_drifts)
    return System(
        left[:, :-1],
        left[:, -1] + left[:, :-1] @ prior,
        np.ones(len(left)),
        prior,
        np.array([*PRIOR_SIGMA, gravity_sigma, *wide.values()]),
        UNKNOWNS,
        tuple(names),
        eliminated,
    )


def _rows(
    rests: Sequence[Rest], gravity: float, matrix: Array, prior: Array, effects: Sequence[str]
) -> Array:
    """Coefficients of the shared unknowns and of two tilts, and the observed, (n, 3, s + 3)."""
    s = len(prior)
    ups = np.array([rest.up for rest in rests])
    along = ups @ matrix.T
    rows = np.zeros((len(rests), 3, s + 3))
    for row in range(3):
        rows[:, row, 3 * row : 3 * row + 3] = gravity * ups
        rows[:, row, 9 + row] = 1.0
    rows[:, :, UNKNOWNS] = along
    rows[:, :, UNKNOWNS + 1 : s] = [rest.traces.of(effects) for rest in rests]
    level = all_level_axes(ups)
    for axis in (0, 1):
        rows[:, :, s + axis] = cross(level[:, axis], gravity * ups) @ matrix.T
    rows[:, :, -1] = np.array([rest.mean for rest in rests]) + gravity * along
    rows[:, :, -1] -= rows[:, :, :s] @ prior
    return rows


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
    # The solution is linear in the means, channel by channel: weights (12, n, 3).
    weights = np.concatenate(
        [np.einsum("nk,rc->rknc", inverse[:, :3], np.eye(3)).reshape(9, len(rests), 3),
         np.einsum("n,rc->rnc", inverse[:, 3], np.eye(3))]
    )  # fmt: skip
    noise = np.array([rest.sigma for rest in rests]) ** 2 + scatter**2
    spread = np.einsum("anc,nc,bnc->ab", weights, noise, weights)
    # What a tilt adds is level, the same for all rests at a position; what gravity adds is upward.
    up = np.einsum("anc,nc->an", weights, np.array([rest.up for rest in rests]))
    spread += gravity_sigma**2 * np.outer(up.sum(axis=1), up.sum(axis=1))
    names = np.array([rest.position for rest in rests])
    for position in dict.fromkeys(names):
        every, upward = weights[:, names == position].sum(axis=1), up[:, names == position]
        level = every @ every.T - np.outer(upward.sum(axis=1), upward.sum(axis=1))
        spread += (position_sigma * gravity) ** 2 * level
    unknowns = np.append(solution[:, :3].ravel(), solution[:, 3])
    return unknowns, spread

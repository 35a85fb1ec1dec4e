"""Effects against a scatter that is estimated from the residuals of which they are a part.

Where manoeuvres differ by a scatter of unknown size, the residuals in its units are as large as by
chance whatever an effect adds to them: the scatter grows by it. What counts is which share of them
an effect takes away, so each is tested by F, and the smallest p-value of the whole search against
what chance makes of it, by simulation: Bonferroni's bound would count neighbouring values of a scan
as independent, and with 13 degrees of freedom in all, as of 22 positions, cost half of the power.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular
from scipy.linalg.lapack import dpstrf

from inertial.arrays import Array, Integers
from inertial.estimation.effect_information import MIN_INFORMATION_SHARE, EffectInformation
from inertial.estimation.probability import f_sf
from inertial.model_selection.evidence import SearchedEffect
from inertial.model_selection.null_simulation import DRAWS, share_of_level

MAX_BATCH = 500  # data sets at once, which bound the memory
MIN_LEFT = 1  # degrees of freedom that an effect must leave: else nothing shows the scatter


@dataclass(frozen=True)
class ScatterTests:
    """The F tests of all candidates in the equations of one sensor.

    `degrees`: n, of the residuals; `places`: effect and value of each of c candidates; `used`:
    (c,), degrees of freedom of each; `directions`: (Σ used, ρ), orthonormal, of each candidate in
    turn, in the space of all; `along`: (ρ,), the residuals there; `chi_squared`: of all residuals.
    """

    degrees: int
    places: Sequence[tuple[int, int]]
    used: Integers
    directions: Array
    along: Array
    chi_squared: float

    @cached_property
    def p_values(self) -> Array:
        """Of each candidate by itself, (c,)."""
        drops = self._drops(self.along[:, None])[:, 0]
        return self._p_value(drops, self.chi_squared, self.used)

    def smallest_by_chance(self, random: np.random.Generator) -> Array:
        """The smallest p-value of all candidates where there is a scatter only, (DRAWS,)."""
        counts = [min(MAX_BATCH, DRAWS - i) for i in range(0, DRAWS, MAX_BATCH)]
        return np.concatenate([self._smallest(count, random) for count in counts])

    def _smallest(self, draws: int, random: np.random.Generator) -> Array:
        along = random.standard_normal((len(self.along), draws))
        whole = np.sum(along**2, axis=0)
        if (beyond := self.degrees - len(along)) > 0:  # what no candidate changes
            whole += random.chisquare(beyond, draws)
        drops, smallest = self._drops(along), np.ones(draws)
        for used in np.unique(self.used):  # of equal degrees the largest drop is the least likely
            largest = drops[self.used == used].max(axis=0)
            np.minimum(smallest, self._p_value(largest, whole, used), out=smallest)
        return smallest

    def _drops(self, along: Array) -> Array:
        squares = (self.directions @ along) ** 2
        starts = np.cumsum(self.used) - self.used
        return np.asarray(np.add.reduceat(squares, starts, axis=0))

    def _p_value(self, drop: Array, whole: Array | float, used: Integers | int) -> Array:
        left = self.degrees - used
        rest = np.maximum(whole - drop, np.finfo(float).tiny)
        return f_sf(drop / used / rest * left, used, left)


def scatter_tests(
    sensor: EffectInformation, raw: Array, searched: Sequence[SearchedEffect]
) -> ScatterTests | None:
    """The tests of all candidates that leave residuals; None where there is none.

    `raw`: (k,), information of this sensor on every column before anything else is fitted.
    """
    root, along = residual_columns(sensor, raw)
    places, directions = [], []
    for number, effect in enumerate(searched):
        for value, columns in enumerate(effect.candidates):
            own = _orthonormal(root[list(columns)], raw[list(columns)])
            if effect.free or not len(own) or sensor.degrees - len(own) < MIN_LEFT:
                continue
            places.append((number, value))
            directions.append(own)
    if not places:
        return None
    return ScatterTests(
        sensor.degrees,
        places,
        np.array([len(own) for own in directions]),
        np.concatenate(directions),
        along,
        sensor.chi_squared,
    )


def residual_columns(sensor: EffectInformation, raw: Array) -> tuple[Array, Array]:
    """The columns of all effects, (k, ρ), and the residuals, (ρ,), where they are no priors.

    F = R Rᵀ and b = R y, but for what is known by the vague priors of the parameters alone: there
    are no more directions than degrees of freedom. `raw` as in `scatter_tests`.
    """
    size = np.sqrt(np.where(raw > 0, raw, 1.0))
    scaled = sensor.information / np.outer(size, size)
    lower, order, rank, _info = dpstrf(scaled, tol=MIN_INFORMATION_SHARE, lower=1)
    rank = min(rank, sensor.degrees)
    root = np.zeros((len(size), rank))
    root[order - 1] = np.tril(lower)[:, :rank]
    first = order[:rank] - 1
    along = solve_triangular(root[first], (sensor.right / size)[first], lower=True)
    return root * size[:, None], along


def named_share(tests: Sequence[ScatterTests], level: float) -> float:
    """The p-value that the smallest of all falls below with the probability `level`."""
    random = np.random.default_rng(0)
    smallest = [one.smallest_by_chance(random) for one in tests]
    return share_of_level(np.sort(np.min(smallest, axis=0)), level)


def _orthonormal(rows: Array, raw: Array) -> Array:
    """Orthonormal directions that some rows, (w, ρ), span, of those that are more than rounding."""
    length = np.linalg.norm(rows, axis=1)
    shown = length**2 > MIN_INFORMATION_SHARE * raw
    if not shown.any():
        return np.zeros((0, rows.shape[1]))
    unit = rows[shown] / length[shown, None]
    _left, values, right = np.linalg.svd(unit, full_matrices=False)
    return np.asarray(right[values**2 > MIN_INFORMATION_SHARE])

"""The accelerometers from static positions by weighted least squares.

    mean reading = M · (g u + δ × g u) + bias + noise

u is the upward direction in body axes; δ the tilt of the position, with the sigma of the table; g
one unknown with the sigma of gravity. That is linear in δ, so it is set up about the tilt that the
reading shows, where that may be one of the position: by hand g u (1 − cos δ), and the products of δ
with cross terms, are not small. What else tilts the case is an effect, linear in its angle, and
what the cosine of that takes from g u follows from the reading.
"""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from inertial.arrays import Array
from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.effect_information import NO_SENSITIVITIES, Sensitivities
from inertial.estimation.elimination import (
    AZIMUTH,
    OF_AXIS,
    TILTS,
    EquationBlock,
    Name,
    compressed,
    in_force,
    names_of,
    whitened,
)
from inertial.estimation.least_squares import Estimate, System
from inertial.estimation.random_walk import NO_DRIFT, MeasuredDrift, Stretch
from inertial.estimation.scatter_and_random_walk import ScatterFit, walk_search
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.forward import Triad
from inertial.physics.motion import all_level_axes, cross

# Vague priors: M within 1 of the unit matrix, the bias within 10 m/s².
PRIOR = np.append(np.eye(3).ravel(), np.zeros(3))
PRIOR_SIGMA = np.append(np.ones(9), np.full(3, 10.0))
ITERATIONS = 3  # linearisations about the last result
BIAS = 9  # column of the first of the three biases
MAX_RANDOM_WALK = 2e-3  # m/s²/√s, 10 mg/√h: a hundred times that of the poorest sensors
MAX_SHOWN = 5.0  # sigma of a position that a tilt may be to be its own
MIN_SHOWN = 1e-4  # rad; of a smaller tilt what is not linear is less than 0.005 µg
MIN_BENT = 5e-4  # rad; of a smaller error of M and bias the cosines of tilts are off by 0.1 µg
MIN_SPANNED = 0.05  # rms component along a direction of planned attitudes that have it
FREE_TILT = 0.2  # rad, sigma of the tilt of a position of which nothing is known
OF_ANGLE = "angle"  # the kind of the errors of turns
OF_TUMBLE = "tumble"  # the kind of the tilts that the rests of a tumble share
SCATTER_BOUNDS = (1e-7, 1.0)  # m/s², between static positions beyond the noise


@dataclass(frozen=True)
class StaticForce:
    """Mean readings at rest, m/s², NaN where not recorded, and their sigma.

    `sensitivities`: of the means to the parameters of effects, or with `felt` of the specific force
    that the sensors feel; `stretch`: of time; `turning`: not at rest, the table turns steadily;
    `level`: where it turns, or has turned, the level axes at the start of that, mean in body axes;
    `case`: the same fixed to the case, in a turn about an axis that is not vertical, and
    `turn_errors`: by name an error of the angle of that, in units of its sigma, as a rotation of
    the case, (3,), rad; `tumble_tilts`: by name a direction of a tilt that it shares, (3,).
    """

    position: str
    up: Array  # (3,)
    mean: Array  # (3,)
    sigma: Array  # (3,)
    sensitivities: Sensitivities = NO_SENSITIVITIES
    stretch: Stretch | None = None
    felt: bool = False
    turning: bool = False
    level: Array | None = None  # (2, 3)
    case: Array | None = None  # (2, 3)
    turn_errors: Mapping[str, Array] = field(default_factory=dict)
    tumble_tilts: Mapping[str, Array] = field(default_factory=dict)


class Reference(NamedTuple):
    """What static positions are compared with: gravity, m/s², and the planned attitudes, rad.

    `axis_sigma`: of what tilts with the axis of the table, where it is not that of the positions;
    `free`: positions that are off by so much that they tell nothing of their attitude.
    """

    gravity: float
    gravity_sigma: float
    position_sigma: float
    axis_sigma: float | None = None
    free: frozenset[str] = frozenset()

    def sigma_of(self, errors: Sequence[Name]) -> dict[Name, float]:
        """The sigma of each of these unknowns: tilts, and errors of turns and tumbles."""
        return {(kind, name): self._sigma_of(kind, name) for kind, name in errors}

    def _sigma_of(self, kind: str, name: str) -> float:
        if kind == OF_ANGLE:
            return 1.0
        if kind in OF_AXIS and self.axis_sigma is not None:
            return self.axis_sigma
        free = kind not in (*OF_AXIS, OF_TUMBLE) and name in self.free
        return FREE_TILT if free else self.position_sigma


def weighted(
    statics: Sequence[StaticForce],
    reference: Reference,
    scatter: float = 0.0,
    walk: float = 0.0,
    effect_sigma: Mapping[str, float] | None = None,
    measured: MeasuredDrift = NO_DRIFT,
) -> Estimate:
    """The twelve parameters of smallest variance from any number of static positions.

    `scatter`, m/s²: between static positions, beyond noise and tilt; `walk`, m/s²/√s: random walk
    of the bias, see `random_walk`; both beyond the `measured` drift; `effect_sigma`: of parameters
    of effects, which are unknowns too.
    """
    about = Triad(np.eye(3), np.full(3, np.nan))
    for _ in range(ITERATIONS):  # M multiplies the tilts and gravity
        estimate = equations(
            statics, reference, scatter, about, effect_sigma, walk, measured
        ).solve()
        about = triad_of(estimate)
    return estimate


def fit(
    statics: Sequence[StaticForce],
    reference: Reference,
    noise_degrees: float = np.inf,
    effect_sigma: Mapping[str, float] | None = None,
    measured: MeasuredDrift = NO_DRIFT,
) -> ScatterFit:
    """The estimate with the scatter and random walk of largest restricted likelihood."""
    estimate = weighted(statics, reference, effect_sigma=effect_sigma, measured=measured)
    about = triad_of(estimate)

    def fit_with(scatter: float, walk: float) -> Estimate:
        return equations(
            statics, reference, scatter, about, effect_sigma, walk, measured
        ).solve_shared()

    each = list(range(len(statics)))  # has a block of its own, and so a scatter of its own
    likelihood = _drifting(statics, reference, about, effect_sigma, each, 0.0, measured).likelihood
    if measured.switch_on is None and (switched := likelihood.switch_ons()) is not None:
        then = replace(measured, switch_on=switched.covering)
        result = fit(statics, reference, noise_degrees, effect_sigma, then)
        return replace(result, switch_ons=switched)
    stretches = [static.stretch for static in statics if static.stretch is not None]
    attitudes = [str(np.round(static.up, 3)) for static in statics]
    noise = float(np.nanmedian([*(static.sigma for static in statics), np.full(3, np.nan)]))
    search = walk_search(stretches, noise, MAX_RANDOM_WALK)
    times, bounds = (stretches, search), SCATTER_BOUNDS
    alone = likelihood.of_scatter()
    result = likelihood.fitted(fit_with, alone, attitudes, *times, bounds, noise_degrees)
    if result.scatter or result.random_walk:
        estimate = weighted(
            statics, reference, result.scatter, result.random_walk, effect_sigma, measured
        )
    return replace(result, estimate=estimate)


def equations(
    statics: Sequence[StaticForce],
    reference: Reference,
    scatter: float,
    about: Triad,
    effect_sigma: Mapping[str, float] | None = None,
    walk: float = 0.0,
    measured: MeasuredDrift = NO_DRIFT,
) -> System:
    """All equations; `scatter`, `walk`, `measured` as in `weighted`.

    They are linear `about` M and a bias, which is NaN where it is not known yet.

    Unknowns: M by rows, bias, gravity, effects; eliminated: the tilts.
    """
    known = (reference, about, effect_sigma)
    stretches = [static.stretch for static in statics if static.stretch is not None]
    if (
        walk or measured or measured.differs(stretches)
    ):  # else each static position has a scatter of its own
        drifts = drifting(statics, *known, walking=True, measured=measured)
        return drifts.system(scatter, walk)
    return drifting(statics, *known, scatter, walking=False).system()


def drifting(
    statics: Sequence[StaticForce],
    reference: Reference,
    about: Triad,
    effect_sigma: Mapping[str, float] | None = None,
    scatter: float = 0.0,
    *,
    walking: bool,
    measured: MeasuredDrift = NO_DRIFT,
) -> DriftingEquations:
    """All equations before the errors are eliminated, arguments as in `equations`.

    `walking`: a random walk may be added, so that only what is of one stretch is one block.
    """
    timed = walking or bool(measured)
    keys: list[Hashable] = [(s.position, s.stretch if timed else None) for s in statics]
    return _drifting(statics, reference, about, effect_sigma, keys, scatter, measured)


def _drifting(
    statics: Sequence[StaticForce],
    reference: Reference,
    about: Triad,
    effect_sigma: Mapping[str, float] | None,
    keys: Sequence[Hashable],
    scatter: float,
    measured: MeasuredDrift,
) -> DriftingEquations:
    """The same, to which drifts may be added; `keys`: what has one key is one block."""
    effect_sigma = effect_sigma or {}
    names = [("parameter", str(i)) for i in range(UNKNOWNS)] + [("gravity", "")]
    names += [("effect", name) for name in effect_sigma]
    prior = np.concatenate([PRIOR, [reference.gravity], np.zeros(len(effect_sigma))])
    effects = list(effect_sigma)
    known = (reference.gravity, about, prior, effects)
    rows = linear_rows(statics, *known, reference.position_sigma, reference.free)
    noise = np.hypot([static.sigma for static in statics], scatter)
    same: dict[Hashable, list[int]] = {}
    for i, key in enumerate(keys):
        same.setdefault(key, []).append(i)
    blocks: list[tuple[EquationBlock, Stretch]] = []
    positions: list[str] = []
    sigma: dict[Name, float] = {}
    for number, some in enumerate(same.values()):
        position, stretch = statics[some[0]].position, statics[some[0]].stretch
        tilts = max((tilts_of(statics[i]) for i in some), key=len)
        errors = [shared_errors(statics[i], reference.gravity, about) for i in some]
        shared = tuple(dict.fromkeys(name for each in errors for name in each))
        sigma |= reference.sigma_of((*tilts, *shared))
        columns = len(prior) + len(tilts)
        own = np.zeros((len(some), 3, columns + len(shared) + 1))
        own[:, :, :columns], own[:, :, -1] = rows[some][:, :, :columns], rows[some][:, :, -1]
        for place, name in enumerate(shared, columns):
            own[:, :, place] = [each.get(name, np.zeros(3)) for each in errors]
        block = whitened(own.reshape(-1, own.shape[2]), noise[some].ravel(), (*tilts, *shared))
        block = replace(block, rows=compressed(block.rows))
        blocks.append((block, stretch or Stretch(f"rest {number}")))
        positions.append(position)
    return DriftingEquations(
        blocks,
        positions,
        sigma,
        prior,
        np.array([*PRIOR_SIGMA, reference.gravity_sigma, *effect_sigma.values()]),
        tuple(names),
        BIAS,
        measured=measured,
    )


def linear_rows(
    statics: Sequence[StaticForce],
    gravity: float,
    about: Triad,
    prior: Array,
    effects: Sequence[str],
    position_sigma: float = np.inf,
    free: frozenset[str] = frozenset(),
) -> Array:
    """Coefficients of the s shared unknowns and of five tilts, and the observed, (n, 3, s + 6).

    `position_sigma`: of the planned attitudes, rad, but of those that are `free`.
    """
    s = len(prior)
    ups = np.array([static.up for static in statics])
    since = _since_switch_on(statics, gravity * ups, about, gravity * position_sigma)
    means = np.array([static.mean for static in statics])
    shown = _shown_tilts(statics, ups, about, means - since)
    small = np.linalg.norm(shown, axis=1) <= MAX_SHOWN * position_sigma
    own = small | np.array([static.position in free for static in statics])
    versed = np.where(own, 0.0, 1 - np.cos(np.linalg.norm(shown, axis=1)))
    shown[~own | (np.linalg.norm(shown, axis=1) < MIN_SHOWN)] = 0.0
    forces: Array = gravity * Rotation.from_rotvec(shown).apply(ups)
    of_matrix = gravity * ups + (forces - gravity * ups) @ _spanned(ups)
    tilts = tilt_axes(statics)
    rows = np.zeros((len(statics), 3, s + tilts.shape[1] + 1))
    for row in range(3):
        rows[:, row, 3 * row : 3 * row + 3] = of_matrix
        rows[:, row, 9 + row] = 1.0
    rows[:, :, UNKNOWNS] = forces @ about.matrix.T / gravity
    rows[:, :, UNKNOWNS + 1 : s] = [static.sensitivities.of(effects) for static in statics]
    felt = [static.felt for static in statics]
    rows[felt, :, UNKNOWNS + 1 : s] = about.matrix @ rows[felt, :, UNKNOWNS + 1 : s]
    for i in range(tilts.shape[1]):
        rows[:, :, s + i] = cross(tilts[:, i], forces) @ about.matrix.T
    # M times gravity is in the columns of both, and the tilts are the whole ones.
    changed = of_matrix + forces * versed[:, None] + cross(shown, forces)
    rows[:, :, -1] = means + changed @ about.matrix.T
    rows[:, :, -1] -= rows[:, :, :s] @ prior
    return rows


def shared_errors(static: StaticForce, gravity: float, about: Triad) -> dict[Name, Array]:
    """What errors that it shares with other means change in it, (3,), m/s².

    That of an angle by its sigma, that of a tilt of a tumble per rad. The further the case is
    turned, the other way turns what is up in it.
    """
    force = gravity * static.up
    kinds = ((OF_ANGLE, static.turn_errors), (OF_TUMBLE, static.tumble_tilts))
    return {
        (kind, name): -about.matrix @ cross(rotation, force)
        for kind, errors in kinds
        for name, rotation in errors.items()
    }


def tilts_of(static: StaticForce) -> tuple[Name, ...]:
    """The tilts of its position that a mean may show, the first of those of `tilt_axes`."""
    kinds = TILTS if static.level is None else (*TILTS, *OF_AXIS)
    return names_of([static.position], kinds if static.case is None else (*kinds, *AZIMUTH))


def tilt_axes(statics: Sequence[StaticForce]) -> Array:
    """The directions of the five tilts, (n, 5, 3): of the last three none but in turns."""
    axes = all_level_axes(np.array([static.up for static in statics]))
    case = np.array(
        [own if s.case is None else s.case for own, s in zip(axes, statics, strict=True)]
    )
    level = np.array(
        [own if s.level is None else s.level for own, s in zip(case, statics, strict=True)]
    )
    azimuth = cross(case[:, 0], case[:, 1])
    return np.concatenate([in_force(case, level), azimuth[:, None]], axis=1)


def _since_switch_on(
    statics: Sequence[StaticForce], forces: Array, about: Triad, tilted: float
) -> Array:
    """What the readings since a switch-on differ by from those of all, (n, 3), m/s².

    Without it a bias would pass for a tilt of all positions. `forces`: by the planned attitudes,
    (n, 3); `tilted`: sigma of what a tilt adds across them, m/s².
    """
    parts = np.array([s.stretch.switch_on if s.stretch is not None else 0 for s in statics])
    left = np.array([static.mean for static in statics]) - about.bias - forces @ about.matrix.T
    since = np.zeros_like(forces)
    if len(set(parts)) == 1 or not np.isfinite(left).all():
        return since
    noise = np.array([static.sigma for static in statics]) ** 2
    at_rest = np.array([not static.turning for static in statics])
    along = np.einsum("ni,nj->nij", forces, forces)
    along /= np.sum(forces**2, axis=1)[:, None, None]
    across = np.eye(3) - along
    mean = np.mean(noise, axis=1)[:, None, None]
    weights = along / mean + across / (mean + tilted**2)
    for part in set(parts):
        own = (parts == part) & (at_rest | ~np.any(at_rest & (parts == part)))
        right = np.einsum("nij,nj->i", weights[own], left[own])
        since[parts == part] = np.linalg.pinv(weights[own].sum(axis=0), hermitian=True) @ right
    return since


def _shown_tilts(statics: Sequence[StaticForce], ups: Array, about: Triad, means: Array) -> Array:
    """The tilts, as rotations from the planned upward directions to those of the `means`, (n, 3).

    0 where they cannot be told yet. While the table turns, the pull at the lever arm would pass for
    a tilt, which is that of the rests in the same position.
    """
    seen = (means - about.bias) @ np.linalg.inv(about.matrix).T
    across = cross(ups, seen)
    sine, cosine = np.linalg.norm(across, axis=1), np.sum(ups * seen, axis=1)
    with np.errstate(invalid="ignore"):
        tilts = np.nan_to_num(across * (np.arctan2(sine, cosine) / sine)[:, None])
    at_rest: dict[str, list[Array]] = {}
    for static, own in zip(statics, tilts, strict=True):
        if not static.turning:
            at_rest.setdefault(static.position, []).append(own)
    for i, static in enumerate(statics):
        if static.turning:
            tilts[i] = np.mean(at_rest.get(static.position, [np.zeros(3)]), axis=0)
    return np.asarray(tilts)


def _spanned(ups: Array) -> Array:
    """The projection, (3, 3), onto the directions that planned attitudes have, (n, 3).

    Along any other direction a sensor feels nothing but tilts, which are those that its own
    reading shows by whatever scale factor: they determine none.
    """
    values, vectors = np.linalg.eigh(ups.T @ ups / len(ups))
    spanned = vectors[:, values > MIN_SPANNED**2]
    return np.asarray(spanned @ spanned.T)


def triad_of(estimate: Estimate) -> Triad:
    """M and bias of an estimate."""
    return Triad(estimate.values[:9].reshape(3, 3), estimate.values[9:12])

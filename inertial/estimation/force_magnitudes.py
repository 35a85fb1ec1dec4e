"""The accelerometers in positions of unknown attitude: |f| = g, one linear equation for each.

    |P⁻¹ (reading − bias)| − g = 0

about P and the upward direction v that the readings give. The row n = P⁻ᵀ v of the three readings
is the only combination that no small rotation of the position changes, and it changes by n · δ for
an error δ of the readings, whatever its cause: noise, a bias, an effect (Tedaldi, Pretto &
Menegatti, ICRA 2014). It is the same estimate as that of `multi_position`, in the twelve unknowns
of other methods, with P symmetric.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from inertial.estimation import accelerometers, multi_position
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.elimination import whitened
from inertial.estimation.random_walk import Stretch
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.forward import Triad

SYMMETRY_SIGMA = 1e-8  # of M_xy − M_yx
CROSS_SIGMA = multi_position.PRIOR_SIGMA[3] * np.sqrt(2)  # before both cross terms are alike
PRIOR_SIGMA = np.append(np.where(np.eye(3, dtype=bool).ravel(), 1.0, CROSS_SIGMA), np.full(3, 10.0))
PAIRS = ((1, 3), (2, 6), (5, 7))  # of the nine elements by rows


def drifting(
    statics: Sequence[StaticForce],
    gravity: float,
    gravity_sigma: float,
    about: Triad,
    effect_sigma: Mapping[str, float],
    scatter: float,
) -> DriftingEquations:
    """The equations about a triad and the direction `up` of each position.

    Unknowns: M by rows, bias, gravity, effects; `scatter`, m/s²: between positions, beyond noise.
    """
    effects = list(effect_sigma)
    prior = np.concatenate([accelerometers.PRIOR, [gravity], np.zeros(len(effects))])
    ups = np.array([static.up for static in statics])
    normal = ups @ np.linalg.inv(about.matrix)
    every = accelerometers.linear_rows(statics, gravity, about, prior, effects)
    along = np.einsum("ni,nij->nj", normal, every)
    rows = along[:, np.r_[: len(prior), -1]]  # no tilt changes them
    noise = np.hypot([static.sigma for static in statics], scatter)
    rows[:, -1] -= multi_position.lengthened(about.matrix, ups, noise, gravity)
    sigma = np.linalg.norm(normal * noise, axis=1)
    alike = np.zeros((len(PAIRS), rows.shape[1]))
    for row, (one, other) in enumerate(PAIRS):
        alike[row, [one, other]] = 1.0, -1.0
    symmetric = whitened(alike, np.full(len(PAIRS), SYMMETRY_SIGMA), ())
    blocks = [(symmetric, Stretch("symmetry"))]
    for i, static in enumerate(statics):
        some = slice(i, i + 1)
        block = whitened(rows[some], sigma[some], ())
        blocks.append((block, static.stretch or Stretch(f"rest {i}")))
    names = [("parameter", str(i)) for i in range(UNKNOWNS)] + [("gravity", "")]
    return DriftingEquations(
        blocks,
        ["", *(static.position for static in statics)],
        {},
        prior,
        np.array([*PRIOR_SIGMA, gravity_sigma, *effect_sigma.values()]),
        (*names, *(("effect", name) for name in effects)),
        accelerometers.BIAS,
    )

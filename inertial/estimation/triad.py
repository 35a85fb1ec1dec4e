"""A triad of sensors in one case: reading = M · truth + bias, and the decomposition of M.

M = I + S + N, with the scale factor errors S on the diagonal and the cross terms N elsewhere
(sources: S0, eq. 3-1; S3, eq. 6). By polar decomposition M = P R: R takes the truth into the
orthogonal axes nearest to the sensors', so its inverse is the rotation of the sensor triad against
the case; the symmetric P holds the scale factors and the non-orthogonality.
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import polar
from scipy.spatial.transform import Rotation

from inertial.arrays import Array
from inertial.physics.forward import Triad
from inertial.text.parameters import AXES, BIAS

# Order of the twelve unknowns: M by rows, then the bias.
UNKNOWNS = 12


def linear_names() -> tuple[str, ...]:
    """Names of the twelve unknowns in their order: M by rows, then the bias."""
    matrix = tuple(
        f"scale_{row}" if row == column else f"cross_{row}{column}"
        for row in AXES
        for column in AXES
    )
    return matrix + BIAS


def errors_of(unknowns: Array) -> Array:
    """The unknowns with M − I for M: scale factor errors and cross terms, (12,)."""
    return np.asarray(unknowns - np.append(np.eye(3).ravel(), np.zeros(3)))


def triad_of_errors(errors: ArrayLike) -> Triad:
    """The triad of scale factor errors and cross terms, M − I by rows, and the bias, (12,)."""
    values = np.asarray(errors, np.float64)
    return Triad(np.eye(3) + values[:9].reshape(3, 3), values[9:])


def mounting_and_symmetric(matrix: Array) -> Array:
    """Mounting rotation (rad, rotation vector) and symmetric part P − I of M, (9,).

    The order is MOUNTING, SYMMETRIC.
    """
    rotation, symmetric = polar(matrix, side="left")
    mounting = -Rotation.from_matrix(rotation).as_rotvec()
    error = symmetric - np.eye(3)
    return np.concatenate([mounting, np.diag(error), error[[0, 0, 1], [1, 2, 2]]])


def jacobian_of_mounting(matrix: Array) -> Array:
    """Derivative of `mounting_and_symmetric` with respect to M by rows, (9, 9)."""
    columns, step = [], 1e-6
    for unit in np.eye(9):
        change = step * unit.reshape(3, 3)
        difference = mounting_and_symmetric(matrix + change) - mounting_and_symmetric(
            matrix - change
        )
        columns.append(difference / (2 * step))
    return np.column_stack(columns)


def design_of(truth: Array) -> Array:
    """Rows of the reading of three sensors, (3, 12), for a truth (3,)."""
    return np.hstack([np.kron(np.eye(3), truth), np.eye(3)])

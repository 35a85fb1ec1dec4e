"""Rotations, exact at any angle: the laboratory uses no small-angle approximation."""

import numpy as np
from scipy.spatial.transform import Rotation

from laboratory.arrays import Array


def cross_matrix(vector: Array) -> Array:
    """The matrix of the cross product with `vector`, (3, 3)."""
    x, y, z = vector
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def rotation_about(axis: Array, angle: Array) -> Array:
    """Rodrigues: R = I + sin θ [a×] + (1 − cos θ) [a×]².

    axis: unit vector, (3,); angle: rad, any shape (…), right-hand rule.
    Returns (…, 3, 3), which turns a vector by θ about a; if the case turns by θ, R takes the
    components of a vector after the turn to those before it.
    """
    once = cross_matrix(axis)
    sine = np.sin(angle)[..., None, None]
    one_less_cosine = 2 * np.sin(angle / 2)[..., None, None] ** 2
    return np.eye(3) + sine * once + one_less_cosine * (once @ once)


def rotation_of(vector: Array) -> Array:
    """The rotation, (3, 3), about a rotation vector, (3,), rad."""
    angle = float(np.linalg.norm(vector))
    if angle == 0:
        return np.eye(3)
    return rotation_about(vector / angle, np.asarray(angle))


def axis_and_angle(rotation: Array) -> tuple[Array, float]:
    """The unit axis, (3,), and the angle, 0 … π rad, of a rotation (3, 3)."""
    vector: Array = np.asarray(Rotation.from_matrix(rotation).as_rotvec(), dtype=float)
    angle = float(np.linalg.norm(vector))
    return (vector / angle if angle > 0 else np.array([0.0, 0.0, 1.0])), angle


def seen_from(attitude: Array, vector: Array) -> Array:
    """A vector of the level frame in the axes of the case: v_body = Cᵀ v_level.

    attitude: (…, 3, 3), level from body; vector: (3,) or (…, 3). Returns (…, 3).
    """
    seen: Array = np.einsum("...ji,...j->...i", attitude, vector)
    return seen

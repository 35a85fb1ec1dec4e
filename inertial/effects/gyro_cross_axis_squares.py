"""A gyro that feels the square of a rate across its axis."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Parameter, Term, Truth, by_grade
from inertial.text.messages import _

OTHERS = tuple((i, j) for i in range(3) for j in range(3) if i != j)


class GyroCrossAxisSquares(OfSensed):
    """ω̃_i += Σ K_ij ω_j² over the other two axes j.

    As the products of rates, where the main axes of inertia stand oblique in the gyro; and the
    centripetal force on a mass that is out of balance. Alike in turns of both senses, which a
    cross term is not; told from a bias in turns by two rates.
    """

    name = "gyro_cross_axis_squares"
    sensor = "gyro"
    cause = _("what moves in the gyro is out of balance, or its axes of inertia stand oblique")
    source = "IEEE Std 528-2019, 'anisoinertia'; Titterton & Weston 2004, errors of gyros"
    parameters = tuple(
        Parameter(
            f"k_{'xyz'[i]}{'xyz'[j]}",
            "(rad/s)/(rad/s)²",
            1e-6,
            _("reading of the {i} gyro per square of the rate about {j}", i="xyz"[i], j="xyz"[j]),
        )
        for i, j in OTHERS
    )
    terms = tuple(
        Term(f"gyro_{'xyz'[i]}", f"k_{'xyz'[i]}{'xyz'[j]}", f"w_{'xyz'[j]} * w_{'xyz'[j]}")
        for i, j in OTHERS
    )
    sizes = by_grade(1e-6, 0.1, 1, 10, 100)

    def change(self, truth: Truth, values: Array) -> Array:
        matrix = np.zeros((3, 3))
        matrix[tuple(np.transpose(OTHERS))] = values
        return truth.rate**2 @ matrix.T

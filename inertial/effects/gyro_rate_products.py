"""A gyro that feels the product of two rates."""

import numpy as np

from inertial.arrays import Array
from inertial.effects.accel_cross_products import NAMES, PAIRS
from inertial.physics.effect import OfSensed, Parameter, Term, Truth, by_grade
from inertial.text.messages import _


class GyroRateProducts(OfSensed):
    """ω̃_i += Σ K_i,jk ω_j ω_k over the pairs xy, yz, zx.

    The moments of inertia of what swings or spins in the gyro are not alike (anisoinertia): by
    Euler's equation ω × Jω turns it. Only turns about an oblique axis show it: of those about an
    axis of the case the products are nought.
    """

    name = "gyro_rate_products"
    sensor = "gyro"
    cause = _("the moments of inertia of what moves in the gyro are not alike (anisoinertia)")
    source = "IEEE Std 528-2019, 'anisoinertia'; Titterton & Weston 2004, errors of gyros"
    parameters = tuple(
        Parameter(
            f"k_{i}_{pair}",
            "(rad/s)/(rad/s)²",
            1e-6,
            _(
                "reading of the {i} gyro per product of the rates about {pair} and {pair_2}",
                i=i,
                pair=pair[0],
                pair_2=pair[1],
            ),
        )
        for i in "xyz"
        for pair in NAMES
    )
    terms = tuple(
        Term(f"gyro_{i}", f"k_{i}_{pair}", f"w_{pair[0]} * w_{pair[1]}")
        for i in "xyz"
        for pair in NAMES
    )
    sizes = by_grade(1e-6, 0.1, 1, 10, 100)

    def change(self, truth: Truth, values: Array) -> Array:
        products = np.column_stack([truth.rate[:, j] * truth.rate[:, k] for j, k in PAIRS])
        return products @ values.reshape(3, 3).T

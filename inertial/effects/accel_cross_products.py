"""An accelerometer that feels the product of two forces."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Parameter, Term, Truth, by_grade
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY

PAIRS = ((0, 1), (1, 2), (2, 0))
NAMES = ("xy", "yz", "zx")


class AccelCrossProducts(OfSensed):
    """f̃_i += Σ K_i,jk f_j f_k over the pairs xy, yz, zx.

    Only oblique positions show it: with an axis up the products are nought.
    """

    name = "accel_cross_products"
    sensor = "accel"
    cause = _("a force across the input axis changes what the proof mass does along it")
    source = "IEEE Std 1293-2018, model equation, cross-coupling coefficients"
    parameters = tuple(
        Parameter(
            f"k_{i}_{pair}",
            "(m/s²)/(m/s²)²",
            1e-5 / STANDARD_GRAVITY,
            _(
                "reading of the {i} accelerometer per product of the forces along {pair} "
                "and {pair_2}",
                i=i,
                pair=pair[0],
                pair_2=pair[1],
            ),
        )
        for i in "xyz"
        for pair in NAMES
    )
    terms = tuple(
        Term(f"accel_{i}", f"k_{i}_{pair}", f"f_{pair[0]} * f_{pair[1]}")
        for i in "xyz"
        for pair in NAMES
    )
    sizes = by_grade(1e-6 / STANDARD_GRAVITY, 10, 50, 100, 500)

    def change(self, truth: Truth, values: Array) -> Array:
        products = np.column_stack([truth.force[:, j] * truth.force[:, k] for j, k in PAIRS])
        return products @ values.reshape(3, 3).T

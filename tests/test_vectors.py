"""Products of vectors."""

import numpy as np
import pytest

from inertial.physics.motion import cross


@pytest.mark.parametrize(
    "shapes", [((3,), (3,)), ((3,), (7, 3)), ((7, 3), (3,)), ((5, 7, 3), (7, 3))]
)
def test_the_cross_product_is_that_of_numpy_to_the_last_bit(shapes):
    chance = np.random.default_rng(1)
    a, b = (chance.normal(size=shape) for shape in shapes)
    np.testing.assert_array_equal(cross(a, b), np.cross(a, b))

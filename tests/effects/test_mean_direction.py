"""The mean of the vertical while the case turns: shorter where it lies across the axis."""

import numpy as np

from inertial.physics.motion import mean_turned, turned_all


def test_it_is_the_mean_of_many_directions():
    up = np.array([0.0, 0.6, 0.8])
    axis = np.array([0.0, 0.0, 1.0])
    middle, angle = np.array([0.3, 2.0]), np.array([0.2, -0.7])
    found = mean_turned(up, axis, middle, angle)
    for i in range(2):
        fine = middle[i] + angle[i] * ((np.arange(2000) + 0.5) / 2000 - 0.5)
        np.testing.assert_allclose(found[i], turned_all(up, axis, fine).mean(axis=0), atol=1e-8)
    # About the vertical itself nothing becomes shorter.
    np.testing.assert_allclose(mean_turned(axis, axis, middle, angle), [axis, axis])

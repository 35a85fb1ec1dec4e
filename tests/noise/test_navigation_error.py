"""S1: what counts for navigation is the density of the noise, not its RMS."""

import numpy as np
import pytest
from navigation_error import BANDWIDTHS, CHANNELS, DENSITY, SECONDS, demonstration

from inertial.estimation.multiresolution import Powers
from inertial.estimation.noise_terms import noise_terms


def test_the_same_density_at_any_bandwidth_gives_the_same_error_of_the_angle():
    found = demonstration()
    rms, errors = np.array([one.rms for one in found]), np.array([one.error for one in found])
    # The RMS of white noise of both-sided density N² up to a bandwidth f is N √(2f) …
    np.testing.assert_allclose(rms, DENSITY * np.sqrt(2 * np.array(BANDWIDTHS)), rtol=0.03)
    assert rms[0] / rms[-1] > 5
    # … and the angle after T scatters by N √T, whatever the RMS: angle random walk.
    sigma = 1 / np.sqrt(2 * CHANNELS)
    np.testing.assert_allclose(errors, DENSITY * np.sqrt(SECONDS), rtol=4 * sigma)
    # The same noise, filtered: the errors agree far better than by chance.
    np.testing.assert_allclose(errors, errors[0], rtol=0.03)


def test_the_estimated_white_noise_tells_it():
    for one in demonstration()[::2]:
        powers = Powers(1, one.interval)
        powers.add(one.rates[:, :1])
        powers.end()
        (terms,) = noise_terms(powers)
        assert terms is not None
        white = terms.terms["white_noise"]
        assert terms.highest < 1.02 * one.bandwidth  # a bin
        assert white.value == pytest.approx(DENSITY, abs=4 * white.sigma)
        assert white.sigma < 0.1 * DENSITY

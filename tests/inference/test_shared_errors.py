"""Errors that two sensors share count once: against the covariance of all readings written out."""

import numpy as np

from inertial.estimation.effect_information import EffectInformation

EFFECTS, ERRORS = 5, 4
SIGMA = np.array([0.3, 0.5, 1.0, 2.0])  # of the errors


def _information(design, observed):
    names = tuple(map(str, range(EFFECTS + ERRORS)))
    normal, right = design.T @ design, design.T @ observed
    return EffectInformation(names, normal, right, float(observed @ observed), len(observed))


def test_two_sensors_with_the_same_errors_are_one_set_of_equations():
    rng = np.random.default_rng(1)
    first, second = rng.normal(size=(30, EFFECTS + ERRORS)), rng.normal(size=(25, EFFECTS + ERRORS))
    observed = rng.normal(size=55)
    one, other = _information(first, observed[:30]), _information(second, observed[30:])
    added = other.following(one, SIGMA**-2)
    both = one.eliminated(SIGMA**-2) + added

    design = np.vstack([first, second])
    of_effects, of_errors = design[:, :EFFECTS], design[:, EFFECTS:] * SIGMA
    weight = np.linalg.inv(np.eye(55) + of_errors @ of_errors.T)
    np.testing.assert_allclose(both.information, of_effects.T @ weight @ of_effects, rtol=1e-9)
    np.testing.assert_allclose(both.right, of_effects.T @ weight @ observed, rtol=1e-9)
    np.testing.assert_allclose(both.chi_squared, observed @ weight @ observed, rtol=1e-9)
    assert np.all(np.linalg.eigvalsh(added.information) > 0)

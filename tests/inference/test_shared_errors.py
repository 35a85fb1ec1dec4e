"""Errors that two sensors share count once: against the covariance of all readings written out."""

import numpy as np

from inertial.estimation.effect_information import NormalEquations, split, with_prior

EFFECTS, ERRORS = 5, 4
SIGMA = np.array([0.3, 0.5, 1.0, 2.0])  # of the errors


def _told(design, observed):
    """Of rows in their order, some at a time."""
    names = [("effect", str(i)) for i in range(EFFECTS)] + [("tilt", str(i)) for i in range(ERRORS)]
    equations = NormalEquations(names, np.ones(len(names)), ERRORS)
    for rows in np.array_split(np.column_stack([design, observed]), 3):
        equations.add(rows)
    return equations.information(len(observed), 0)


def test_two_sensors_with_the_same_errors_are_one_set_of_equations():
    rng = np.random.default_rng(1)
    first, second = rng.normal(size=(30, EFFECTS + ERRORS)), rng.normal(size=(25, EFFECTS + ERRORS))
    observed = rng.normal(size=55)
    one, other = _told(first, observed[:30]), _told(second, observed[30:])
    known, of_one = split(with_prior(one.on_errors, SIGMA**-2), ERRORS)
    _, of_other = split(np.vstack([known, other.on_errors]), ERRORS)
    added = other.on_effects.with_rows(of_other)
    both = one.on_effects.with_rows(of_one) + added

    design = np.vstack([first, second])
    of_effects, of_errors = design[:, :EFFECTS], design[:, EFFECTS:] * SIGMA
    weight = np.linalg.inv(np.eye(55) + of_errors @ of_errors.T)
    np.testing.assert_allclose(both.information, of_effects.T @ weight @ of_effects, rtol=1e-9)
    np.testing.assert_allclose(both.right, of_effects.T @ weight @ observed, rtol=1e-9)
    np.testing.assert_allclose(both.chi_squared, observed @ weight @ observed, rtol=1e-9)
    assert np.all(np.linalg.eigvalsh(added.information) > 0)

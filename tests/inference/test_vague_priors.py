"""What the vague priors of parameters add to the residuals: nothing."""

import numpy as np
import pytest

from inertial.estimation.elimination import eliminate
from inertial.estimation.least_squares import System

CROSS_TERM, VAGUE = 0.025, 0.0707  # of a consumer sensor, and the sigma of its prior
LINE = np.array([[1.0, t] for t in range(6)])
SQUARE = np.array([float(t**2) for t in range(6)])


def chi_squared(unit: float, prior_sigma: float) -> float:
    """Of six readings about a straight line, beside an effect that grows as the square."""
    noise = unit * np.array([1.0, -2.0, 0.5, 1.5, -2.0, 1.0])
    observed = LINE @ [CROSS_TERM, -CROSS_TERM] + noise
    names = (("parameter", "0"), ("parameter", "1"), ("effect", "square"))
    _rows, nothing = eliminate([], 3, {})
    system = System(
        np.column_stack([LINE, SQUARE]),
        observed,
        np.full(6, unit),
        np.zeros(3),
        np.array([prior_sigma, prior_sigma, 1.0]),
        2,
        names,
        nothing,
    )
    return system.effect_information().chi_squared


@pytest.mark.parametrize("unit", [1e-6, 1e-4, 1e-3])
def test_a_parameter_far_from_its_vague_prior_is_no_residual(unit):
    """By least squares the noises leave 12.4857 about the line, whatever its parameters are."""
    noise = np.array([1.0, -2.0, 0.5, 1.5, -2.0, 1.0])
    t = np.arange(6.0) - 2.5
    left = noise @ noise - noise.sum() ** 2 / 6 - (noise @ t) ** 2 / (t @ t)
    assert chi_squared(unit, VAGUE) == pytest.approx(left, abs=2e-3)

"""Effects against a scatter that is estimated from the same residuals, in equations by numpy."""

import numpy as np
import pytest
from scipy import stats

from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.evidence import searched_effect
from inertial.model_selection.scatter_tests import named_share, residual_columns, scatter_tests

DEGREES, LEVEL = 13, 0.02
COLUMNS = np.random.default_rng(7).standard_normal((DEGREES, 30))
SEARCHED = [
    searched_effect("one", *[[i, i + 1, i + 2] for i in range(18)]),
    searched_effect("other", list(range(21, 28))),
    searched_effect("none", [28], [29]),
]


def sensor(residuals: np.ndarray) -> EffectInformation:
    """What the equations of residuals in units of their sigma say."""
    information, right = COLUMNS.T @ COLUMNS, COLUMNS.T @ residuals
    names = tuple(map(str, range(30)))
    return EffectInformation(names, information, right, float(residuals @ residuals), DEGREES)


RAW = np.sum(COLUMNS**2, axis=0)


def smallest(residuals: np.ndarray) -> float:
    tests = scatter_tests(sensor(residuals), RAW, SEARCHED)
    assert tests is not None
    return float(tests.p_values.min())


def test_the_p_value_is_that_of_the_textbook():
    residuals = np.random.default_rng(1).standard_normal(DEGREES)
    tests = scatter_tests(sensor(residuals), RAW, SEARCHED)
    fitted = COLUMNS[:, 21:28] @ np.linalg.lstsq(COLUMNS[:, 21:28], residuals, rcond=None)[0]
    rest = residuals - fitted
    ratio = (fitted @ fitted / 7) / (rest @ rest / 6)
    place = tests.places.index((1, 0))
    assert tests.used[place] == 7
    assert tests.p_values[place] == pytest.approx(stats.f.sf(ratio, 7, 6), rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("size", [1.0, 40.0])
def test_a_scatter_of_any_size_is_named_as_often_as_the_level_says(size):
    random = np.random.default_rng(2)
    share = named_share([scatter_tests(sensor(np.ones(DEGREES)), RAW, SEARCHED)], LEVEL)
    false = sum(smallest(size * random.standard_normal(DEGREES)) < share for _ in range(4000))
    assert false == pytest.approx(4000 * LEVEL, abs=4 * np.sqrt(4000 * LEVEL))
    assert share > 2 * LEVEL / len(SEARCHED[0].candidates) / 3  # neighbours are no new trials


def test_an_effect_is_found_though_the_scatter_that_it_makes_hides_it():
    residuals = np.random.default_rng(3).standard_normal(DEGREES)
    residuals += 20 * COLUMNS[:, 5] / np.linalg.norm(COLUMNS[:, 5])
    by_scatter = residuals / np.sqrt(residuals @ residuals / DEGREES)
    share = named_share([scatter_tests(sensor(by_scatter), RAW, SEARCHED)], LEVEL)
    tests = scatter_tests(sensor(by_scatter), RAW, SEARCHED)
    effect, value = tests.places[int(np.argmin(tests.p_values))]
    assert tests.p_values.min() < share and effect == 0 and 3 <= value <= 5


def test_vague_priors_are_no_residuals():
    """A column that all parameters absorb but for their priors says nothing of an effect."""
    residuals = np.random.default_rng(4).standard_normal(DEGREES)
    own = sensor(residuals)
    vague = 1e-6 * np.random.default_rng(5).standard_normal((9, 30))
    with_priors = EffectInformation(
        own.names,
        own.information + vague.T @ vague,
        own.right + vague.T @ np.full(9, 1e3),
        own.chi_squared,
        DEGREES,
    )
    root, _along = residual_columns(with_priors, RAW)
    assert root.shape == (30, DEGREES)
    assert np.allclose(root @ root.T, own.information, atol=1e-4 * RAW.max())

"""Errors that are eliminated where they occur: the same estimate as with all unknowns at once."""

import numpy as np
import pytest

from stages.inference.elimination import Part, eliminated
from stages.inference.least_squares import System, solve

SHARED, SIGMA = 3, 0.5
PRIOR, WIDTH = np.array([1.0, 0.0, -1.0]), np.full(3, 100.0)


def made_up(stretches: int, rng: np.random.Generator) -> tuple[list[Part], list[np.ndarray]]:
    """Parts with an error of their own, one that the next part shares, and one of them all."""
    parts, rows = [], []
    for i in range(stretches):
        own = (("own", str(i)), ("near", str(i // 2)), ("common", ""))
        design = rng.standard_normal((int(rng.integers(3, 12)), SHARED + 3))
        observed = rng.standard_normal(len(design))
        parts.append(Part(np.column_stack([design, observed]), own, len(design), 0.0))
        rows.append(design)
    return parts, rows


def all_at_once(parts: list[Part], names: list[tuple[str, str]]):
    design = np.zeros((sum(len(part.rows) for part in parts), SHARED + len(names)))
    row = 0
    for part in parts:
        some = slice(row, row + len(part.rows))
        design[some, :SHARED] = part.rows[:, :SHARED]
        for column, name in enumerate(part.own, SHARED):
            design[some, SHARED + names.index(name)] = part.rows[:, column]
        row += len(part.rows)
    observed = np.concatenate([part.rows[:, -1] for part in parts]) + design[:, :SHARED] @ PRIOR
    prior = np.append(PRIOR, np.zeros(len(names)))
    width = np.append(WIDTH, np.full(len(names), SIGMA))
    return solve(design, observed, np.ones(len(observed)), prior, width, SHARED)


@pytest.mark.parametrize("stretches", [1, 2, 41])
def test_the_estimate_is_that_of_all_unknowns_at_once(stretches):
    parts, _ = made_up(stretches, np.random.default_rng(stretches))
    parts = [part.shorter() for part in parts]
    names = list(dict.fromkeys(name for part in parts for name in part.own))
    rows, apart = eliminated(parts, SHARED, dict.fromkeys(names, SIGMA))
    shared = tuple(("parameter", str(i)) for i in range(SHARED))
    observed = rows[:, -1] + rows[:, :-1] @ PRIOR
    system = System(rows[:, :-1], observed, np.ones(len(rows)), PRIOR, WIDTH, SHARED, shared, apart)
    found, expected = system.solve(), all_at_once(parts, names)
    order = [*range(SHARED), *(system.column(*name) for name in names)]
    np.testing.assert_allclose(found.values[order], expected.values, atol=1e-9)
    np.testing.assert_allclose(found.sigma[order], expected.sigma, rtol=1e-9)
    np.testing.assert_allclose(found.covariance, expected.covariance[:SHARED, :SHARED], rtol=1e-8)
    assert [found.names[i] for i in order[SHARED:]] == names
    assert found.chi_squared == pytest.approx(expected.chi_squared)
    assert found.deviance == pytest.approx(expected.deviance)
    assert (found.degrees, found.rows) == (system.apart.count - SHARED, system.apart.count)


def test_the_work_grows_as_the_stretches():
    """Rows and columns that are triangular at once do not grow with their number."""
    sizes = []
    for stretches in (50, 400):
        parts, _ = made_up(stretches, np.random.default_rng(0))
        names = {name for part in parts for name in part.own}
        _, apart = eliminated(parts, SHARED, dict.fromkeys(names, SIGMA))
        sizes.append(max(len(step.keys) for step in apart.told))
    assert sizes[1] == pytest.approx(sizes[0], rel=0.3)

"""Errors that are eliminated where they occur: the same estimate as with all unknowns at once."""

from dataclasses import replace

import numpy as np
import pytest

from inertial.estimation.elimination import (
    MAX_ROWS_PER_COLUMN,
    MIN_ROWS_PER_FACTORISATION,
    EquationBlock,
    compressed,
    eliminate,
)
from inertial.estimation.least_squares import System, solve

SIGMA = 0.5
ROUND = 60  # parts after which errors come again


def made_up(stretches: int, shared: int, rng: np.random.Generator) -> list[EquationBlock]:
    """Parts with an error of their own, one that the next part shares, six that come again, and
    one of them all."""
    parts = []
    for i in range(stretches):
        again = tuple((f"again {j}", str(i % ROUND)) for j in range(6))
        own = (("own", str(i)), ("near", str(i // 2)), *again, ("common", ""))
        design = rng.standard_normal((int(rng.integers(3, 7)), shared + len(own)))
        observed = rng.standard_normal(len(design))
        parts.append(EquationBlock(np.column_stack([design, observed]), own, len(design), 0.0))
    return parts


def all_at_once(parts: list[EquationBlock], names: list[tuple[str, str]], prior, width):
    shared = len(prior)
    design = np.zeros((sum(len(part.rows) for part in parts), shared + len(names)))
    row = 0
    for part in parts:
        some = slice(row, row + len(part.rows))
        design[some, :shared] = part.rows[:, :shared]
        for column, name in enumerate(part.own, shared):
            design[some, shared + names.index(name)] = part.rows[:, column]
        row += len(part.rows)
    observed = np.concatenate([part.rows[:, -1] for part in parts]) + design[:, :shared] @ prior
    prior = np.append(prior, np.zeros(len(names)))
    width = np.append(width, np.full(len(names), SIGMA))
    return solve(design, observed, np.ones(len(observed)), prior, width, shared)


@pytest.mark.parametrize(("stretches", "shared"), [(1, 3), (2, 3), (41, 3), (150, 3), (150, 200)])
def test_the_estimate_is_that_of_all_unknowns_at_once(stretches, shared):
    parts = made_up(stretches, shared, np.random.default_rng(stretches))
    parts = [replace(part, rows=compressed(part.rows)) for part in parts]
    prior, width = np.linspace(-1, 1, shared), np.full(shared, 100.0)
    names = list(dict.fromkeys(name for part in parts for name in part.own))
    rows, eliminated = eliminate(parts, shared, dict.fromkeys(names, SIGMA))
    own = tuple(("parameter", str(i)) for i in range(shared))
    observed = rows[:, -1] + rows[:, :-1] @ prior
    system = System(
        rows[:, :-1], observed, np.ones(len(rows)), prior, width, shared, own, eliminated
    )
    found, expected = system.solve(), all_at_once(parts, names, prior, width)
    order = [*range(shared), *(system.column(*name) for name in names)]
    np.testing.assert_allclose(found.values[order], expected.values, atol=1e-9)
    np.testing.assert_allclose(found.sigma[order], expected.sigma, rtol=1e-9)
    covariance = expected.covariance[:shared, :shared]
    np.testing.assert_allclose(found.covariance, covariance, rtol=1e-8, atol=1e-12)
    assert [found.names[i] for i in order[shared:]] == names
    assert found.chi_squared == pytest.approx(expected.chi_squared)
    assert found.deviance == pytest.approx(expected.deviance)
    assert found.rows == eliminated.count
    assert found.degrees == expected.degrees


def test_rows_that_are_left_are_made_fewer():
    parts = made_up(400, 3, np.random.default_rng(0))
    rows, _ = eliminate(parts, 3, {name: SIGMA for part in parts for name in part.own})
    assert len(rows) <= MAX_ROWS_PER_COLUMN * 4 + MIN_ROWS_PER_FACTORISATION


def test_the_work_grows_as_the_stretches():
    """Rows and columns that are triangular at once do not grow with their number."""
    sizes = []
    for stretches in (150, 600):
        parts = made_up(stretches, 3, np.random.default_rng(0))
        names = {name for part in parts for name in part.own}
        _, eliminated = eliminate(parts, 3, dict.fromkeys(names, SIGMA))
        sizes.append(max(len(step.keys) for step in eliminated.steps))
    assert sizes[1] == pytest.approx(sizes[0], rel=0.3)

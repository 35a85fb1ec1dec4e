"""Optimal designs that are known in closed form (Atkinson, Donev & Tobias 2007, chapter 11)."""

import numpy as np
import pytest

from inertial.estimation.optimal_design import WORST, A, Candidates, D, best_plan, relaxed

PLACES = np.linspace(-1, 1, 21)


def quadratic(*parameters: int) -> Candidates:
    """One measurement of 1 s of a + b x + c x² at each of the places."""
    rows = np.stack([PLACES**0, PLACES, PLACES**2], axis=1)[:, list(parameters)]
    information = rows[:, :, None] * rows[:, None, :]
    count = len(parameters)
    return Candidates([information], [1e-9 * np.eye(count)], np.ones(21), count, np.ones(count))


@pytest.mark.parametrize(
    ("criterion", "shares", "value"),
    [
        (D, (1 / 3, 1 / 3, 1 / 3), (27 / 4) ** (1 / 3)),  # det of M is 4/27
        (A, (1 / 4, 1 / 2, 1 / 4), 8 / 3),  # the trace of the inverse is 8
    ],
)
def test_a_quadratic_is_best_measured_at_the_ends_and_in_the_middle(criterion, shares, value):
    candidates = quadratic(0, 1, 2)
    times, bound = relaxed(candidates, 1.0, criterion)
    near = [times[:2].sum(), times[8:13].sum(), times[-2:].sum()]  # places beside the best count
    np.testing.assert_allclose(near, shares, atol=0.005)
    total = candidates.total(times)
    assert candidates.value(criterion, total) == pytest.approx(value, rel=1e-3)
    assert bound == pytest.approx(value, rel=5e-3)
    assert bound <= value * (1 + 1e-9)


def test_a_plan_of_whole_measurements_is_rounded_to_the_best():
    plan = best_plan(quadratic(0, 1, 2), 12.0, D)
    assert plan.counts[[0, 10, 20]].tolist() == [4, 4, 4] and plan.counts.sum() == 12
    assert plan.efficiency == pytest.approx(1.0, abs=5e-3)
    plan = best_plan(quadratic(0, 1, 2), 12.0, A)
    assert plan.counts[[0, 10, 20]].tolist() == [3, 6, 3]


def test_the_worst_of_a_straight_line_is_measured_at_the_ends():
    """The variances of a and b are both 1/n there, and that of b is larger anywhere else."""
    plan = best_plan(quadratic(0, 1), 8.0, WORST)
    assert plan.counts[[0, 20]].tolist() == [4, 4]
    assert plan.value == pytest.approx(1 / 8, rel=1e-6)


def test_longer_measurements_are_worth_their_time_only():
    """Twice the information in three times the time is never taken."""
    once = quadratic(0, 1, 2)
    both = Candidates(
        [np.concatenate([once.information[0], 2 * once.information[0]])],
        once.known,
        np.repeat([1.0, 3.0], 21),
        3,
        once.reference,
    )
    plan = best_plan(both, 12.0, D)
    assert not plan.counts[21:].any()
    assert plan.counts[[0, 10, 20]].tolist() == [4, 4, 4]

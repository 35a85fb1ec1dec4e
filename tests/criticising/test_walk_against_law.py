"""A law and a random walk of each axis explain a drift: which is likelier, by their evidence.

The readings are made here: a bias of three gyros that are read in stretches, with white noise.
"""

import numpy as np
import pytest

from inertial.model_selection.effect_classes import log_evidence
from inertial.model_selection.walk_odds import LOG_RANGE, Equations, law, laws, walk

STRETCHES, SPAN, HALF_WAVES = 60, 2800.0, 8
TIME = np.linspace(0.0, SPAN, STRETCHES)
SEEDS = range(40)


def columns():
    """A ramp of each axis, and its half waves: the design (180, 3 + 24) and the places of each."""
    ramp = (TIME / SPAN - 0.5)[:, None]
    waves = np.cos(np.pi * TIME[:, None] / SPAN * np.arange(1, HALF_WAVES + 1))
    every = np.zeros((STRETCHES, 3, 3 + 3 * HALF_WAVES))
    for axis in range(3):
        every[:, axis, axis] = ramp[:, 0]
        every[:, axis, 3 + axis * HALF_WAVES : 3 + (axis + 1) * HALF_WAVES] = waves
    every -= every.mean(axis=0)  # the bias is fitted
    axes = [list(range(3 + a * HALF_WAVES, 3 + (a + 1) * HALF_WAVES)) for a in range(3)]
    return every.reshape(-1, every.shape[2]), [0, 1, 2], axes


def log_odds(drift):
    """Of a ramp against random walks, for the drift of the biases, (60, 3), in units of noise."""
    design, ramp, axes = columns()
    read = drift - drift.mean(axis=0)
    equations = Equations(design.T @ design, design.T @ read.reshape(-1))
    single = np.ones(1)
    return law(equations, [ramp], single).log_evidence - walk(equations, axes).log_evidence


def noisy(drift, seed):
    return drift + np.random.default_rng(seed).standard_normal((STRETCHES, 3))


def of_ratio(drift, ratio):
    """As large as a signal-to-noise ratio says, the bias fitted."""
    return drift * ratio / np.sqrt(np.sum((drift - drift.mean(axis=0)) ** 2))


@pytest.mark.parametrize("axes", [[0, 1, 0], [1, -0.5, 0.7]])
def test_a_straight_line_is_a_ramp_or_in_its_class(axes):
    drift = of_ratio(np.outer(TIME, axes), 9.0)
    odds = np.array([log_odds(noisy(drift, seed)) for seed in SEEDS])
    assert np.mean(odds > -3) == 1.0 and np.median(odds) > 2


@pytest.mark.parametrize("axes", [[1, 1, 1], [0, 0, 1]])
def test_a_random_walk_is_no_ramp(axes):
    """Of a clear walk a few are as straight as a ramp; none is more clearly one than chance."""
    odds = []
    for seed in SEEDS:
        steps = np.random.default_rng([7, seed]).standard_normal((STRETCHES, 3)) * axes
        odds.append(log_odds(noisy(of_ratio(np.cumsum(steps, axis=0), 25.0), seed)))
    assert np.mean(np.array(odds) > 3) <= 0.05
    assert np.median(odds) < -3


def test_nothing_is_explained_by_neither():
    design, ramp, axes = columns()
    for seed in range(10):
        read = noisy(np.zeros((STRETCHES, 3)), seed)
        read -= read.mean(axis=0)
        equations = Equations(design.T @ design, design.T @ read.reshape(-1))
        assert walk(equations, axes).log_evidence < 2
        assert law(equations, [ramp], np.ones(1)).log_evidence < 2


def test_an_axis_of_an_effect_that_another_effect_hides_is_not_taken_as_silent():
    """Courses with 0.7 in common that cancel each other in x: neither order of the two matters."""
    common, size = 0.7, 12.0
    block = np.array([[1.0, common], [common, 1.0]])
    sizes = np.array([[size, -size / common], [size, 0.0], [0.0, size]])  # of x, y, z
    equations = Equations(np.kron(np.eye(3), block), (sizes @ block).ravel())
    one, other = (([[k, 2 + k, 4 + k]], np.ones(1)) for k in range(2))
    assert equations.right[0] == pytest.approx(0.0)  # of the first in x, before the second is known
    both = [laws(equations, effects) for effects in ([one, other], [other, one])]
    assert both[0] == pytest.approx(both[1], abs=1.0)
    drop = np.sum((sizes @ block) * sizes)
    assert drop / 2 - 25 < both[0] < drop / 2 - 10  # what six sizes and their ranges cost


def test_the_time_of_a_jump_is_chosen_beside_a_much_larger_effect():
    """Two hundred sigma of a ramp look like a jump in the middle; the jump was early."""
    times = np.arange(5, STRETCHES - 5)
    jumps = (np.arange(STRETCHES)[:, None] >= times).astype(float)
    design = np.column_stack([jumps, TIME / SPAN])
    design -= design.mean(axis=0)
    design /= np.linalg.norm(design, axis=0)
    truth = 20.0 * design[:, 3] + 200.0 * design[:, -1]
    equations = Equations(design.T @ design, design.T @ truth)
    jump = ([[i] for i in range(len(times))], np.ones(len(times)))
    ramp = ([[len(times)]], np.ones(1))
    for effects in ([jump, ramp], [ramp, jump]):
        assert laws(equations, effects) > truth @ truth / 2 - 25  # what two sizes and a time cost


@pytest.mark.parametrize(("place", "cheaper"), [([4], 12), ([3, 4, 5], 5), (range(9), -2)])
def test_a_matrix_acts_as_a_whole_in_rows_or_in_one_element(place, cheaper):
    """One size in place of nine costs less, and a random direction hardly more than before."""
    sizes = np.zeros(9)
    sizes[list(place)] = 12.0 / np.sqrt(len(place))
    equations = Equations(np.eye(9), sizes)
    whole = log_evidence(np.array([144.0]), np.array([9]))[0] - LOG_RANGE
    told = law(equations, [list(range(9))], np.ones(1)).log_evidence
    assert told > whole + cheaper
    assert told < 144 / 2


def test_what_biases_of_runs_contain_is_nothing_beside_them():
    """Of the rounding that was left of a jump its log odds were 84 millions."""
    run = np.repeat(np.arange(5), STRETCHES // 5)
    runs = (run[:, None] == np.arange(1, 5)).astype(float)
    jumps = (run[:, None] >= np.arange(1, 5)) * np.pi
    design = np.column_stack([runs, jumps, TIME / SPAN])
    design -= design.mean(axis=0)
    equations = Equations(design.T @ design, design.T @ of_ratio(TIME**2, 3000.0))
    rest = equations.given([0, 1, 2, 3])
    assert not rest.right[:8].any() and not rest.information[:8].any()
    assert rest.information[8, 8] > 0.01 * equations.information[8, 8] and rest.right[8]

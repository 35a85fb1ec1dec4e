"""A step of the angle in one turn is no line of any turn, and is found with its size and time."""

from dataclasses import replace

import numpy as np
import pytest
from residuals_of_turns import NOISE, STEP, line, turns
from test_lines_of_turns import RINGING
from test_step_per_turn import jumping
from test_time_or_angle import found

from stages.criticism.angle_steps import without_steps
from stages.criticism.oscillation_search import find_oscillations

LEVEL, LOWEST = 1e-3, 2.0  # of false alarm; Hz
SLIPPED = 4  # which of the turns


def slipping(made, degrees, seconds, at=8.0, axis="y", across=0.0):
    """The same turns, in one of which the case turns by so much about an axis, at a time, s.

    As a screw gives way: softly at first. `across`: rad/s, by which another gyro reads more after.
    """
    turn = made[SLIPPED]
    truth = turn.truth.copy()
    time = STEP * (np.arange(len(truth)) + 0.5)
    share = np.clip((time - at) / seconds, 0, 1)
    done = (1 - np.cos(np.pi * share)) / 2
    truth[:, "xyz".index(axis)] += np.radians(degrees) * np.gradient(done, STEP)
    truth[:, "xyz".index(axis) - 1] += across * done
    return [*made[:SLIPPED], replace(turn, truth=truth), *made[SLIPPED + 1 :]]


@pytest.mark.parametrize(
    ("degrees", "seconds", "axis"),
    [(0.15, 0.2, "z"), (-0.02, 0.2, "z"), (0.12, 0.05, "x"), (0.3, 0.8, "z")],
)
def test_it_is_found_with_size_axis_and_time_and_makes_no_line(degrees, seconds, axis):
    made = slipping(turns(11), degrees, seconds, axis=axis)
    result = find_oscillations(made, LEVEL, LOWEST)
    assert not result.oscillations
    (step,) = result.steps
    assert (step.manoeuvre, step.axis) == (made[SLIPPED].name, axis)
    assert np.degrees(step.size) == pytest.approx(degrees, abs=4 * np.degrees(step.sigma))
    assert step.sigma < abs(step.size) / 10
    middle, whole = STEP * (step.first + step.after) / 2, STEP * (step.after - step.first)
    assert middle == pytest.approx(8.0 + seconds / 2, abs=0.05)
    assert seconds / 2 < whole < 2 * seconds + 0.05


def test_a_slip_across_the_axis_leaves_no_line_though_the_rate_is_another_after_it():
    """Turned by 0.15° across it a gyro reads 0.05 °/s of 20 °/s from then on."""
    made = slipping(turns(12), 0.15, 0.2, axis="x", across=np.radians(0.05))
    result = find_oscillations(made, LEVEL, 0.2)
    assert len(result.steps) == 1
    assert not result.oscillations


def test_beside_it_what_rings_is_still_found():
    (one,) = found(slipping(turns(5, ringing=[RINGING]), 0.15, 0.2))
    assert one["cause"] == "oscillation"
    assert one["values"]["frequency"]["value"] == pytest.approx(RINGING[0], abs=1e-3)


def test_what_rings_in_one_turn_alone_is_an_oscillation_and_no_step():
    made = turns(6)
    truth = made[SLIPPED].truth.copy()
    truth[:, 2] += line(len(truth), 3.3, 6 * NOISE, 0.4)
    made[SLIPPED] = replace(made[SLIPPED], truth=truth)
    assert not find_oscillations(made, LEVEL, LOWEST).steps
    (one,) = found(made)
    assert {"oscillation"} < one["members"]  # of one rate: bound to time or to the angle
    (line_of_it,) = find_oscillations(made, LEVEL, LOWEST).oscillations
    assert line_of_it.mean.frequency == pytest.approx(3.3, abs=0.01)
    assert line_of_it.mean.manoeuvres == (made[SLIPPED].name,)


def test_a_jump_of_the_table_at_one_place_of_every_turn_is_none_of_one_turn():
    made = jumping(3, 40, 115, 2.0)
    assert without_steps(made) == (made, [])


def test_nor_where_one_turn_alone_shows_it_clearly():
    """The others have it at a ratio of 4 to their noise."""
    made = jumping(4, 10, 115, 2.0)
    rng = np.random.default_rng(4)
    for i, turn in enumerate(made):
        if i != SLIPPED:
            noise = 11 * NOISE * rng.standard_normal(turn.truth.shape)
            made[i] = replace(turn, truth=turn.truth + noise)
    assert not without_steps(made)[1]


@pytest.mark.parametrize("walk", [0.0, 3e-5])
def test_noise_and_wandering_biases_have_none(walk):
    for seed in range(20):
        assert not without_steps(turns(100 + seed, walk=walk))[1]


def test_a_count_that_toggles_for_some_samples_is_no_step():
    """Of counts far coarser than noise all readings are alike, but for rounding in their sums."""
    made = turns(7)
    alike = [replace(turn, truth=1e-12 * turn.truth) for turn in made]
    truth = alike[SLIPPED].truth.copy()
    truth[800:804, 2] += 10 * NOISE
    alike[SLIPPED] = replace(alike[SLIPPED], truth=truth)
    assert not without_steps(alike)[1]


@pytest.mark.parametrize("end", [slice(-3, None), slice(0, 3)])
def test_a_ramp_that_reaches_into_the_steady_part_is_no_step(end):
    """The last samples, with 60 °/s² for 0.02 s: 0.014° less at the end of one turn."""
    made = turns(8)
    truth = made[SLIPPED].truth.copy()
    truth[end, 2] -= np.radians(0.014) / (3 * STEP)
    made[SLIPPED] = replace(made[SLIPPED], truth=truth)
    assert not find_oscillations(made, LEVEL, LOWEST).steps

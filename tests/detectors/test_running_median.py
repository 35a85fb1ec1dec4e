"""The running median is that of nine readings, whatever they are."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from inertial.detectors.spike import running_median
from inertial.signal.runs import joined, runs


@given(st.lists(st.integers(-5, 5), min_size=9, max_size=60))
def test_it_is_the_median_of_nine(numbers):
    values = np.array(numbers, float)
    windows = np.lib.stride_tricks.sliding_window_view(values, 9)
    assert running_median(values)[4:-4].tolist() == np.median(windows, axis=1).tolist()


def test_a_ramp_and_a_step_are_their_own_median():
    ramp, step = np.arange(50.0), np.repeat([0.0, 1.0], 25)
    for values in (ramp, step, -ramp):
        assert running_median(values).tolist() == values.tolist()


@pytest.mark.parametrize("width", [1, 2, 3, 4])
def test_a_spike_leaves_no_trace(width):
    values = np.zeros(50)
    values[20 : 20 + width] = 7.0
    assert running_median(values).tolist() == [0.0] * 50


@given(st.lists(st.booleans(), max_size=40), st.integers(0, 4))
def test_runs_and_joined_runs_hold_every_place_once(there, apart):
    marks = np.array(there, bool)
    places = np.flatnonzero(marks)
    assert [k for start, end in runs(marks) for k in range(start, end)] == places.tolist()
    stretches = list(joined(places, apart))
    assert {k for start, end in stretches for k in range(start, end)} >= set(places.tolist())
    assert all(b[0] - a[1] > apart for a, b in pairwise(stretches))

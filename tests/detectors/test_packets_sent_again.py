"""Records that came twice, the second stamped as it came."""

import numpy as np

from inertial.signal.stamps import sent_again

STEP = 0.01  # s


def test_a_copy_that_comes_too_soon_is_no_sample():
    random = np.random.default_rng(4)
    readings = random.normal(0, 1, (2000, 6))
    own = np.sort(np.append(np.arange(2000), random.choice(2000, 60, replace=False)))
    copy = np.append(False, np.diff(own) == 0)
    time = STEP * own + 0.002 * copy
    np.testing.assert_array_equal(sent_again(time, readings[own]), copy)
    # In the place of a sample that is missing it is a held record, with which time passes.
    assert not sent_again(STEP * np.arange(len(own)), readings[own]).any()


def test_samples_that_come_in_bursts_are_no_copies():
    random = np.random.default_rng(5)
    readings = random.integers(0, 4, (2000, 6)).astype(float)  # some are alike by chance
    time = STEP * np.arange(2000) + np.where(np.arange(2000) % 3, 0.0, 0.9 * STEP)
    assert not sent_again(time, readings).any()
    assert not sent_again(time[:1], readings[:1]).any()

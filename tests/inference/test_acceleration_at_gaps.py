"""The angular acceleration in blocks of a turn between which samples are missing."""

import numpy as np
import pytest

from inertial.campaign.motions import between_blocks

ACCELERATION, RAMP, SECONDS = 0.35, 2.0, 0.2  # rad/s², s, s


def rate_at(time):
    return ACCELERATION * np.clip(time, 0.0, RAMP)


@pytest.mark.parametrize("lost", [0.0, 0.01, 0.1])
def test_the_rate_changes_while_samples_are_missing(lost):
    """Blocks from rest through a ramp to a steady rate, lost samples before every second one."""
    missing = np.where(np.arange(20) % 2, lost, 0.0)
    first = np.cumsum(SECONDS + missing) - SECONDS
    fine = first[:, None] + SECONDS * (np.arange(2000) + 0.5) / 2000
    begins, ends, off = between_blocks(rate_at(fine).mean(axis=1), np.full(20, SECONDS), missing)
    known = (off[:-1] < 1e-3) & (off[1:] < 1e-3)  # no corner is near
    known[-3:] = False  # nor the end, where it does not stop
    known[0] = False
    assert known.sum() > 8
    np.testing.assert_allclose(begins[known], rate_at(first)[known], atol=1e-6)
    np.testing.assert_allclose(ends[known], rate_at(first + SECONDS)[known], atol=1e-6)
    slope = (ends - begins) / SECONDS
    in_ramp = known & (first + SECONDS < RAMP)
    assert slope[in_ramp] == pytest.approx(ACCELERATION, abs=1e-5)

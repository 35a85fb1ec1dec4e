"""Sensors behind a filter: their noise is not white, and there is nothing else to find."""

from dataclasses import replace

import chain
import numpy as np
import pytest
from hidden import hidden_plans
from scipy.signal import butter, lfilter, lfilter_zi

import laboratory

RATE = 100.0


def behind_filter(recording: laboratory.Recording, corner: float, order: int):
    """The counts of all channels behind a low-pass, what one leaves over in the next."""
    b, a = butter(order, corner / (RATE / 2))
    logs = {}
    for log, records in recording.records.items():
        counts = records.counts.astype(float)
        smooth, _ = lfilter(b, a, counts, axis=0, zi=lfilter_zi(b, a)[:, None] * counts[0])
        whole = np.rint(np.cumsum(smooth, axis=0)).astype(records.counts.dtype)
        logs[log] = replace(records, counts=np.diff(whole, axis=0, prepend=0))
    return replace(recording, records=logs)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("corner", "order"),
    [
        (20.0, 2),
        (3.0, 1),
        (10.0, 2),
    ],
)
def test_no_oscillation_no_ripple_and_sigmas_that_hold(corner, order):
    """A gyro of 3 Hz had six oscillations "found", and residuals of 1.4 times their noise."""
    recording = laboratory.perform(laboratory.specify(hidden_plans.positions(seed=11)))
    tables = chain.in_memory(behind_filter(recording, corner, order), "criticism", chain.BESIDE)
    assert tables["criticism/findings"].empty and tables["segment/findings"].empty

"""One gyro that is far noisier than the others."""

from dataclasses import replace

import chain
import numpy as np
import pytest

import laboratory

COUNT = 1.085e-7  # rad, of the demo's gyros
NOISE = 1.2e-4  # rad/√s, white: 34 times that of the demo


@pytest.mark.slow
def test_what_every_calibration_takes_up_is_not_named_for_it():
    """Its angles of the table are noisy, those of an effect in the same way."""
    recording = laboratory.perform(laboratory.specify(chain.demo(seed=3)))
    random = np.random.default_rng(5)
    noisy = {}
    for log, records in recording.records.items():
        counts = records.counts.copy()
        scatter = NOISE * np.sqrt(np.median(np.diff(records.stamps)) / 1e9) / COUNT
        counts[:, 3] += np.rint(random.normal(0, scatter, len(counts))).astype(counts.dtype)
        noisy[log] = replace(records, counts=counts)
    results = chain.in_memory(replace(recording, records=noisy), "criticism", chain.BESIDE)
    assert results["criticism/findings"].empty
    (noise,) = (
        results["noise/levels"]
        .query("channel == 'gyro_x' and source == 'common'")["white_noise"]
        .unique()
    )
    assert abs(noise / NOISE - 1) < 0.05

"""A link that loses a record now and then: each turn lacks some, and is whole nevertheless."""

from dataclasses import fields, replace
from itertools import product

import chain
import numpy as np
import pytest

import laboratory


def losing(recording: laboratory.Recording, share: float, seed: int):
    """The recording without a share of its records, at random."""
    random = np.random.default_rng(seed)
    logs = {}
    for log, records in recording.records.items():
        kept = random.uniform(size=len(records.stamps)) >= share
        kept[:2] = True
        own = {each.name: getattr(records, each.name) for each in fields(records)}
        arrays = {n: v for n, v in own.items() if isinstance(v, np.ndarray) and len(v) == len(kept)}
        logs[log] = replace(records, **{name: values[kept] for name, values in arrays.items()})
    return replace(recording, records=logs)


@pytest.mark.parametrize("share", [0.01, 0.04])
def test_the_scale_factors_stay_and_no_line_is_found(share):
    """The turns were left out, for in their ramps, too, a sample is missing."""
    document = chain.short(seed=5)
    recording = laboratory.perform(laboratory.specify(document))
    tables = chain.in_memory(losing(recording, share, 7), "diagnosis", chain.BESIDE)
    causes = tables["diagnosis/causes"]
    assert set(causes["cause"]) == {"gap"} and set(causes["cure"]) == {"interpolated"}
    assert set(tables["diagnosis/verdict"]["verdict"]) == {"usable_within_limits"}
    result = tables["diagnosis/result"].set_index(["sensor", "parameter"]).loc["gyro"]
    truth = document["truth"]["gyro"]["matrix"]
    pulls = []
    for i, j in product(range(3), range(3)):
        row = result.loc[f"scale_{'xyz'[i]}" if i == j else f"cross_{'xyz'[i]}{'xyz'[j]}"]
        pulls.append((row["value"] - (truth[i][j] - (i == j))) / row["sigma"])
    assert np.sqrt(np.mean(np.square(pulls))) < 1.6 and np.abs(pulls).max() < 3.5

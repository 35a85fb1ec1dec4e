"""A link that loses a record now and then, or exchanges two: the turns are whole nevertheless."""

from collections.abc import Callable
from dataclasses import fields, replace
from itertools import product

import chain
import numpy as np
import pytest

import laboratory


def with_records(recording: laboratory.Recording, taken: Callable[[int], np.ndarray]):
    """The recording with those records of each log, by its number of them, in that order."""
    logs = {}
    for log, records in recording.records.items():
        places = taken(len(records.stamps))
        own = {each.name: getattr(records, each.name) for each in fields(records)}
        arrays = {
            name: values
            for name, values in own.items()
            if isinstance(values, np.ndarray) and len(values) == len(records.stamps)
        }
        logs[log] = replace(records, **{name: values[places] for name, values in arrays.items()})
    return replace(recording, records=logs)


def losing(share: float, seed: int) -> Callable[[int], np.ndarray]:
    """All but a share of the records, at random."""
    random = np.random.default_rng(seed)

    def taken(number: int) -> np.ndarray:
        kept = random.uniform(size=number) >= share
        kept[:2] = True
        return np.flatnonzero(kept)

    return taken


def exchanging(share: float, seed: int) -> Callable[[int], np.ndarray]:
    """All records, a share of them after the next."""
    random = np.random.default_rng(seed)

    def taken(number: int) -> np.ndarray:
        places = np.arange(number)
        for first in random.choice(np.arange(3, number - 3, 3), int(share * number), replace=False):
            places[[first, first + 1]] = places[[first + 1, first]]
        return places

    return taken


def pulls_of_gyros(tables: chain.Results, truth: list[list[float]]) -> np.ndarray:
    """Errors of scale factors and cross terms, in sigma."""
    result = tables["diagnosis/result"].set_index(["sensor", "parameter"]).loc["gyro"]
    pulls = []
    for i, j in product(range(3), range(3)):
        row = result.loc[f"scale_{'xyz'[i]}" if i == j else f"cross_{'xyz'[i]}{'xyz'[j]}"]
        pulls.append((row["value"] - (truth[i][j] - (i == j))) / row["sigma"])
    return np.array(pulls)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.01, 0.04])
def test_the_scale_factors_stay_and_no_line_is_found(share):
    """The turns were left out, for in their ramps, too, a sample is missing."""
    document = chain.short(seed=5)
    recording = laboratory.perform(laboratory.specify(document))
    tables = chain.in_memory(with_records(recording, losing(share, 7)), "diagnosis", chain.BESIDE)
    causes = tables["diagnosis/causes"]
    assert set(causes["cause"]) == {"gap"} and set(causes["cure"]) == {"interpolated"}
    assert set(tables["diagnosis/verdict"]["verdict"]) == {"usable_within_limits"}
    pulls = pulls_of_gyros(tables, document["truth"]["gyro"]["matrix"])
    assert np.sqrt(np.mean(np.square(pulls))) < 1.6 and np.abs(pulls).max() < 3.5


@pytest.mark.slow
def test_what_is_missing_in_a_rest_is_harmless():
    lost = {"lose": {"log": "x-up.asc", "line": 900, "samples": 400}}
    tables = chain.in_memory_of(chain.short(seed=5, faults=[lost]), "diagnosis", chain.BESIDE)
    (cause,) = tables["diagnosis/causes"].to_dict("records")
    assert (cause["cause"], cause["cure"], cause["moves"]) == ("gap", "none", 0.0)
    assert set(tables["diagnosis/verdict"]["verdict"]) <= {"usable", "usable_within_limits"}


@pytest.mark.slow
def test_records_out_of_order_are_missing_nowhere():
    """Where time leaps before a record that came early: a scale factor was 190 sigma off."""
    document = chain.short(seed=5)
    recording = laboratory.perform(laboratory.specify(document))
    tables = chain.in_memory(with_records(recording, exchanging(0.01, 8)), "diagnosis")
    assert tables["segment/performed"]["found"].all()
    causes = set(tables["diagnosis/causes"]["cause"])
    assert "time_backwards" in causes and causes <= {"time_backwards", "gap", "spike"}
    pulls = pulls_of_gyros(tables, document["truth"]["gyro"]["matrix"])
    assert np.sqrt(np.mean(np.square(pulls))) < 1.6 and np.abs(pulls).max() < 3.5

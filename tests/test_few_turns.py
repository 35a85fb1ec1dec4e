"""Gyros of a plan that turns one axis only, or two: the earth's rate alone tells the others."""

import chain
import hidden_plans
import numpy as np
import pytest

from inertial.estimation.triad import linear_names


@pytest.mark.parametrize(
    ("turned", "seed"),
    [("z", 3), ("xz", 5), *(pytest.param("xz", s, marks=pytest.mark.slow) for s in (4, 6, 7))],
)
def test_what_is_told_is_within_its_sigma(turned, seed):
    """Equations that were linear about no horizontal rate crept: a bias was 12.8 sigma off."""
    document = hidden_plans.positions(seed=seed)
    plan = document["campaign"]["plan"]
    ups = {f"+{axis}" for axis in turned}
    rests = [one for one in plan if one["do"] == "rest" and one["up"] not in ("-x", "+y")]
    turns = [one for one in plan if one["do"] == "turn" and one["up"] in ups and one["degrees"] > 0]
    document["campaign"]["plan"] = [*rests, *turns]
    made = chain.in_memory_of(document, "gyroscope").parameters("gyroscope")
    gyro = document["truth"]["gyro"]
    matrix = np.array(gyro["matrix"]) - np.eye(3)
    truth = dict(zip(linear_names(), [*matrix.ravel(), *gyro["bias_rad_s"]], strict=True))
    pulls = [
        (row.value - truth[name]) / row.sigma
        for name, row in made.reindex(linear_names()).dropna(subset="sigma").iterrows()
    ]
    assert len(pulls) >= 6 and np.abs(pulls).max() < 4.0, np.round(pulls, 1)


def test_one_rest_alone_is_criticised_without_a_time_between():
    """All that may set in or change sets in between two stretches, of which there is one."""
    document = chain.short()
    rest = document["campaign"]["plan"][0]
    document["campaign"]["plan"] = [{**rest, "seconds": 6}]
    results = chain.in_memory_of(document, "criticism")
    assert results["criticism/findings"].empty

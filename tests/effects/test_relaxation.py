"""What turns leave in the gyros, and how it relaxes: by hand, and hidden in a short campaign."""

import chain
import numpy as np
import pytest

from inertial.effects.gyro_relaxation import excited
from inertial.text.units import DEGREE_PER_HOUR

TAU = 12.0  # s
NOT_NEEDED = ("studies", "comparison", "compensation")
RELAXING = {"gyro_relaxation", "gyro_relaxation_sense", "gyro_relaxation_braking"}


def test_a_stretch_has_the_mean_of_what_is_left():
    """By quadrature: after the turn, astride its end, in it, and where none was."""
    since, seconds = np.array([10.0, 1.0, -20.0, np.nan, np.inf]), np.array([8.0, 6, 4, 5, 5])
    shares = excited(since, seconds, TAU)
    for i in range(3):
        times = since[i] + seconds[i] * (np.linspace(0, 1, 100_001)[1:] - 0.5)
        left = np.where(times > 0, np.exp(-times / TAU), 0).mean()
        assert shares.left[i] == pytest.approx(left, abs=1e-4)
        assert shares.turning[i] == pytest.approx(np.mean(times <= 0), abs=1e-4)
    assert not shares.left[3:].any() and not shares.turning[3:].any()


def named(effects: dict[str, object]) -> tuple[set[str], chain.Tables]:
    results = chain.in_memory_of(chain.short(effects=effects, seed=7), "criticism", NOT_NEEDED)
    scores = results["criticism/scores"]
    return set(scores.loc[scores["named"], "effect"]), results


def test_what_relaxes_after_any_turn_is_named_and_absent_where_nothing_is_hidden():
    hidden = {"in_turn_deg_h": [0, 0, 0], "after_deg_h": [0, 0, 30], "time_constant_s": TAU}
    found, results = named({"gyro_relaxation": hidden})
    assert found == {"gyro_relaxation"}
    effects = results["criticism/effects"].set_index(["effect", "parameter"]).loc["gyro_relaxation"]
    for parameter, truth in {"b_x": 0, "d_x": 0, "d_z": 0, "d_y": 0}.items():
        one = effects.loc[parameter]
        assert abs(one["value"] - truth * DEGREE_PER_HOUR) < 3.5 * one["sigma"], parameter
    # With one delay after each turn the size is known only along with the time constant.
    one = effects.loc["b_z"]
    assert one["value"] > 10 * one["sigma"]
    assert not named({})[0] & RELAXING

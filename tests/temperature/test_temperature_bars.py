"""The measured figures of the chamber campaigns, from outcomes made up so that they are known."""

from typing import Any

import numpy as np
from temperature_bars import bars

RANDOM = np.random.default_rng(4)
POINTS = 41


def curve(true: str, found: str, ratio: float, error: float, sigma: float) -> dict[str, Any]:
    """A curve whose errors scatter by `error` bounds, and whose sigma is said to be `sigma`."""
    off = RANDOM.normal(0, error, POINTS).tolist()
    return {"true": true, "found": found, "ratio": ratio, "error": off} | {
        "sigma": [sigma] * POINTS,
        "bound": [1.0] * POINTS,
    }


def measured(*curves: dict[str, Any]) -> list[tuple[str, bool | None]]:
    outcome = {"plan": "nodes", "at": list(range(POINTS)), "between": [True] * POINTS}
    return [(bar.measured, bar.met) for bar in bars([outcome | {"curves": list(curves)}])]


def test_right_curves_with_right_sigmas_meet_every_demand() -> None:
    every = [curve(shape, shape, 9.0, 1.0, 1.0) for shape in ("1", "2", "3", "knee") * 40]
    assert [met for _text, met in measured(*every)] == [True] * 5


def test_each_demand_is_missed_by_what_it_is_about() -> None:
    every = [curve("3", "3", 9.0, 1.0, 1.0) for _ in range(95)]
    straight = [curve("knee", "1", 9.0, 1.0, 1.0) for _ in range(3)]
    other = [curve("knee", "3", 9.0, 1.0, 1.0) for _ in range(8)]
    assert [met for _t, met in measured(*every, *straight)] == [True, True, True, True, False]
    assert [met for _t, met in measured(*every, *other)] == [True, True, True, False, True]
    rough = [curve("3", "3", 9.0, 1.5, 1.5) for _ in range(100)]
    assert [met for _t, met in measured(*rough)] == [True, False, True, True, True]
    sure = [curve("3", "3", 9.0, 1.0, 0.7) for _ in range(100)]
    assert [met for _t, met in measured(*sure)] == [True, True, False, True, True]


def test_weak_curves_and_constants_are_not_judged() -> None:
    unusable = curve("knee", "0", 30.0, np.nan, np.nan)
    assert [met for _t, met in measured(unusable)][3:] == [False, True]
    weak = [curve("knee", "0", 7.9, 9.0, 1.0), curve("0", "0", 0.0, 9.0, 1.0)]
    assert [met for _t, met in measured(*weak)] == [True, None, None, None, None]

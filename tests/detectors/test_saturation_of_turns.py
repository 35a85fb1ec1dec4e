"""Turns beyond the range of a gyro whose readings scatter there are known by the plan."""

from types import SimpleNamespace

import numpy as np
import pytest

from inertial.detectors.saturation_of_turns import SaturationOfTurns

LIMIT, PLANNED, RAMP = 30.0, 40.0, 2.0  # °/s, °/s, s of each ramp from and to rest


def recorded(**changes):
    """Of y turns at 40 °/s there and back, twice, and at 20 °/s, whose gyro ends at 30 °/s.

    With trapezoids: a whole turn lasts 360/40 + 2 s, of which the gyro is at its limit for 8 s
    and 1.5 s in each ramp below: 8 · 30 + 1.5 · 30 = 285° of 360°.
    """
    planned = np.array([PLANNED, -PLANNED, PLANNED, -PLANNED, 20.0, -20.0])
    fast, sense = np.abs(planned) > LIMIT, np.sign(planned)
    n = len(planned)
    facts = {
        "name": [f"y-{k}" for k in range(n)],
        "log": ["log"] * n,
        "do": ["turn"] * n,
        "about": np.tile([0.0, 1.0, 0.0], (n, 1)),
        "found": np.ones(n, bool),
        "complete": ~fast,
        "angle": np.radians(360.0 * sense),
        "rate": np.radians(planned),
        "moved": np.radians(np.where(fast, 285.0, 360.0) * sense),
        "speed": np.radians(np.where(fast, LIMIT + 0.003 * np.arange(n), 20.0) * sense),
        "duration": 360.0 / np.abs(planned) + RAMP,
        "first": np.arange(n),
        "after": np.arange(n) + 1,
        "from_s": np.zeros(n),
        "to_s": np.ones(n),
    }
    return SimpleNamespace(**{**facts, **changes})


def test_turns_that_stop_at_one_rate_are_those_of_the_gyro_they_turn_about():
    seen = recorded()
    found = list(SaturationOfTurns().detect(seen))
    assert [each.at for each in found] == [0, 1, 2, 3] and {each.axis for each in found} == {"y"}
    assert [each.size for each in found] == pytest.approx([LIMIT] * 4, rel=1e-3)
    words = SaturationOfTurns().describe(found[1], seen)
    assert "y-1: the gyro y reads no more than 30.00 °/s of 40.00 °/s planned" in words.sentence
    assert "in 4 turns" in words.sentence and "wrong by −21 %" in words.consequence


FAST = np.arange(6) < 4


@pytest.mark.parametrize(
    "changes",
    [
        {"complete": np.ones(6, bool)},  # a slow table that took its time
        {"duration": np.where(FAST, 8.0, 20.0)},  # begun late or stopped early
        {"speed": np.radians([30.0, -33.0, 36.0, -31.0, 20.0, -20.0])},  # each at its own rate
        {"found": np.arange(6) != np.arange(6), "complete": np.zeros(6, bool)},
        {"complete": np.arange(6) != 0},  # one alone
        {"speed": np.radians([30.0, -30.0, 30.0, -30.0, 35.0, -20.0])},  # the gyro reads more
    ],
    ids=["whole", "short", "scattered", "not-found", "one", "beyond"],
)
def test_other_turns_that_lack_of_their_angle_are_not(changes):
    assert not list(SaturationOfTurns().detect(recorded(**changes)))

"""Which manoeuvres are advised to distinguish causes: none that the plan has already."""

from typing import Any

import numpy as np
import pandas as pd

from inertial.campaign.records import Manoeuvre, Performed
from inertial.tables import ACCEL, GYRO
from stages.criticism.class_splitting import TURNED_OVER, extended_plans

RATE = float(np.radians(72.0))


def turn(name: str, axis: str, up: float, rate: float) -> Manoeuvre:
    about = np.eye(3)["xyz".index(axis)]
    return Manoeuvre(name, "turn", "log", name, "", up=up * about, about=about, rate=rate)


def plans(*turns: Manoeuvre) -> dict[str, Any]:
    done = {m.name: Performed(m.name, "", rate=m.rate) for m in turns}
    one = {"time": 1.0, "seconds": 0.2, "count": 20, "phase": "steady"}
    one |= dict.fromkeys((*GYRO, *ACCEL), 1.0)
    blocks = pd.DataFrame([one | {"manoeuvre": m.name} for m in turns])
    return extended_plans(turns, done, blocks)


def test_a_turn_with_the_axis_down_is_advised_only_where_the_plan_has_none_at_that_rate():
    up = [turn("x-up", "x", 1.0, RATE), turn("y-up", "y", 1.0, RATE)]
    down = [turn("x-down", "x", -1.0, -RATE), turn("y-down", "y", -1.0, RATE)]
    assert TURNED_OVER not in plans(*up, *down)
    assert TURNED_OVER in plans(*up)
    at_half = [turn("x-down", "x", -1.0, RATE / 2), turn("y-down", "y", -1.0, RATE / 2)]
    assert TURNED_OVER in plans(*up, *at_half)
    extended = plans(*up, down[0])[TURNED_OVER]()  # of what is missing alone
    assert [m.name for m in extended.plan[3:]] == ["y-up turned over"]

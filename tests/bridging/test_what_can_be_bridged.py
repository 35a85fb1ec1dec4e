"""A missing stretch of steady rate can be bridged; in a ramp a few samples can."""

import numpy as np
import pandas as pd
import pytest
from z_turns import STEP

from stages.segment.completeness import MAX_MISSING_RUN, MIN_STEADY_S, missing_of


def blocks(*stretches: tuple[str, float, float, bool]) -> pd.DataFrame:
    """Blocks of a turn: phase, seconds recorded, seconds missing before, whether they were lost."""
    rows, record = [], 0
    for phase, seconds, missing, lost in stretches:
        record += 0 if lost else round(missing / STEP)
        for number in range(max(round(seconds / 0.2), 1)):
            after = record + round(min(seconds, 0.2) / STEP)
            rows.append(
                {"phase": phase, "seconds": min(seconds, 0.2), "count": float(after - record),
                 "missing_s": 0.0 if number else missing, "from_record": record,
                 "to_record": after}
            )  # fmt: skip
            record = after
    return pd.DataFrame(rows)


UP_RAMP, DOWN_RAMP = ("spin-up", 2.0, 0.0, False), ("spin-down", 2.0, 0.0, False)
STEADY = ("steady", 10.0, 0.0, False)
NOT_STEADY = "the rate is not steady there"
IN_A_ROW = f"{NOT_STEADY}, and more than 3 samples in a row are missing"


@pytest.mark.parametrize(
    ("stretches", "hindrance"),
    [
        ([UP_RAMP, STEADY, DOWN_RAMP], ""),
        ([UP_RAMP, STEADY, ("steady", 10.0, 12.0, True), DOWN_RAMP], ""),
        ([UP_RAMP, STEADY, ("steady", 5, 12.0, True), ("steady", 5, 3, True), DOWN_RAMP], ""),
        ([UP_RAMP, STEADY, ("spin-down", 2.0, 1.0, True)], IN_A_ROW),
        ([UP_RAMP, STEADY, ("spin-down", 1.0, 0.0, False), ("spin-down", 1.0, 0.5, True)],
         IN_A_ROW),
        ([("spin-up", 1.0, 0.0, False), ("spin-up", 0.6, 0.04, True), STEADY, DOWN_RAMP],
         IN_A_ROW),
        # a link that loses a sample now and then
        ([("spin-up", 1.0, 0.0, False), ("spin-up", 0.6, 0.01, True), STEADY, DOWN_RAMP], ""),
        ([("spin-up", 1.0, 0.0, False), ("steady", 10.0, 1.0, True), DOWN_RAMP], IN_A_ROW),
        # one of two gaps touches a ramp
        ([UP_RAMP, STEADY, ("steady", 10.0, 12.0, True), ("spin-down", 1.0, 1.0, True)],
         IN_A_ROW),
        # hardly any steady rate on one side
        ([UP_RAMP, ("steady", 0.4, 0.0, False), ("steady", 10.0, 12.0, True), DOWN_RAMP],
         "only 0.40 s of steady rate are recorded before them, of 1.00 s that are needed"),
        ([UP_RAMP, STEADY, ("steady", 0.6, 12.0, True), DOWN_RAMP],
         "only 0.60 s of steady rate are recorded after them, of 1.00 s that are needed"),
        # a single sample needs no more beside it than itself
        ([UP_RAMP, STEADY, ("steady", 0.2, STEP, True), DOWN_RAMP], ""),
        # masked samples: few in a ramp, or many
        (
            [
                ("spin-up", 1.0, 0.0, False),
                ("spin-up", 1.0, MAX_MISSING_RUN * STEP, False),
                STEADY,
                DOWN_RAMP,
            ],
            "",
        ),
        ([("spin-up", 1.0, 0.0, False), ("spin-up", 1.0, 5 * STEP, False), STEADY, DOWN_RAMP],
         IN_A_ROW),
        ([("spin-up", 0.2, 0.0, False), *[("spin-up", 0.2, 0.03, False)] * 9, STEADY,
          ("spin-down", 0.6, 0.0, False)],
         f"{NOT_STEADY}, and more than 10% of its samples are missing"),
        ([UP_RAMP, STEADY, ("steady", 10.0, 2.0, False), DOWN_RAMP], ""),
        # by hand
        ([("turning", 5.0, 0.0, False), ("turning", 5.0, 0.5, True)],
         "a turn by hand has no steady rate, and more than 3 samples in a row are missing"),
        ([("turning", 5.0, 0.0, False), ("turning", 5.0, 2 * STEP, False)], ""),
        ([UP_RAMP, STEADY, ("steady", 10.0, -3.0, False), DOWN_RAMP],
         "the time goes back while it turns"),
    ],
)  # fmt: skip
def test_what_can_be_bridged(stretches, hindrance):
    moving = blocks(*stretches)
    found = missing_of(moving, np.ones(len(moving)))
    assert found.hindrance == hindrance
    assert found.seconds == pytest.approx(sum(max(missing, 0) for _, _, missing, _ in stretches))
    assert MIN_STEADY_S == 1.0 and MAX_MISSING_RUN == 3

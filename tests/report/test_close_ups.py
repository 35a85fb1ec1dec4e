"""Samples around a finding: where they stand along the figure, what is hatched and dotted."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from inertial import tables
from stages.report.sections.finding_figures import CloseUp, axis, close_ups, gaps_in, masked_in
from tests.report import synthetic
from tests.report.synthetic_values import GAP, GAP_FINDING


def around_the_gap() -> CloseUp:
    return close_ups(synthetic.tables_of(synthetic.campaign(logs=())))[GAP_FINDING]


def test_a_long_gap_leaves_room_for_the_samples_beside_it() -> None:
    along = axis(around_the_gap().x)
    steps = np.diff(along.places)
    assert steps.min() > 0
    assert steps.max() < 0.3 * np.ptp(along.places)  # 11.98 s against 0.6 s on each side
    times = [float(label) for label in along.labels]
    assert min(times) < GAP[0] < GAP[1] < max(times)
    assert not [time for time in times if GAP[0] < time < GAP[1]]


def test_ticks_stand_at_the_times_they_tell() -> None:
    close_up = around_the_gap()
    along = axis(close_up.x)
    there = np.interp(along.ticks, along.places, close_up.x)
    assert there == pytest.approx([float(label) for label in along.labels], abs=1e-9)


def test_evenly_spaced_samples_stand_at_their_times() -> None:
    time = 5 + 0.01 * np.arange(100)
    assert axis(time).places == pytest.approx(time)


def test_a_gap_stands_before_the_record_that_follows_it() -> None:
    close_up = around_the_gap()
    gaps = synthetic.campaign(logs=())["gaps"]
    [after] = gaps_in(close_up, gaps)
    assert list(close_up.line[[after - 1, after]]) == [2192, 2193]
    assert gaps_in(close_up, gaps.assign(log="another.asc")) == []


@pytest.mark.parametrize(
    ("channel", "stretches"), [(None, [(0, 4), (10, 10)]), ("gyro_x", []), ("gyro_z", [(0, 4)])]
)
def test_only_what_is_masked_of_the_channel_counts(
    channel: str | None, stretches: list[tuple[int, int]]
) -> None:
    close_up = around_the_gap()
    start = int(close_up.record[0])
    rows = [
        {
            "from_record": start - 5,
            "to_record": start + 5,
            "sensor": channel and channel[:-2],
            "axis": channel and channel[-1],
        },
        {"from_record": start + 10, "to_record": start + 11, "sensor": None, "axis": None},
    ]
    masks = pd.DataFrame(rows).assign(
        log=close_up.log, repeated=False, censored=False, finding="quality/spike"
    )
    if channel is not None:
        masks = masks.iloc[:1]
    assert masked_in(close_up, masks, ["gyro_z"]) == stretches
    assert masked_in(close_up, tables.MASKS.empty(), ["gyro_z"]) == []


def test_time_that_goes_back_is_drawn_over_lines() -> None:
    close_up = around_the_gap()
    assert close_up.timed
    back = CloseUp(
        close_up.log,
        close_up.record,
        close_up.line,
        close_up.time[::-1],
        close_up.values,
        close_up.concerned,
    )
    assert not back.timed
    assert list(back.x[:2]) == [2133, 2134]

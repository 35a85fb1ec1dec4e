"""Records that are masked while the table turns: no angle is lost with them."""

from math import degrees

import chain
import numpy as np
import pandas as pd
import pytest
from z_turns import NOISE, STEP, inputs_of, of_z


def masked(results: chain.Results, *stretches: tuple[int, int], **more) -> dict[str, pd.DataFrame]:
    """`segment` once more, with these records of z-backward masked."""
    rows = [
        {"log": "z-backward.asc", "from_record": first, "to_record": after, "finding": "spike",
         "sensor": None, "axis": None, "repeated": False, "censored": False, **more}
        for first, after in stretches
    ]  # fmt: skip
    return chain.again(results, "segment", masks=pd.DataFrame(rows))


@pytest.mark.parametrize(
    "axis",
    [
        pytest.param(None, id="all channels"),
        pytest.param("z", id="gyro z", marks=pytest.mark.slow),
        pytest.param("x", id="gyro x"),
    ],
)
@pytest.mark.parametrize(
    ("stretches", "most"),
    [
        ([(2000, 2001)], 0.1),  # a spike in the steady part
        ([(n, n + 1) for n in range(1500, 3000, 100)], 1.0),
        ([(2000, 2300)], 12.0),
        ([(1100, 1101)], 10.0),  # in a ramp: 5 °/s² × 0.2 s × 0.01 s / 4 are 9″
        ([(1100, 1103), (3500, 3502)], 30.0),
    ],
)
def test_a_masked_record_loses_no_angle(whole, stretches, most, axis):
    """`most`: arc seconds, what the sigma may be."""
    tables = masked(whole, *stretches, sensor=axis and "gyro", axis=axis)
    done = of_z(tables)
    missing = STEP * sum(after - first for first, after in stretches)
    few = max(after - first for first, after in stretches) <= 3
    # A few samples here and there are interpolated, and the turn is whole; 3 s are bridged.
    assert (done["complete"], done["bridged"], done["lost"]) == (few, not few, not few)
    assert done["missing_s"] == pytest.approx(0.0 if few else missing)
    whole_angle = degrees(of_z(whole, "segment/performed")["angle"])
    lacking = 0.0 if few else degrees(done["missing_angle"])
    assert degrees(done["angle"]) + lacking == pytest.approx(whole_angle, abs=0.01)
    before, now = inputs_of(whole).turns[-1], inputs_of(whole, tables).turns[-1]
    assert now.weights @ now.seconds == pytest.approx(before.seconds.sum())
    off = now.weights @ now.sums[:, 2] - before.sums[:, 2].sum()
    noise = NOISE * np.sqrt(missing * (1 + missing / 30))
    # Unbridged it would lack 0.1° for each record.
    assert abs(off) < 3 * np.hypot(noise, now.gap_sigma)
    assert degrees(now.gap_sigma) * 3600 < most
    assert np.isfinite(now.sums).all()


def test_a_masked_stretch_of_a_ramp_is_refused(whole):
    done = of_z(masked(whole, (1080, 1110)))
    assert not done["complete"] and not done["bridged"]
    assert "more than 3 samples in a row are missing" in done["sentence"]


def test_a_repeated_record_and_a_masked_accelerometer_leave_the_turn_whole(whole):
    for more in ({"repeated": True}, {"sensor": "accel", "axis": "x"}):
        assert of_z(masked(whole, (1100, 1101), **more))["complete"]


def test_a_gyro_that_is_masked_all_the_time_is_one_that_is_not_recorded(whole):
    tables = masked(whole, (0, 6000), sensor="gyro", axis="x")
    assert of_z(tables)["complete"]
    one = inputs_of(whole, tables).turns[-1]
    assert np.isnan(one.sums[:, 0]).all() and np.isfinite(one.sums[:, 1:]).all()

"""Logs whose stamps go on from one to the next have one clock, whatever that counts from."""

import chain
import numpy as np
import pandas as pd
import pytest

from inertial.campaign.records import clocks_of, runs_of, share_a_clock


def clocks(*spans: tuple[float, float], clock: str = "own") -> pd.DataFrame:
    """The clocks of logs of 100 Hz from the stamps of their first and last samples."""
    rows = [
        {"log": f"{number}.csv", "clock": clock, "epoch_gps": np.nan, "began": first}
        | {"from_s": 0.0, "to_s": last - first, "interval": 0.01}
        for number, (first, last) in enumerate(spans)
    ]
    return pd.DataFrame(rows)


@pytest.mark.parametrize(
    ("spans", "shared"),
    [
        ([(0.0, 60.0), (0.0, 60.0)], False),  # each begins at zero
        ([(0.0, 60.0), (75.0, 130.0), (140.0, 200.0)], True),
        ([(75.0, 130.0), (140.0, 200.0), (0.0, 60.0)], True),  # in another order of the plan
        ([(0.0, 60.0), (55.0, 130.0)], False),
        ([(0.0, 60.0), (5000.0, 5060.0)], False),  # switched off for an hour, or another clock
        ([(1.7e9, 1.7e9 + 60), (1.7e9 + 5000, 1.7e9 + 5060)], True),  # time since 1970
    ],
)
def test_stamps_that_go_on_are_of_one_clock(spans, shared):
    assert share_a_clock(clocks(*spans)) == shared
    offsets = [clock.offset for clock in clocks_of(clocks(*spans)).values()]
    first = min(begin for begin, _ in spans)
    assert offsets == ([begin - first for begin, _ in spans] if shared else [0.0] * len(spans))


def test_by_absolute_time_a_long_pause_is_another_run():
    spans = [(1.7e9, 1.7e9 + 60), (1.7e9 + 90, 1.7e9 + 150), (1.7e9 + 5000, 1.7e9 + 5060)]
    table = clocks(*spans)
    runs = runs_of(table["log"], clocks_of(table), share_a_clock(table))
    assert len(set(runs.values())) == 2 and runs["0.csv"] == runs["1.csv"] != runs["2.csv"]


@pytest.mark.slow
def test_a_warm_up_over_a_log_for_each_manoeuvre_is_found_with_its_size():
    """It was a jump, or a bias of each switch-on, and the bias was off by 7 sigma."""
    hidden = {"start_deg_h": [40.0, -30.0, 50.0], "time_constant_s": 150.0}
    document = chain.short(effects={"gyro_warm_up": hidden}, seed=4)
    document["handling"] |= {"still_s": 8, "change_s": 6}
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    for one in document["campaign"]["plan"]:
        one["log"] = f"{one['id']}.csv"
    results = chain.in_memory_of(document, "criticism")
    findings = results["criticism/findings"]
    assert findings["cause"].tolist() == ["gyro_warm_up"]
    effects = results["criticism/effects"].set_index(["effect", "parameter"]).loc["gyro_warm_up"]
    for axis, size in zip("xyz", hidden["start_deg_h"], strict=True):
        found = effects.loc[f"b_{axis}"]
        assert abs(found["value"] - np.radians(size / 3600)) < 4 * found["sigma"]

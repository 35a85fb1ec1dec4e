"""What spoils readings in many logs is one finding, and the result stays within its sigma."""

from typing import Any

import chain
import numpy as np
import pandas as pd
import pytest
from test_closure import pulls

LIMIT = float(np.radians(60))  # rad/s
ACCEL = 1.07e-3  # m/s², scatter of a reading: 0.0064 m/s/√h at 100 Hz
KNOCK = {"peak_m_s2": 60.0, "peak_rad_s": 3.0, "frequency_hz": 31.0, "decay_s": 0.08}


def to_80(**changes: Any) -> dict[str, Any]:
    """Six rests, and two turns there and back about each axis at 20, 40, 60 and 80 °/s."""
    document = chain.short(**changes)
    rests = [one for one in document["campaign"]["plan"] if one["do"] == "rest"]
    turns = [
        {"id": f"{axis}{way}{rate}", "do": "turn", "up": f"+{axis}", "degrees": degrees}
        | {"rate_deg_s": rate, "accel_deg_s2": 60, "log": f"{axis}{way}{rate}.asc"}
        for axis in "xyz"
        for rate in (20, 40, 60, 80)
        for way, degrees in (("+", 720), ("-", -720))
    ]
    document["campaign"]["plan"] = rests + turns
    return document


def run(document: dict[str, Any], until: str = "criticism") -> chain.Results:
    return chain.in_memory_of(document, until, chain.BESIDE)


def found(results: chain.Results, *stages: str) -> list[dict[str, Any]]:
    tables = [results[f"{stage}/findings"] for stage in stages or ("quality", "segment")]
    return pd.concat(tables).to_dict("records")


def everywhere(results: chain.Results) -> list[dict[str, Any]]:
    return found(results, "quality", "segment", "accelerometer", "criticism")


def assert_true(results: chain.Results) -> None:
    """All 24 parameters within 4.5 sigma."""
    for stage in ("accelerometer", "gyroscope"):
        own = pulls(results, stage, "joint")
        assert len(own) == 12
        assert np.abs(own).max() < 4.5


@pytest.mark.slow
def test_gyros_that_clip_at_a_planned_rate_are_one_finding_and_nothing_else():
    """At 60 °/s the noise alone reaches the limit: what is left of the readings is biased."""
    faults = [
        {"clip": {"log": "all", "channel": f"gyro_{axis}", "limit_rad_s": LIMIT}} for axis in "xyz"
    ]
    results = run(to_80(faults=faults))
    (one,) = everywhere(results)
    assert (one["cause"], one["sensor"]) == ("saturation", "gyro")
    assert "gyros x, y, z reach the end of the range at 60.0" in one["sentence"]
    used = results["gyroscope/fit_manoeuvres"].query("method == 'joint' and phase.isna()")
    used = used.set_index("manoeuvre")
    for axis in "xyz":
        assert used.loc[[f"{axis}+20", f"{axis}-40"], "used"].all()
        refused = used.loc[[f"{axis}+80", f"{axis}-80"]]
        assert not refused["used"].any()
        assert refused["reason"].str.contains(f"below a threshold: gyro {axis}").all()
    assert_true(results)


def test_turns_whose_gyro_clips_show_no_other_rate_of_the_table():
    """360° at 60 °/s, ramps of 2 s: at 53.7 °/s 26.5° are cut off, 7 %, and 10.5 % of the rate."""
    clip = {"log": "all", "channel": "gyro_z", "limit_rad_s": float(np.radians(53.7))}
    document = chain.short(faults=[{"clip": clip}])
    for one in document["campaign"]["plan"]:
        if one["do"] == "turn":
            one["accel_deg_s2"] = 30
    results = run(document, "segment")
    (one,) = found(results)
    assert (one["cause"], one["sensor"], one["axis"]) == ("saturation", "gyro", "z")
    assert results["segment/repairs"].empty
    turns = results["segment/performed"].set_index("manoeuvre").loc[["z-forward", "z-backward"]]
    assert turns["found"].all()
    assert turns["sentence"].str.contains("an angle that is not measured").all()


@pytest.mark.slow
@pytest.mark.parametrize("above", [0.0, 1.0, 2.0])
def test_a_position_whose_noise_is_cut_off_gives_no_mean_of_that_channel(above):
    """`above`: scatters of a reading by which the limit lies above the mean reading."""
    place = {"log": "z-up.asc", "channel": "accel_z", "counted_from": "mean"}
    fault = {"clip": place | {"limit_m_s2": above * ACCEL}}
    results = run(chain.short(faults=[fault]))
    (one,) = everywhere(results)
    assert (one["cause"], one["sensor"], one["axis"]) == ("saturation", "accel", "z")
    rests = results["segment/blocks"].set_index("manoeuvre").loc["z-up"]
    assert rests["accel_z"].isna().all()
    assert np.isfinite(rests[["accel_x", "accel_y", "gyro_z"]].to_numpy()).all()
    done = results["segment/performed"].set_index("manoeuvre").loc["z-up"]
    assert "end of the range or below a threshold: accelerometer z" in done["sentence"]
    assert_true(results)


@pytest.mark.slow
def test_120_spikes_in_12_logs_are_one_finding_and_every_turn_is_whole():
    place = {"lines": list(range(103, 1103, 103))[:10], "channel": "gyro_y", "size_rad_s": 0.6}
    results = run(chain.short(faults=[{"spikes": {"log": "all"} | place}]))
    (one,) = everywhere(results)
    assert (one["cause"], one["count"], one["axis"]) == ("spike", 120, "y")
    assert one["size"] == pytest.approx(0.6, rel=1e-3)
    performed = results["segment/performed"]
    assert performed["complete"].all() and (performed["missing_s"] == 0).all()
    assert_true(results)


@pytest.mark.slow
def test_spikes_of_all_accelerometers_take_no_time_from_the_gyros():
    """Of each turn they lose ten samples: counted for half, they were 270 sigma of a scale."""
    at = {"log": "all", "lines": list(range(303, 1203, 83))[:10], "size_m_s2": 3.0}
    spikes = [{"spikes": at | {"channel": f"accel_{axis}"}} for axis in "xyz"]
    results = run(chain.short(faults=spikes), "gyroscope")
    assert results["quality/findings"]["cause"].tolist() == ["spike"]
    assert_true(results)


def test_a_gap_in_a_turn_is_one_finding_with_the_angle_that_it_hides():
    document = chain.demo(faults=[{"lose": {"log": "x-forward.asc", "line": 2001, "samples": 640}}])
    wanted = ("x-up", "x-down", "x-forward", "x-backward")
    plan = document["campaign"]["plan"]
    document["campaign"]["plan"] = [one for one in plan if one["id"] in wanted]
    results = run(document, "segment")
    (one,) = found(results)
    assert (one["cause"], one["count"], one["size"]) == ("gap", 1, 640)
    # 6.4 s at 10 °/s, by a gyro that reads 615 ppm too much and 0.0021 °/s of the earth: 64.053°
    assert (
        "gap of 6.40 s" in one["sentence"] and "turned by 64.1° during the gap" in one["sentence"]
    )
    turn = results["segment/performed"].set_index("manoeuvre").loc["x-forward"]
    assert turn["bridged"] and turn["lost"] and not turn["complete"]
    assert np.degrees(turn["missing_angle"]) == pytest.approx(64.0, abs=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(("log", "line"), [("y-up.asc", 900), ("y-forward.asc", 600)])
def test_an_impact_is_called_one_and_masks_its_records_alone(log, line):
    results = run(chain.short(faults=[{"knock": {"log": log, "line": line} | KNOCK}]))
    (one,) = everywhere(results)
    assert (one["cause"], one["log"], one["count"]) == ("impact", log, 1)
    (mask,) = results["quality/masks"].to_dict("records")
    assert abs(mask["from_record"] - (line - 1)) <= 3
    # It has decayed to 10⁻³ of a scatter of 10⁻³ m/s² after 18 of its time constants of 0.08 s.
    assert line + 40 < mask["to_record"] < line + 150
    assert_true(results)

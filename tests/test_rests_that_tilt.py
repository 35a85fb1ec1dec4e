"""A rest in which the table tilts: the part before is used, where other rests stand as it does."""

import chain
import pytest

TILT_S = 0.05  # s, of the tilt by 0.06 degrees
ONSET_S = 8  # s after the start of the rest


def document(onset=None):
    """Six rests and six turns, and at the end another rest with z up; the table tilts at a time."""
    effects = {}
    if onset is not None:
        rate = 0.06 / TILT_S * 3600
        tilt = {"about": "north", "rate_deg_h": rate, "from_s": onset, "to_s": onset + TILT_S}
        effects = {"table_creep": tilt}
    made = chain.short(seed=1772, effects=effects)
    plan = made["campaign"]["plan"]
    for one in plan:
        if one["id"] in ("z-up", "z-forward", "z-backward"):
            one["position"] = "z-up"
    again = {"id": "z-up-again", "do": "rest", "position": "z-up", "up": "+z", "seconds": 20}
    plan.append(again | {"log": "z-up-again.asc"})
    return made


@pytest.fixture(scope="module")
def clean():
    return chain.in_memory_of(document(), "diagnosis", chain.BESIDE)


def started(results, manoeuvre):
    """When the records of a rest begin, s, as the laboratory counts."""
    rows = results["segment/segments"].set_index("manoeuvre")
    return float(rows.loc[manoeuvre, "from_s"])


def test_nothing_is_masked_in_rests_that_rest(clean):
    assert clean["segment/masks"].empty
    assert clean["diagnosis/causes"].empty


def test_of_a_rest_that_tilts_the_part_before_is_used_where_others_stand_so(clean):
    onset = started(clean, "z-up-again") + ONSET_S
    made = document(onset)
    results = chain.in_memory_of(made, "diagnosis", chain.BESIDE)
    (finding,) = results["segment/findings"].to_dict("records")
    assert finding["size"] == pytest.approx(216, rel=0.03)  # 0.06 degrees
    (mask,) = results["segment/masks"].to_dict("records")
    assert (mask["log"], mask["finding"]) == ("z-up-again.asc", finding["id"])
    first = mask["from_record"] / 100  # s since its log began, at 100 Hz
    assert first == pytest.approx(ONSET_S, abs=0.1)
    assert set(results["diagnosis/verdict"]["verdict"]) == {"usable_within_limits"}
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cure"] == "masked"
    off = list(in_sigmas(results["diagnosis/result"], made["truth"]))
    assert len(off) == 24
    assert max(off) < 4


def test_a_tilt_after_which_all_others_stand_otherwise_is_not_masked(clean):
    """The table stays tilted, or it settled: which part is at the stated attitude is not known."""
    results = chain.in_memory_of(document(started(clean, "z-up") + ONSET_S), "segment")
    findings = results["segment/findings"].set_index("cause").loc["table_moving"]
    assert findings["manoeuvre"] == "z-up"
    assert "used as it is" in findings["action"]
    assert results["segment/masks"].empty


def in_sigmas(rows, truth):
    """The errors of all parameters, in their sigma."""
    for sensor, name, bias in (
        ("gyro", "gyro", "bias_rad_s"),
        ("accel", "accelerometer", "bias_m_s2"),
    ):
        own = rows[(rows["sensor"] == sensor) & rows["effect"].isna()].set_index("parameter")
        for i, axis in enumerate("xyz"):
            right = {f"bias_{axis}": truth[name][bias][i]}
            for j, other in enumerate("xyz"):
                kind = f"scale_{axis}" if i == j else f"cross_{axis}{other}"
                right[kind] = truth[name]["matrix"][i][j] - (i == j)
            for parameter, value in right.items():
                row = own.loc[parameter]
                yield abs(row["value"] - value) / row["sigma"]

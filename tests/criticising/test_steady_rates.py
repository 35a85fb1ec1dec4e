"""Turns recorded at the steady rate alone show how a scale factor depends on the rate."""

import chain
import numpy as np
import pytest
import yaml

from commands.new import PLANS
from inertial.text.units import DEGREE

PPM = 1e-6


def rate_table(**effects):
    """A session by the plan of a rate table, with effects."""
    document = chain.demo(seed=5, effects=effects, faults=[])
    steady = {"seconds": 60, "accel_deg_s2": 20}
    plan = yaml.safe_load(PLANS["rate-table"].read_text())["plan"]
    document["campaign"]["plan"] = [m | steady if m["do"] == "turn" else m for m in plan]
    document["campaign"]["table"] |= {"rate_sigma_ppm": 20}
    document["handling"] |= {"step": {"rate_deg_s": 30, "accel_deg_s2": 40}}
    document["receiver"]["rate_hz"] = 20
    return chain.in_memory_of(document, "criticism", chain.BESIDE)


def named(tables):
    """The causes, each with the members of its class."""
    members = tables["criticism/members"].groupby("finding")["effect"].agg(set)
    findings = tables["criticism/findings"]
    return {row.cause: members.get(row.id, {row.cause}) for row in findings.itertuples()}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "told", "parameter", "size"),
    [
        ("gyro_scale_cubic", {"k3_ppm_per_deg_s_2": [0, 0, 0.1]}, "k_z", 0.1 * PPM / DEGREE**2),
        ("gyro_scale_asymmetry", {"asymmetry_ppm": [0, 400, 0]}, "a_y", 400 * PPM),
    ],
)
def test_a_scale_factor_that_depends_on_the_rate_is_found_with_its_size(
    effect, told, parameter, size
):
    """It was “not observable”: the turns were in no equation of criticism."""
    tables = rate_table(**{effect: told})
    (members,) = named(tables).values()
    assert effect in members
    found = tables["criticism/effects"].query("effect == @effect").set_index("parameter")
    value, sigma = found.loc[parameter, ["value", "sigma"]]
    assert abs(value - size) < 4 * sigma and sigma < size / 5
    others = found.drop(parameter)
    assert np.all(np.abs(others["value"]) < 4 * others["sigma"])


@pytest.mark.slow
def test_without_an_effect_nothing_is_named_and_a_limit_is_stated():
    tables = rate_table()
    assert not named(tables)
    limits = tables["criticism/detection_limits"].query("effect == 'gyro_scale_cubic'")
    assert np.isfinite(limits["limit"]).all()


@pytest.mark.parametrize("off", [0.0, 2000.0, -2000.0])
def test_a_table_whose_rate_is_off_is_told_by_gravity_in_turns_about_level_axes(off):
    """The scale factors of gyros are by the stated rate: all would be 2000 ppm too large."""
    document = chain.short(seed=6, effects={"table_speed_error": {"rate_ppm": off}} if off else {})
    campaign = document["campaign"]
    campaign["table"] |= {"rate_sigma_ppm": 100}
    turn = {"do": "turn", "seconds": 20, "recorded": "steady"}
    campaign["plan"] = campaign["plan"][:6] + [
        turn | {"id": f"{up}{about}{rate}", "up": up, "about": about, "rate_deg_s": rate}
        for up, about in (("+x", "+x"), ("+y", "+y"), ("+z", "+z"), ("+z", "+x"), ("+x", "+y"))
        for rate in (36, -36)
    ]
    for each in campaign["plan"]:
        each["log"] = f"{each['id']}.asc"
    results = chain.in_memory_of(document, "segment")
    findings = results["segment/findings"]
    ratios = findings.loc[findings["cause"] == "table_rate_off", "size"].tolist()
    assert ratios == ([pytest.approx(1 + 1e-6 * off, abs=5e-5)] if off else [])


def test_turns_alone_give_accelerometers_nothing_and_it_is_said_what_would():
    document = chain.short()
    turns = [m for m in document["campaign"]["plan"] if m["do"] == "turn"]
    document["campaign"]["plan"] = [{**m, "recorded": "steady", "seconds": 12} for m in turns]
    for m in document["campaign"]["plan"]:
        m["rate_deg_s"] *= -1 if m.pop("degrees") < 0 else 1
    reasons = chain.in_memory_of(document, "accelerometer")["accelerometer/parameters"]["reason"]
    assert set(reasons) == {
        "there is no rest whose upward direction is known, and turns alone are not enough: record "
        "one with each axis up and one with each axis down"
    }

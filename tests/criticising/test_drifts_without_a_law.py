"""What drifts by no law is said to do so, and does not spoil the name of what has one."""

import chain
import numpy as np
import pytest
from hidden_plans import rates, stops

WALK = {"gyro_rate_random_walk_deg_h_sqrt_h": 0.4}
G_SENSITIVITY = {"matrix_deg_h_g": [[1.4, 0, 0], [0, -1.0, 0], [0, 0, 1.2]]}
CLEAR = ("found", "one_of_class")
DEGREE_PER_HOUR = np.radians(1 / 3600)  # rad/s


def criticised(seed, effects, noise):
    document = chain.demo(seed=seed, effects=effects)
    document["noise"] = {**document["noise"], **noise}
    return chain.in_memory_of(document, "criticism", chain.BESIDE)


@pytest.fixture(scope="module")
def walking():
    effects = {"gyro_g_sensitivity": G_SENSITIVITY}
    return criticised(203, effects, WALK)


@pytest.mark.slow
def test_a_random_walk_beside_an_effect_is_estimated_and_takes_no_name(walking):
    findings = walking["criticism/findings"].set_index("cause")
    assert set(findings.index) == {"gyro_g_sensitivity", "gyro_random_walk"}
    assert findings.loc["gyro_g_sensitivity", "verdict"] == "found"
    # A jump explains about as much of it: so it may be either, and is never certain.
    assert findings.loc["gyro_random_walk", "verdict"] in ("one_of_class", "unknown_structure")
    members = walking["criticism/members"].set_index(["finding", "rank"])["effect"]
    assert members[findings.loc["gyro_random_walk", "id"], 1] == "gyro_random_walk"
    (walk,) = walking["criticism/random_walks"].itertuples()
    # °/h/√h is per 60 √s; drawn once, so known to a part of itself only.
    true = 0.4 * 4.848e-6 / 60
    assert walk.sensor == "gyro" and true / 3 < walk.value < true * 2.5


@pytest.mark.slow
def test_telegraph_noise_is_no_jump_but_a_law_of_two_levels():
    effects = {"gyro_telegraph": {"height_deg_h": [2.0, 0, 0], "dwell_s": 400}}
    results = criticised(4, effects, {})
    (finding,) = results["criticism/findings"].to_dict("records")
    assert (finding["cause"], finding["verdict"]) == ("gyro_x_telegraph_of_time", "law")
    assert not results["criticism/scores"].set_index("effect").loc["gyro_bias_jump", "named"]
    sizes = results["criticism/effects"].set_index(["effect", "parameter"]).loc[finding["cause"]]
    (between,) = sizes["value"][sizes.index.str.startswith("k")] / DEGREE_PER_HOUR
    assert abs(abs(between) - 4.0) < 0.2  # from −2 to 2 °/h


@pytest.mark.slow
def test_two_jumps_of_two_axes_have_a_time_each():
    """They were one jump of both, and another level of one of them from that to the second."""
    first = {"size_deg_h": [3.0, 0, 0], "at_s": 600.0}
    second = {"height_deg_h": [0, 0, 1.5], "dwell_s": 1500}  # changes once, with this seed
    results = criticised(6, {"gyro_bias_jump": first, "gyro_telegraph": second}, {})
    jump, further = results["criticism/findings"].to_dict("records")
    assert (jump["cause"], jump["verdict"]) == ("gyro_bias_jump", "found")
    assert (further["cause"], further["verdict"]) == ("gyro_z_telegraph_of_time", "law")
    assert "s on, " in further["sentence"] and "further jump" in further["sentence"]
    sizes = results["criticism/effects"].set_index(["effect", "parameter"])["value"]
    by_axis = sizes.loc["gyro_bias_jump"].loc[["b_x", "b_y", "b_z"]] / DEGREE_PER_HOUR
    assert by_axis.tolist() == pytest.approx([3, 0, 0], abs=0.25)
    own = sizes.loc[further["cause"]]
    (size,) = own[own.index.str.startswith("k")] / DEGREE_PER_HOUR
    assert size == pytest.approx(3, abs=0.25)  # from −1.5 to 1.5 °/h


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1801, 102])
def test_a_ramp_of_one_gyro_is_no_walk_of_all(seed):
    ramp = {"gyro_bias_ramp": {"ramp_deg_h_h": [0, 1.24, 0]}}  # SNR 9
    results = criticised(seed, ramp, {})
    (finding,) = results["criticism/findings"].to_dict("records")
    assert finding["verdict"] in CLEAR and finding["cause"] in ("gyro_bias_ramp", "gyro_warm_up")
    assert "gyro_bias_ramp" in set(results["criticism/members"]["effect"])
    assert results["criticism/random_walks"].empty


@pytest.mark.slow
@pytest.mark.parametrize(("sensor", "axis"), [("gyro", 1), ("accel", 2)])
def test_a_scale_factor_that_drifts_beside_a_rising_temperature_may_be_either(sensor, axis):
    drift = [300 * (i == axis) for i in range(3)]
    document = rates(seed=3, effects={f"{sensor}_scale_ramp": {"k_ppm_h": drift}})
    document["temperature"] = {"start_deg_c": 22, "slope_k_h": 15}
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    (finding,) = results["criticism/findings"].to_dict("records")
    either = {f"{sensor}_scale_ramp", f"{sensor}_scale_temperature"}
    assert finding["verdict"] == "one_of_class"
    assert either <= set(results["criticism/members"]["effect"])
    # 300 ppm/h in 15 K/h are 20 ppm/K.
    size = 300e-6 / 3600 if finding["cause"].endswith("ramp") else 20e-6
    effects = results["criticism/effects"].set_index(["effect", "parameter"])
    found = effects.loc[finding["cause"], f"k_{'xyz'[axis]}"]
    assert abs(found["value"] - size) < 3.5 * found["sigma"]


@pytest.mark.slow
def test_an_asymmetry_is_no_ramp_of_an_unthinkable_size():
    """Turns both ways a minute apart: 2 × 400 ppm would be a drift by 40,000 ppm/h."""
    effects = {"gyro_scale_asymmetry": {"asymmetry_ppm": [150, -400, 250]}}
    results = chain.in_memory_of(chain.short(effects=effects), "criticism", chain.BESIDE)
    (finding,) = results["criticism/findings"].to_dict("records")
    assert (finding["cause"], finding["verdict"]) == ("gyro_scale_asymmetry", "found")
    assert results["criticism/members"]["effect"].tolist() == ["gyro_scale_asymmetry"]


@pytest.mark.slow
def test_a_walk_that_is_nearly_straight_is_in_the_class_of_the_ramp():
    """45 times less likely than a ramp of 14 sigma, as one in some 30 walks is."""
    document = stops(seed=15_013_000_799)
    document["noise"] |= {"gyro_rate_random_walk_deg_h_sqrt_h": 0.445}
    tables = chain.in_memory_of(document, "criticism", chain.BESIDE)
    (finding,) = tables["criticism/findings"].to_dict("records")
    assert (finding["cause"], finding["verdict"]) == ("gyro_bias_ramp", "one_of_class")
    assert "gyro_random_walk" in set(tables["criticism/members"]["effect"])

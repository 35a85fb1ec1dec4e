"""An effect is hidden in the data, and found by name; nothing else is; on clean data nothing."""

from functools import cache

import chain
import numpy as np
import pytest

from inertial.effects import CATALOGUE

G = 9.80665
DEGREE_PER_HOUR = np.radians(1 / 3600)  # rad/s
PPM, MICRO_G = 1e-6, 1e-6 * G
HIDDEN = {
    # effect: (how the laboratory hides it, what must come back in SI). Most are about ten times
    # what this plan can see at 5 sigma, see `detection_limit`.
    "gyro_bias_ramp": (
        {"ramp_deg_h_h": [-7.0, 0, 0]},
        {"c_x": -7.0 * DEGREE_PER_HOUR / 3600},
    ),
    "gyro_bias_jump": (
        {"size_deg_h": [0, 2.5, 0], "at_s": 1000},
        {"b_y": 2.5 * DEGREE_PER_HOUR},
    ),
    "gyro_warm_up": ({"start_deg_h": [0, 0, 5], "time_constant_s": 500}, {}),
    "gyro_scale_asymmetry": ({"asymmetry_ppm": [120, 0, 0]}, {"a_x": 120 * PPM}),
    "gyro_hysteresis": ({"offset_deg_h": [0, 1.5, 0]}, {"h_y": 1.5 * DEGREE_PER_HOUR}),
    "gyro_bias_sense": ({"offset_deg_h": [0, 1.5, 0]}, {"b_y": 1.5 * DEGREE_PER_HOUR}),
    "gyro_relaxation": (
        {"in_turn_deg_h": [0, 0, 0], "after_deg_h": [0, 0, 6], "time_constant_s": 12},
        {"d_z": 0.0},  # one rest after each turn: b goes with τ
    ),
    "gyro_relaxation_sense": ({"offset_deg_h": [0, 20, 0], "time_constant_s": 12}, {}),
    "gyro_relaxation_braking": ({"offset_deg_h": [20, 0, 0], "time_constant_s": 12}, {}),
    "accel_quadratic": ({"k2_micro_g_g2": [0, 200, 0]}, {"k2_y": 200e-6 / G}),
    "accel_bias_ramp": ({"ramp_m_s2_h": [0, 0, 1.0e-3]}, {"c_z": 1e-3 / 3600}),
    "accel_bias_jump": ({"size_micro_g": [60, 0, 0], "at_s": 700}, {"b_x": 60 * MICRO_G}),
    "mounting_shift": (
        {"rotation_arcsec": [0, 30, 0], "at_s": 2225},
        {"theta_y": np.radians(30 / 3600)},
    ),
    "lever_arm": ({"arm_m": [0, 0.016, 0]}, {"r_y": 0.016}),
    "table_tilt": (
        {"north_arcsec": 9, "east_arcsec": 0},
        {"north": np.radians(9 / 3600), "east": 0.0},
    ),
    "table_tilt_ramp": (
        {"north_arcsec_h": 30, "east_arcsec_h": 0},
        {"north": np.radians(30 / 3600) / 3600, "east": 0.0},
    ),
    "table_tilt_jump": (
        {"north_arcsec": 0, "east_arcsec": 30, "at_s": 1450},
        {"north": 0.0, "east": np.radians(30 / 3600)},
    ),
    "table_wobble": ({"east_arcsec": 0, "north_arcsec": 5}, {}),
}
# In the quick tests; `make test-slow` hides them all.
QUICK = ("lever_arm",)
NOT_NEEDED = ("studies", "comparison", "compensation")  # by criticism and extension
# What this plan cannot tell from it.
CLASS = {
    # Each axis is up once: what disturbs it there and nowhere else.
    "accel_quadratic": {"accel_scale_asymmetry", "accel_bias_of_position"},
    "gyro_hysteresis": {"gyro_bias_sense"},  # but for a scale factor
    "gyro_bias_sense": {"gyro_hysteresis"},
    "gyro_relaxation_sense": {"gyro_relaxation_braking"},  # likewise
    "gyro_relaxation_braking": {"gyro_relaxation_sense"},
    # That of one of the two turns about x; after the first turn of all every other one reverses.
    "gyro_scale_asymmetry": {"turn_angle_error", "table_backlash"},
    "lever_arm": {"size_effect"},
    "table_tilt": {"table_tilt_jump"},  # before the second position
}


@pytest.fixture(scope="module")
def criticised():
    """The chain up to the extension on the demo's plan with some effects hidden."""

    @cache
    def run(name: str, seed: int) -> chain.Results:
        effects = {name: HIDDEN[name][0]} if name else {}
        document = chain.demo(effects=effects, seed=seed)
        return chain.in_memory_of(document, "extension", NOT_NEEDED)

    return run


def named(results: chain.Results) -> set[str]:
    scores = results["criticism/scores"]
    return set(scores.loc[scores["named"], "effect"])


def test_the_demo_names_what_is_hidden_in_it_and_nothing_else(demo_criticised):
    assert named(demo_criticised) == {"gyro_g_sensitivity", "oscillation"}
    assert set(demo_criticised["criticism/findings"]["cause"]) == named(demo_criticised)
    effects = demo_criticised["criticism/effects"].set_index(["effect", "parameter"])
    hidden = np.diag([1.4, -1.0, 1.2]) * DEGREE_PER_HOUR / G
    for i, row in enumerate("xyz"):
        for j, column in enumerate("xyz"):
            found = effects.loc["gyro_g_sensitivity", f"g_{row}{column}"]
            assert abs(found["value"] - hidden[i, j]) < 3.5 * found["sigma"], (row, column)
    # Ten times what the plan can see: the smallest of the three is still seven times.
    assert (
        5 * effects.loc["gyro_g_sensitivity", "g_yy"]["detection_limit"] < 1.0 * DEGREE_PER_HOUR / G
    )
    ringing = effects.loc["oscillation"]
    assert abs(ringing.loc["frequency", "value"] - 20) < 3 * ringing.loc["frequency", "sigma"]
    assert abs(ringing.loc["amplitude", "value"] - 0.01) < 3 * ringing.loc["amplitude", "sigma"]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(31, 41))
def test_on_clean_data_nothing_is_named(criticised, seed):
    results = criticised("", seed)
    assert named(results) == set()
    assert results["criticism/findings"].empty
    assert results["extension/parameters"].empty


@pytest.mark.parametrize(
    "effect",
    [pytest.param(effect, marks=() if effect in QUICK else pytest.mark.slow) for effect in HIDDEN],
)
def test_what_is_hidden_is_named_alone_with_its_number(criticised, effect):
    results = criticised(effect, 51)
    (cause,) = results["criticism/findings"].to_dict("records")
    members = results["criticism/members"]
    assert set(members["finding"]) == {cause["id"]}
    assert set(members["effect"]) == {effect} | CLASS.get(effect, set())
    assert members["probability"].between(0, 1).all() and members["captured"].max() > 0.9
    assert cause["verdict"] == ("one_of_class" if effect in CLASS else "found")
    assert named(results) == {cause["cause"]} and cause["p_value"] < 1e-6
    if cause["cause"] != effect:
        return
    effects = results["criticism/effects"].set_index(["effect", "parameter"])
    for parameter, hidden in HIDDEN[effect][1].items():
        found = effects.loc[effect, parameter]
        assert abs(found["value"] - hidden) < 3.5 * found["sigma"], parameter
        if hidden:
            assert 3 < abs(hidden) / found["detection_limit"] < 30


@pytest.mark.slow
def test_a_time_at_which_nothing_shows_an_effect_is_uncertain():
    """A rotation about y while y is vertical: accelerometers show it in the next position."""
    shift = {"rotation_arcsec": [0, 30, 0], "at_s": 1250}
    document = chain.demo(seed=6, effects={"mounting_shift": shift})
    effects = chain.in_memory_of(document, "criticism", NOT_NEEDED)["criticism/effects"]
    found = effects.set_index(["effect", "parameter"]).loc["mounting_shift"]
    truth = {"theta_x": 0.0, "theta_y": np.radians(30 / 3600), "t0": 1250.0}
    for parameter, value in truth.items():
        assert abs(found.loc[parameter, "value"] - value) < 3 * found.loc[parameter, "sigma"]
    assert 50 < found.loc["t0", "sigma"] < 250  # of 360 s, evenly: 104 s


@pytest.mark.slow
def test_the_manoeuvre_that_splits_a_class_is_named(criticised):
    """With positions up, down and level only, the square and the size of the force are one."""
    (cause,) = criticised("accel_quadratic", 51)["criticism/findings"].to_dict("records")
    assert "45°" in cause["split_manoeuvre"] and cause["split_snr"] > 10
    assert cause["split_manoeuvre"] in cause["action"]
    (cause,) = criticised("lever_arm", 51)["criticism/findings"].to_dict("records")
    assert cause["split_snr"] < 3.3 and "No further manoeuvre" in cause["action"]


@pytest.mark.slow
def test_a_jump_is_told_with_its_time(criticised):
    results = criticised("gyro_bias_jump", 51)
    effects = results["criticism/effects"].set_index(["effect", "parameter"])
    time = effects.loc["gyro_bias_jump", "t0"]
    assert abs(time["value"] - 1000) < 4 * time["sigma"] + 15  # s; most of it lies within a rest
    extended = results["extension/parameters"].set_index("parameter")
    assert extended.loc["gyro_bias_jump.b_y", "value"] == pytest.approx(
        2.5 * DEGREE_PER_HOUR, rel=0.1
    )


def test_what_this_plan_cannot_see_is_said_with_the_reason(demo_criticised):
    told = demo_criticised["criticism/detection_limits"].set_index(["effect", "parameter"])
    sought = {name for name, e in CATALOGUE.items() if e.sought_in in ("blocks", "spectrum")}
    of_gap = {"gyro_restarts", "accel_restarts"}  # the recording has one
    assert set(told.index.get_level_values(0)) == sought | of_gap
    assert (told["limit"].notna() == (told["reason"] == "visible")).all()
    for effect, words in {
        "gyro_bias_temperature": "no temperature is recorded",
        "gyro_scale_cubic": "cannot be separated",
        "table_speed_error": "it is absorbed by the angle of the table",
        "heading_error": "no heading",
    }.items():
        rows = told.loc[effect]
        assert rows["limit"].isna().all() and rows["sentence"].str.contains(words).all(), effect


def test_why_an_effect_is_not_named_is_true(demo_criticised):
    told = demo_criticised["criticism/scores"].set_index("effect")["sentence"]
    # The g-sensitivity that is named does what the other hemisphere would do; by itself it is seen.
    # A wrong latitude changes the horizontal rate, too, whose size the gyros show.
    assert "beside the named effects" in told["latitude_sign"]
    assert "not significant" in told["latitude_error"]
    # One rate alone: the scale factor does the same.
    assert "cannot be separated here from the parameters" in told["gyro_scale_cubic"]
    assert "scale factors of the accelerometers" in told["gravity_error"]
    assert not told.str.contains("No manoeuvre excites it").any()


@pytest.mark.slow
def test_a_random_walk_is_no_ramp_and_no_g_sensitivity():
    document = chain.demo(seed=61)
    document["noise"] = {**document["noise"], "gyro_rate_random_walk_deg_h_sqrt_h": 0.5}
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    assert named(results) == {"gyro_random_walk"}
    (finding,) = results["criticism/findings"].to_dict("records")
    assert finding["cause"] == "gyro_random_walk" and finding["severity"] == 1
    walk = results["criticism/scores"].set_index("effect").loc["gyro_random_walk", "sentence"]
    assert "random walk of 0." in walk and "°/h/√h" in walk


@pytest.mark.slow
def test_an_oscillation_that_beats_with_the_blocks_is_no_structure():
    """39.6 Hz is 7.9 periods in a block of 0.2 s: what is left of it beats at 2 Hz."""
    ringing = {"frequency_hz": 39.567, "amplitude_rad_s": 0.0038, "axis": "+y"}
    document = chain.demo(effects={"oscillation": ringing}, seed=17)
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    assert results["criticism/findings"]["cause"].tolist() == ["oscillation"]
    assert not results["criticism/structures"]["detected"].any()

"""Sessions by hand from the simulated laboratory: what they hide is named, and nothing else."""

import shutil
from collections.abc import Callable
from functools import cache

import by_hand_campaigns as sessions
import chain
import numpy as np
import pytest
from ruamel.yaml import YAML

from inertial.estimation.triad import linear_names

CLEAN = range(20)
FLICKER = 40.0  # °/h, B of the gyros
# Sizes of a consumer IMU, as data sheets and the table of the design study have them.
HIDDEN = {
    "gyro_g_sensitivity": {"matrix_deg_h_g": [[60, 0, 0], [-100, 0, 0], [0, 0, 80]]},
    "gyro_bias_ramp": {"ramp_deg_h_h": [2000, 0, -1500]},
    "gyro_bias_jump": {"size_deg_h": [0, 90, 0], "at_s": 100},
    "accel_quadratic": {"k2_micro_g_g2": [3000, 0, -2000]},
    "accel_cubic": {"k3_micro_g_g3": [3000, 0, -2000]},
    "accel_bias_ramp": {"ramp_m_s2_h": [0.8, 0, 0]},
    "accel_bias_jump": {"size_micro_g": [0, 3000, 0], "at_s": 110},
}


def pulls(document, results) -> dict[str, np.ndarray]:
    """Errors of the twelve parameters of each sensor that counts, in their sigma."""
    truth, table = sessions.truth(document), results["diagnosis/result"]
    found = {}
    for sensor, told in truth.items():
        own = table[(table["sensor"] == sensor) & table["effect"].isna()]
        own = own.set_index("parameter").reindex(linear_names())
        found[sensor] = (own["value"].to_numpy(float) - told) / own["sigma"].to_numpy(float)
    return found


@pytest.fixture(scope="module")
def clean(tmp_path_factory) -> list[tuple[dict, chain.Results]]:
    drawn = []
    for seed in CLEAN:
        document = sessions.session(seed)
        folder = tmp_path_factory.mktemp("clean")
        drawn.append((document, sessions.by_hand(document, folder)))
    return drawn


@pytest.fixture(scope="module")
def hiding(tmp_path_factory) -> Callable[[str], tuple[dict, chain.Results]]:
    """By the name of an effect a session that hides it; each is recorded and run once."""

    @cache
    def run(effect: str) -> tuple[dict, chain.Results]:
        document = sessions.session(1, effects={effect: HIDDEN[effect]})
        return document, sessions.by_hand(document, tmp_path_factory.mktemp(effect))

    return run


@pytest.mark.slow
def test_a_clean_session_is_silent(clean):
    for _, results in clean:
        assert results["criticism/findings"].empty
        assert results["diagnosis/causes"].empty
        assert set(results["diagnosis/verdict"]["verdict"]) == {"usable"}
        assert results["criticism/scores"]["statistic"].notna().any()  # it was tested


@pytest.mark.slow
def test_the_sigmas_of_a_clean_session_are_honest(clean):
    for sensor in ("accel", "gyro"):
        every = np.array([pulls(*drawn)[sensor] for drawn in clean])
        assert every.shape == (len(CLEAN), 12) and np.isfinite(every).all()
        # The 240 are not independent: P is symmetric, and all share the directions.
        assert np.sqrt(np.mean(every**2)) == pytest.approx(1, abs=0.2)
        assert np.abs(every).max() < 4.5


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_a_bias_instability_that_the_data_sheet_states_is_no_cause(seed, tmp_path):
    """It was a random walk or a jump in every third session. Stated is the Allan deviation."""
    flicker = {"gyro_flicker": {"instability_deg_h": FLICKER}}
    document = sessions.session(seed, effects=flicker)
    results = sessions.by_hand(document, tmp_path, "diagnosis", 0.664 * FLICKER)
    assert results["diagnosis/causes"].empty


@pytest.mark.parametrize(
    "seed", [7, *(pytest.param(n, marks=pytest.mark.slow) for n in (6, 9, 11))]
)
def test_a_bias_instability_that_the_rests_show_is_no_cause(seed, tmp_path):
    """Without a data sheet it was a random walk or a jump in eight of twelve sessions."""
    flicker = {"gyro_flicker": {"instability_deg_h": FLICKER}}
    document = sessions.session(seed, effects=flicker)
    results = sessions.by_hand(document, tmp_path, "diagnosis")
    assert results["diagnosis/causes"].empty
    assert np.abs(pulls(document, results)["gyro"][:9]).max() < 4.5


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_a_random_walk_that_is_named_is_in_the_sigmas_of_the_result(seed, tmp_path):
    """Of 400 °/h/√h: 100 °/h in the session, while each rest shows its own bias to 10 °/h."""
    noise = sessions.CONSUMER | {"gyro_rate_random_walk_deg_h_sqrt_h": 400}
    document = sessions.session(seed) | {"noise": noise}
    results = sessions.by_hand(document, tmp_path, "diagnosis")
    assert "gyro_random_walk" in set(results["criticism/findings"]["cause"])
    (walk,) = results["criticism/random_walks"]["value"]
    assert walk == pytest.approx(np.radians(400) / 3600 / 60, rel=0.5)
    fit = results["extension/fit"].set_index(["sensor", "method"])
    assert fit.loc[("gyro", "joint"), "random_walk"] == walk
    plain = results["gyroscope/parameters"].set_index(["method", "parameter"])["sigma"]
    own = results["diagnosis/result"].query("sensor == 'gyro'").set_index("parameter")
    assert set(own["method"]) == {"free_positions"}
    for axis in "xyz":
        assert own.loc[f"bias_{axis}", "sigma"] > 2 * plain["free_positions", f"bias_{axis}"]
    matrix = pulls(document, results)["gyro"][:9]
    assert np.abs(matrix).max() < 4.5


@pytest.mark.slow
@pytest.mark.parametrize(
    "effect",
    list(HIDDEN),
)
def test_what_a_session_hides_is_named_and_no_longer_moves_the_result(effect, hiding):
    document, results = hiding(effect)
    (cause,) = results["criticism/findings"].to_dict("records")
    members = results["criticism/members"]
    assert cause["verdict"] in ("found", "one_of_class")
    assert effect in {cause["cause"], *members["effect"]}
    assert set(results["diagnosis/verdict"]["verdict"]) == {"usable", "usable_within_limits"}
    for own in pulls(document, results).values():
        assert np.abs(own).max() < 4.5


@pytest.mark.slow
def test_the_g_sensitivity_has_the_size_that_was_hidden(hiding):
    _, results = hiding("gyro_g_sensitivity")
    table = results["diagnosis/result"]
    own = table[table["effect"] == "gyro_g_sensitivity"]
    g = np.radians(1 / 3600) / 9.80665  # rad/s per m/s² in °/h per g
    truth = g * np.array(HIDDEN["gyro_g_sensitivity"]["matrix_deg_h_g"]).ravel()
    assert list(own["parameter"].str[-2:]) == [a + b for a in "xyz" for b in "xyz"]
    assert np.abs((own["value"] - truth) / own["sigma"]).max() < 3.5
    checks = results["compensation/checks"].query("quantity == 'gravity'")
    assert len(checks) == 24 and checks["in_sigmas_after"].abs().max() < 4


@pytest.mark.slow
def test_gyros_of_another_count_size_are_a_finding_and_stay_usable(tmp_path):
    document = sessions.session(3)
    matrix = 0.765 * np.array(document["truth"]["gyro"]["matrix"])
    document["truth"]["gyro"]["matrix"] = matrix.tolist()
    results = sessions.by_hand(document, tmp_path, "diagnosis")
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "gyro_count_size" and cause["cure"] == "modelled"
    assert cause["size"] == pytest.approx(np.mean(np.diag(matrix)), abs=1e-3)
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["gyro"] == "usable_within_limits" and verdicts["accel"] == "usable"
    assert np.abs(pulls(document, results)["gyro"]).max() < 4


@pytest.mark.slow
def test_one_gyro_of_another_scale_factor_is_no_count_size(tmp_path):
    """It said to multiply the counts of all three, of which two read right, by 0.94."""
    document = sessions.session(3)
    matrix = np.diag([1.0, 0.94, 1.0]) @ document["truth"]["gyro"]["matrix"]
    document["truth"]["gyro"]["matrix"] = matrix.tolist()
    results = sessions.by_hand(document, tmp_path, "diagnosis")
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "gyro_scale_of_axes" and cause["axis"] == "y"
    assert cause["size"] == pytest.approx(matrix[1, 1], abs=1e-3)
    assert "Multiply" not in cause["action"]
    assert np.abs(pulls(document, results)["gyro"]).max() < 4


def crooked(seed: int, rests: int, **effects: object) -> dict:
    """A session of so many rests, of accelerometers with errors of 2.5 % in scale and alignment."""
    document = sessions.session(seed, effects=effects)
    document["campaign"]["plan"] = document["campaign"]["plan"][:rests]
    askew = 0.025 * np.random.default_rng(seed + 100).standard_normal((3, 3))
    document["truth"]["accelerometer"]["matrix"] = (np.eye(3) + askew).tolist()
    return document


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_quadratic_term_is_no_scatter_of_eighteen_rests(tmp_path, seed):
    document = crooked(seed, 18, accel_quadratic={"k2_micro_g_g2": [0, 3000, 0]})
    results = sessions.by_hand(document, tmp_path, "diagnosis")
    (cause,) = results["diagnosis/causes"].to_dict("records")
    # Eighteen rests do not tell it from a scale factor asymmetry of the same axis: both are named.
    assert cause["cause"] in ("accel_quadratic", "accel_scale_asymmetry") and cause["axis"] == "y"
    members = results["criticism/members"]["effect"].tolist()
    assert "accel_quadratic" in (members[:2] or [cause["cause"]])
    parameters = results["extension/parameters"].set_index("parameter")["value"]
    assert parameters["accel_quadratic.k2_y"] * 9.80665 == pytest.approx(3e-3, abs=5e-4)
    assert np.abs(pulls(document, results)["accel"]).max() < 4


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "verdict"), [(2, "not_usable"), (3, "usable_within_limits")])
def test_a_scatter_that_nothing_explains_is_a_finding(tmp_path, seed, verdict):
    """Three degrees of freedom are too few for a name; biases were off by 9 sigma in silence."""
    document = crooked(seed, 12, accel_quadratic={"k2_micro_g_g2": [0, 4000, 0]})
    results = sessions.by_hand(document, tmp_path, "diagnosis")
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "rest_scatter" and cause["sensor"] == "accel"
    # What 4 mg of the square of a direction leave beside nine parameters: less than all of it.
    assert 3 * 9e-4 < cause["size"] < 4e-3 * 9.80665
    assert results["diagnosis/verdict"].set_index("sensor")["verdict"]["accel"] == verdict


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_crooked_accelerometers_alone_are_silent(tmp_path, seed):
    results = sessions.by_hand(crooked(seed, 18), tmp_path, "diagnosis")
    assert results["diagnosis/causes"].empty
    assert set(results["diagnosis/verdict"]["verdict"]) == {"usable"}


@pytest.mark.slow
def test_degrees_that_are_stated_as_radians_are_told_by_what_no_hand_turns(tmp_path):
    """They were a count size to be multiplied by 1.64, with a result that was right for it."""
    document = sessions.session(3)
    matrix = np.degrees(1.0) * np.array(document["truth"]["gyro"]["matrix"])
    document["truth"]["gyro"]["matrix"] = matrix.tolist()
    results = sessions.by_hand(document, tmp_path, "diagnosis")
    causes = results["diagnosis/causes"].set_index("cause")
    assert set(causes["sensor"]) == {"gyro"} and "gyro_count_size" not in causes.index
    assert "no hand turns an IMU so fast" in causes.loc["wrong_scale_factor", "sentence"]
    assert causes.loc["wrong_scale_factor", "cure"] == "none"
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["gyro"] == "not_usable" and verdicts["accel"] == "usable"


@pytest.mark.slow
def test_what_no_session_by_hand_can_show_has_one_reason(hiding):
    limits = hiding("gyro_g_sensitivity")[1]["criticism/detection_limits"]
    of_tables = limits[limits["effect"].str.startswith(("table_tilt", "table_wobble"))]
    assert set(of_tables["explanation"]) == {"no table takes part in a session by hand"}


@pytest.mark.slow
def test_two_runs_by_hand_are_calibrated_each_alone(tmp_path):
    """The biases of the second are others, by 0.2 °/s and 2 mg: together they are no one result."""
    logs = {}
    for run, moved in enumerate((0.0, 1.0)):
        document = sessions.session(7)  # the same IMU, a quarter of an hour later
        document |= {"seed": 7 + run, "start": dict(document["start"])}
        document["start"]["gps_second"] += 900 * run
        document["truth"]["gyro"]["bias_rad_s"][1] += moved * np.radians(0.2)
        document["truth"]["accelerometer"]["bias_m_s2"][0] += moved * 0.02
        results = sessions.by_hand(document, tmp_path / f"run-{run}")
        assert set(results["diagnosis/verdict"]["verdict"]) <= {"usable", "usable_within_limits"}
        for sensor, pull in pulls(document, results).items():
            assert np.sqrt(np.mean(pull**2)) < 1.8, sensor
        logs[f"run-{run}.asc"] = tmp_path / f"run-{run}" / "campaign" / sessions.LOG
    both = tmp_path / "both"
    shutil.copytree(tmp_path / "run-0" / "campaign", both)
    (both / sessions.LOG).unlink()
    for name, path in logs.items():
        shutil.copy(path, both / name)
    file = both / "campaign.yaml"
    stated = YAML(typ="safe").load(file)
    stated["plan"] = [
        {"id": name[:5], "do": "positions", "seconds": 2, "log": name, "power_cycle": i > 0}
        for i, name in enumerate(logs)
    ]
    YAML().dump(stated, file)
    causes = chain.run(both, tmp_path / "derived", "diagnosis")["diagnosis/causes"]
    own = causes[causes["cause"].str.contains("per_log|restarts|jump")]
    assert set(own["sensor"]) == {"gyro", "accel"}
    assert own["action"].str.contains("make a campaign").all()

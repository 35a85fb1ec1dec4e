"""Real sessions by hand, each through the draft of its campaign and the whole chain."""

import chain
import numpy as np
import pytest
from recordings.known import RECORDINGS
from scipy.io import loadmat

from inertial.estimation.triad import linear_names

BY_NAME = {recording.name: recording for recording in RECORDINGS}
EFFECTS = ("found", "one_of_class")


def named(results: chain.Results) -> set[str]:
    findings = results["criticism/findings"]
    return set(findings[findings["verdict"].isin(EFFECTS)]["cause"])


def of_sensor(results: chain.Results, sensor: str, column: str = "value") -> np.ndarray:
    table = results["diagnosis/result"]
    own = table[(table["sensor"] == sensor) & table["effect"].isna()].set_index("parameter")
    return own[column].reindex(linear_names()).to_numpy(float)


def usable(results: chain.Results, sensor: str) -> bool:
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    return verdicts[sensor] in ("usable", "usable_within_limits", "on_condition")


# ---- imu_tk: Xsens MTi, 38 positions


def test_imu_tk_has_a_g_sensitivity_by_name(recorded):
    results = recorded("imu-tk")
    # Its rests scatter by 0.12 mg, 3.6 times their noise, as a hand may make them.
    assert named(results) == {"gyro_g_sensitivity", "rest_scatter"}
    assert usable(results, "gyro")
    table = results["diagnosis/result"]
    effect = table[table["effect"] == "gyro_g_sensitivity"]["value"].to_numpy(float)
    sigma = table[table["effect"] == "gyro_g_sensitivity"]["sigma"].to_numpy(float).reshape(3, 3)
    matrix = np.eye(3) + of_sensor(results, "gyro")[:9].reshape(3, 3)
    # Of readings, in rad/s per m/s²; of rates, at the scale that the session itself gives.
    own = np.degrees(np.linalg.solve(matrix, effect.reshape(3, 3))) * 9.80665
    assert np.unravel_index(np.argmax(np.abs(own)), (3, 3)) == (1, 0)
    assert own[1, 0] == pytest.approx(-0.155, abs=0.02)  # °/s per g, SOURCE.md
    assert np.degrees(sigma[1, 0]) * 9.80665 < 0.01


def test_imu_tk_gyros_have_another_count_size_than_stated(recorded):
    results = recorded("imu-tk")
    causes = results["diagnosis/causes"].set_index("cause")
    # −23.5 % against the start value of the authors' search, 6258 counts per rad/s.
    assert causes.loc["gyro_count_size", "size"] == pytest.approx(0.764, abs=0.005)
    assert causes.loc["gyro_count_size", "cure"] == "modelled"


def test_imu_tk_accelerometers_are_those_that_its_source_knows(recorded):
    results = recorded("imu-tk")
    value, sigma = (of_sensor(results, "accel", of) for of in ("value", "sigma"))
    counts = 414 * (1 + value[[0, 4, 8]])
    assert np.abs(counts - [414.46, 412.01, 414.65]).max() < 3 * 414 * sigma[[0, 4, 8]].max()
    biases = 32768 + 414 * value[9:]
    assert np.abs((biases - [33123.9, 33275.2, 32364.5]) / (414 * sigma[9:])).max() < 3


# ---- gesture: nine-axis MEMS, 40 positions


@pytest.mark.slow
def test_gesture_names_no_effect_though_all_are_tested(drafted):
    """The means of its gyros at rest depend neither on time nor on force, by a law: SOURCE.md."""
    _, results = drafted("gesture")
    assert named(results) == set()
    scores = results["criticism/scores"].set_index("effect")
    for effect in ("gyro_g_sensitivity", "gyro_bias_jump", "accel_quadratic"):
        assert scores.loc[effect, "p_value"] > 1e-3 and scores.loc[effect, "degrees"] > 0
    assert usable(results, "gyro") and usable(results, "accel")
    causes = set(results["diagnosis/causes"]["cause"])
    assert not causes & {"gravity_error", "wrong_scale_factor"}


@pytest.mark.slow
def test_gesture_rest_that_shakes_at_49_hz_is_left_out(drafted, recordings):
    """At 255 s gyro x reads 0.135 °/s more, the accelerometers stand still, and all shake."""
    _, results = drafted("gesture")
    left = results["gyroscope/fit_manoeuvres"].query("~used and phase == 'rest'")
    log = loadmat(recordings / "gesture_multipos/caldata.mat")["cal_data"]
    shaken = (log[:, 0] > 253) & (log[:, 0] < 260.5)
    astray = np.median(log[shaken, 4]) - np.median(log[log[:, 0] < 50, 4])
    assert astray / 16.4 == pytest.approx(0.135, abs=0.1)  # °/s
    assert len(left) in (1, 2)


# ---- mikoff: five MPU-9150 by hand; published without sigma


@pytest.mark.parametrize(
    "number", [*(pytest.param(n, marks=pytest.mark.slow) for n in (1, 2, 3, 5)), 4]
)
def test_mikoff_accelerometers_agree_with_the_published_ones(drafted, number):
    _, results = drafted(f"mikoff-{number}")
    assert named(results) == set() and usable(results, "accel")
    bias, scale = (known.values for known in BY_NAME[f"mikoff-{number}"].known)
    value = of_sensor(results, "accel")
    # Theirs are rounded to 0.001 m/s² and 0.001 %, and 9.81 m/s² is not their gravity.
    assert np.abs(value[9:] - bias).max() < 2e-3
    assert np.abs(100 * value[[0, 4, 8]] - scale).max() < 0.02


def test_mikoff_4_has_an_impact_and_nothing_reversed(drafted):
    """Its SOURCE.md: a knock of many g, and nothing is exchanged or reversed."""
    _, results = drafted("mikoff-4")
    causes = set(results["diagnosis/causes"]["cause"])
    assert "impact" in causes
    assert not causes & {"sign_flip", "axis_swap", "wrong_scale_factor"}


# ---- snu: one IMU, twice


@pytest.mark.slow
def test_two_sessions_of_one_imu_agree(drafted):
    (_, first), (_, second) = drafted("snu-2"), drafted("snu-3")
    for sensor in ("accel", "gyro"):
        values = [of_sensor(results, sensor) for results in (first, second)]
        sigmas = [of_sensor(results, sensor, "sigma") for results in (first, second)]
        both = np.hypot(*sigmas)
        assert np.isfinite(both).sum() >= 10
        # Gravity is common to both and counts twice here, which only widens the sigma.
        assert np.nanmax(np.abs(values[0] - values[1]) / both) < 3
        assert named(first) == named(second) == set()

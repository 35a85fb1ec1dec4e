"""The extended model: the parameters come back, and it foretells what it has not seen."""

import numpy as np
from test_closure import truth_of


def test_the_parameters_that_the_effect_had_spoiled_come_back(demo_criticised):
    table = demo_criticised["extension/parameters"].set_index(["method", "parameter"])
    for stage in ("gyroscope", "accelerometer"):
        truth = truth_of(stage)
        rows = table.loc[stage].loc[list(truth)]
        pulls = (rows["value"] - list(truth.values())) / rows["sigma"]
        assert np.abs(pulls).max() < 4
    joint = demo_criticised.parameters("gyroscope")
    # Sigmas of noise alone again: the scatter that covered the effect is gone.
    assert table.loc[("gyroscope", "scale_x"), "sigma"] < joint.loc["scale_x", "sigma"] / 3


def test_the_gain_is_there_on_data_that_the_fit_has_not_seen(demo_criticised):
    gain = demo_criticised["extension/gain"].set_index(["sensor", "scope"])
    assert "accel" not in gain.index.get_level_values(0)  # it shows nothing of either effect
    fitted, held_out = gain.loc[("gyro", "fitted")], gain.loc[("gyro", "held-out")]
    assert fitted["drop"] > 1000 and held_out["drop"] > 1000
    assert fitted["rms_after"] < 1.1 < fitted["rms_before"]
    assert held_out["rms_after"] < 1.1 < held_out["rms_before"]
    ringing = gain.loc[("gyro x", "held-out")]
    assert ringing["rms_after"] < 0.02 * ringing["rms_before"]
    assert ringing["rms_after"] < 4e-5  # rad/s: the white noise of a sample, 3.5e-5


def test_covariance_and_parameters_agree(demo_criticised):
    table = demo_criticised["extension/parameters"].set_index("id")
    covariance = demo_criticised["extension/covariance"]
    own = covariance[covariance["first"] == covariance["second"]].set_index("first")["covariance"]
    np.testing.assert_allclose(np.sqrt(own[table.index]), table["sigma"], rtol=1e-9)

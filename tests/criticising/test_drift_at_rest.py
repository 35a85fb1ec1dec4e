"""The drift that the noise at rest shows goes on between the rests, and is no effect there."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import chain
import numpy as np
import pytest

from inertial.estimation.random_walk import NO_DRIFT
from inertial.estimation.triad import linear_names
from stages.criticism import drift_at_rest

CLEAR = ("found", "one_of_class")
MOST = 4.0  # sigma, of the largest of nine errors


def criticised(effects: dict[str, Any]) -> tuple[dict[str, Any], Any]:
    document = chain.demo(seed=2711, effects=effects)
    document["campaign"]["table"] |= {"angle_sigma_arcsec": 0.01}  # the simulated table is exact
    return document, chain.in_memory_of(document, "criticism", chain.BESIDE)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("sensor", "effects", "stage", "truth"),
    [
        pytest.param(
            "accel",
            {"accel_flicker": {"instability_micro_g": 50}},
            "accelerometer",
            "accelerometer",
        ),
        ("gyro", {"gyro_flicker": {"instability_deg_h": 5}}, "gyroscope", "gyro"),
    ],
)
def test_bias_instability_is_no_effect_and_no_structure(
    sensor: str, effects: dict[str, Any], stage: str, truth: str
) -> None:
    """Once "not noise, they drift smoothly with time", p < 10⁻¹², and gyros 3 sigma rms off.

    Of the turns, too: there it goes about its mean, as fast as the table turns.
    """
    document, results = criticised(effects)
    assert results["criticism/drifts_at_rest"].values.tolist() == [["", sensor, True]]
    assert not results["criticism/findings"]["verdict"].isin(CLEAR).any()
    assert not results["criticism/structures"]["detected"].any()
    table = results.parameters(stage, "joint")
    true = (np.array(document["truth"][truth]["matrix"]) - np.eye(3)).ravel()
    own = table.loc[list(linear_names())[:9]]
    errors = (own["value"].to_numpy(float) - true) / own["sigma"].to_numpy(float)
    assert np.abs(errors).max() < MOST


@pytest.mark.slow
def test_bias_instability_that_shows_most_in_two_manoeuvres_stays_in_the_equations() -> None:
    """Without it x changes by p = 4 × 10⁻⁸, and with two of twelve left out no test detects it."""
    document = chain.demo(seed=29, effects={"accel_flicker": {"instability_micro_g": 40}})
    document["noise"]["velocity_random_walk_m_s_sqrt_h"] = 0.07
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    assert results["criticism/drifts_at_rest"].values.tolist() == [["", "accel", True]]
    assert results["criticism/findings"].empty


@pytest.mark.slow
def test_a_jump_within_a_rest_is_no_drift_there() -> None:
    jump = {"size_deg_h": [12, -9, 10], "at_s": 1000}
    _, results = criticised({"gyro_bias_jump": jump})
    assert results["noise/terms"].groupby("channel")["stepped"].any().loc["gyro_x":"gyro_z"].all()
    assert results["criticism/drifts_at_rest"].empty
    (found,) = results["criticism/findings"].to_dict("records")
    assert (found["cause"], found["verdict"]) == ("gyro_bias_jump", "found")
    (at,) = results["criticism/effects"].query("parameter == 't0'").to_dict("records")
    assert at["value"] == pytest.approx(1000, abs=4 * at["sigma"])
    (walk,) = results["criticism/scores"].query("effect == 'gyro_random_walk'").to_dict("records")
    assert not walk["named"]
    assert (
        walk["sentence"]
        == "Not detected; section “Noise” states what the static positions show (K)."
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 4])
def test_beside_a_jump_within_a_rest_the_flicker_of_the_data_sheet_is_no_structure(seed) -> None:
    """y jumps; x and z have 20 µg of the 30 stated, which went with the walk that y shows there."""
    effects = {
        "accel_flicker": {"instability_micro_g": 20},
        "accel_bias_jump": {"size_micro_g": [0, 400, 0], "at_s": 900},
    }
    document = chain.demo(seed=seed, effects=effects)
    document["noise"]["velocity_random_walk_m_s_sqrt_h"] = 0.07
    receiver = document["receiver"]
    document["campaign"]["instrument"] = {
        "name": "made up",
        "rate_hz": 100,
        "axes": ["z", "-y", "x"],
        "format": {"kind": "rawimus"},
        "gyro": {"count_rad": receiver["gyro_count_rad"]},
        "accelerometer": {
            "count_m_s": receiver["accelerometer_count_m_s"],
            "bias_instability_ug": 30.0,
            "source": "made up",
        },
    }
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    (finding,) = results["criticism/findings"].to_dict("records")
    assert (finding["cause"], finding["verdict"]) == ("accel_bias_jump", "found")
    jump = results["criticism/effects"].set_index(["effect", "parameter"]).loc["accel_bias_jump"]
    assert jump.loc["b_y", "value"] == pytest.approx(
        400e-6 * 9.80665, abs=4 * jump.loc["b_y", "sigma"]
    )


@pytest.mark.parametrize(
    ("left", "expected", "kept"),
    [(("time",), False, True), ((), False, False), ((), True, True)],
)
def test_no_drift_is_replaced_by_effects_that_leave_a_structure_or_if_it_is_expected(
    monkeypatch, left, expected, kept
):
    """Of a flicker of 30 µg in a clean campaign: a jump, a shift and "no noise", odds of e⁴."""

    def chosen(log_evidence: float) -> Any:
        evidence = SimpleNamespace(sensors=("accel",))
        return SimpleNamespace(
            log_evidence=log_evidence, effects=(), evidence=evidence, fitted=(), alternatives=()
        )

    def tested(structures: tuple[str, ...]) -> Any:
        return SimpleNamespace(of=lambda sensor: structures)

    monkeypatch.setattr(drift_at_rest, "carrying", lambda tested, sensor: ())
    monkeypatch.setattr(drift_at_rest, "members_of", lambda selection: ())
    monkeypatch.setattr(drift_at_rest, "replace", lambda selection, **changes: selection)
    without = SimpleNamespace(name="without")
    measured = SimpleNamespace(
        name="with",
        drifts={"gyro": NO_DRIFT, "accel": replace(NO_DRIFT, walk=np.ones(3), expected=expected)},
        without_drift_at_rest=lambda sensors: without,
    )
    outcomes = {"with": (chosen(0.0), tested(())), "without": (chosen(4.0), tested(left))}
    *_, campaign = drift_at_rest.select_beside_drift(
        measured, lambda campaign: outcomes[campaign.name], 0.005
    )
    assert (campaign is measured) == kept

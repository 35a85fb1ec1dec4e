"""S3: one continuous log, twelve turns, motion between the positions; everything by the plan."""

import chain
import numpy as np
import pytest
from test_closure import pulls


@pytest.fixture(scope="module")
def session(tmp_path_factory) -> chain.Results:
    """Six positions; from each a turn there and back, z up at 30 °/s and z down at 60 °/s."""
    document = chain.demo(seed=7)
    document["handling"] = {"still_s": 3, "change_s": 12}
    plan = []
    for axis in "zxy":
        for way, sign, rate in (("up", "+", 30), ("down", "-", 60)):
            name, common = f"{axis}-{way}", {"up": sign + axis, "position": f"{axis}-{way}"}
            turn = {"do": "turn", "rate_deg_s": rate, "accel_deg_s2": rate}
            plan += [
                {"id": f"{name}-before", "do": "rest", "seconds": 20 + len(plan)} | common,
                {"id": f"{name}-forward", "degrees": 360} | turn | common,
                {"id": f"{name}-back", "degrees": -360} | turn | common,
                {"id": f"{name}-after", "do": "rest", "seconds": 20} | common,
            ]
    document["campaign"]["plan"] = plan
    document["campaign"]["log"] = "session.asc"
    folder = tmp_path_factory.mktemp("session")
    # The plan tells pauses that are not those of the table.
    campaign = chain.simulate(document, folder / "campaign")
    file = campaign / "campaign.yaml"
    file.write_text(file.read_text().replace("seconds: 20,", "seconds: 26,"))
    return chain.run(campaign, folder / "derived", "criticism")


def test_all_of_it_is_found_from_the_plan(session):
    performed = session["segment/performed"].set_index("manoeuvre")
    assert len(performed) == 24 and performed["complete"].all()
    angles = np.degrees(performed["angle"].dropna())
    np.testing.assert_allclose(angles.abs(), 360, atol=1)
    assert session["quality/findings"].empty
    assert session["segment/findings"].empty


@pytest.mark.parametrize(
    ("stage", "method", "parameters"),
    [
        ("accelerometer", "joint", 12),
        ("accelerometer", "pooled_positions", 12),
        ("gyroscope", "joint", 12),
        ("gyroscope", "turn_and_stop", 12),
        ("gyroscope", "stops", 3),
    ],
)
def test_the_truth_comes_back_by_the_joint_estimate_and_by_the_formulas(
    session, stage, method, parameters
):
    found = pulls(session, stage, method)
    assert len(found) == parameters
    assert np.abs(found).max() < 4
    assert np.sqrt(np.mean(found**2)) < 1.6


def test_a_set_position_is_wrong_by_as_much_in_all_its_turns(session):
    """Each cross-axis term rests on two positions, each off by 2 arcsec: 2/√2 arcsec at best."""
    for method in ("joint", "turn_and_stop"):
        sigmas = session.parameters("gyroscope", method)["sigma"]
        crosses = sigmas[sigmas.index.str.startswith("cross_")] / (np.pi / 180 / 3600)
        assert len(crosses) == 6
        assert ((crosses > 2 / np.sqrt(2)) & (crosses < 1.6)).all()


def test_the_joint_estimate_costs_no_more_than_the_formulas(session):
    for stage, methods in {
        "accelerometer": ["pooled_positions"],
        "gyroscope": ["turn_and_stop", "stops"],
    }.items():
        joint = session.parameters(stage)["sigma"]
        for method in methods:
            other = session.parameters(stage, method)["sigma"].dropna()
            assert (joint[other.index] < 1.001 * other).all(), method
    # In the stops the level earth rate, of unknown azimuth, is read as bias; turns average it out.
    by_stops = session.parameters("gyroscope", "stops").loc["bias_x", "sigma"]
    assert by_stops > 2 * session.parameters("gyroscope", "turn_and_stop").loc["bias_x", "sigma"]


def test_the_methods_agree(session):
    told = session["comparison/differences"]
    assert not told["sentence"].str.contains(": more than chance").any()
    assert {"turn_and_stop", "stops", "pooled_positions"} <= {
        one.rpartition("/")[2] for one in told["id"]
    }
    assert set(told["sensor"]) == {"accel", "gyro"}


def test_the_same_rate_with_the_axis_down_is_advised_with_its_gain(session):
    """S3 turns up at one rate and down at another: what goes with the rate or with the force?"""
    told = session["criticism/detection_limits"].set_index("effect")["sentence"]
    (advice,) = (one for one in told["gyro_scale_g_dependence"] if "turn also" in one)
    assert "turn also at the same rate with the axis down, and it is 0 %" in advice
    assert session["criticism/findings"].empty

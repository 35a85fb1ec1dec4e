"""What a turn with a gap is worth: bridged, by an assumed angle, and to the criticism."""

from dataclasses import replace
from math import degrees, radians

import chain
import numpy as np
import pytest
from z_turns import ANGLE, NOISE, Z_SCALE, inputs_of, lose

from inertial.campaign.observations import campaign_of
from inertial.estimation.gyroscope_observations import RateSegment, WholeTurn
from inertial.estimation.gyroscopes import bias_and_scale, joint
from inertial.estimation.triad import errors_of, linear_names


def test_an_assumed_angle_is_wrong_by_far_more_than_its_sigma(gapped):
    """S0's 360° of which a third is missing, and its 240° for what are 240.30°."""
    truth = chain.demo()["truth"]["gyro"]
    scale, bias = truth["matrix"][2][2] - 1, truth["bias_rad_s"][2]
    inputs = inputs_of(gapped)
    forward, backward = inputs.recorded
    sums = [float(r.blocks.gyro[:, 2] @ r.blocks.seconds) for r in (forward, backward)]
    seconds = [float(r.blocks.seconds.sum()) for r in (forward, backward)]
    up = inputs.earth.up

    # S0 (3-9), (3-10) as printed, both turns over the same time: a sixth of the scale factor.
    by_formula = (sums[0] - sums[1]) / (4 * np.pi) - 1 - scale
    assert 1e6 * by_formula == pytest.approx(-166320, abs=15)
    bias_by_formula = degrees((sums[0] + sums[1]) / (2 * seconds[0]) - up)
    assert bias_by_formula == pytest.approx(119.7 / (2 * seconds[0]), rel=2e-3)

    # With the times of each, and 240° for the backward turn.
    def formulas(angle: float):
        pairs = zip(sums, (2 * np.pi, -radians(angle)), seconds, strict=True)
        return bias_and_scale(
            [WholeTurn(s, a, ANGLE, t, 1.0, NOISE) for s, a, t in pairs], inputs.earth
        )

    assumed = formulas(240)
    assert 1e6 * (assumed.values[1] - scale) == pytest.approx(612, abs=15)
    assert degrees(assumed.values[0] - bias) * 3600 == pytest.approx(-20.6, abs=0.5)  # °/h
    assert abs(assumed.values[1] - scale) > 150 * assumed.sigma[1]

    # The joint fit, with nothing but this turn about z.
    def together(turn: RateSegment):
        fit = joint(inputs.static_rates, [turn], [], inputs.earth, inputs.position_sigma)
        return fit.values[Z_SCALE] - 1 - scale, fit.sigma[Z_SCALE]

    gap = inputs.turns[-1]
    unbridged = replace(gap, gaps=(), gap_sigma=0.0)
    by_240, sigma_240 = together(replace(unbridged, angle=-radians(240)))
    assert 1e6 * by_240 == pytest.approx(1251, abs=25)
    assert by_240 > 90 * sigma_240
    by_bridge, sigma = together(gap)
    assert 1e6 * sigma == pytest.approx(34, abs=2)
    assert abs(by_bridge) < 1.5 * sigma


@pytest.mark.slow
def test_criticism_and_extension_take_the_turn_as_the_joint_estimate_does(tmp_path):
    document = chain.demo(faults=lose((2193, 1197)))
    for entry in document["campaign"]["plan"]:
        entry |= {"seconds": 30} if entry["do"] == "rest" else {}
    campaign = chain.simulate(document, tmp_path / "raw")
    results = chain.run(campaign, tmp_path / "derived", "gyroscope")
    (data,) = chain.mounts(results)
    campaign = campaign_of(data).without_random_walks()
    assert "z-backward" in campaign.manoeuvres
    system, _ = campaign.systems([], 1.0)
    assert system.column("gap angle", "z-backward 5") is not None
    again = system.solve()
    joint_result = results.parameters("gyroscope").loc[list(linear_names())]
    values = errors_of(again.values[:12]) - joint_result["value"].to_numpy(float)
    assert np.abs(values / joint_result["sigma"].to_numpy(float)).max() < 0.02
    np.testing.assert_allclose(again.sigma[:12], joint_result["sigma"], rtol=1e-3)


def test_the_bridged_turn_lowers_the_sigma_of_the_scale_factor(gapped):
    inputs = inputs_of(gapped)
    fixed = (inputs.static_rates, [], inputs.earth, inputs.position_sigma)

    def sigma(turns: list[RateSegment]) -> float:
        return float(joint(fixed[0], turns, *fixed[1:]).sigma[Z_SCALE])

    assert sigma(inputs.turns) < sigma(inputs.turns[:1])

"""A gap of the log while the table turns: the demo's is bridged, others are refused by name."""

from math import degrees, radians

import numpy as np
import pytest
from z_turns import inputs_of, lose, of_z, recorded

from inertial.physics.site import earth_rate

UP, _ = earth_rate(radians(30.5278))
BIAS_Z = 0.9e-6  # rad/s, of the demo


def test_the_gap_of_the_demo_is_bridged_and_said(gapped):
    done = of_z(gapped, "segment/performed")
    assert done["bridged"] and not done["complete"]
    assert done["missing_s"] == pytest.approx(11.97)
    assert degrees(done["missing_angle"]) == pytest.approx(-119.74, abs=0.02)
    assert "11.97 s are missing while it turns" in done["sentence"]
    assert "the joint fit uses the turn" in done["sentence"]
    fitted = gapped["gyroscope/fit_manoeuvres"].query("method == 'joint'")
    assert fitted["used"].all() and "z-backward" in set(fitted["manoeuvre"])
    # S0's own formulas need the whole turn, and have it not.
    formula = gapped.parameters("gyroscope", "turns").loc["scale_z"]
    assert np.isnan(formula["value"])
    assert "not whole: z-backward" in formula["reason"]


def test_the_bridge_takes_its_place_in_time_and_angle(gapped):
    one = inputs_of(gapped).turns[-1]
    (bridge,) = one.gaps
    assert bridge.seconds == pytest.approx(11.97)
    angle = one.sums[:, 2]
    # 119.7° at the set speed as the gyro reads it, bias and earth rate with it.
    read = -119.7 * 1.0006442 + degrees(11.97 * (UP + BIAS_Z))
    assert degrees(bridge.shares @ angle) == pytest.approx(read, abs=0.001)
    assert degrees(one.turned(angle)[-1]) == pytest.approx(-360.2, abs=0.1)
    # 100 ppm of the campaign's file are more than the table of the laboratory strays.
    assert degrees(one.gap_sigma) == pytest.approx(1e-4 * 119.7, rel=0.02)


@pytest.mark.parametrize(
    ("stretches", "words"),
    [
        ([(4500, 200)], "2.00 s are missing while it turns, and the rate is not steady there"),
        ([(1050, 20)], "0.20 s are missing while it turns, and the rate is not steady there"),
        ([(2193, 1197), (3350, 200)], "and the rate is not steady there"),
        ([(1300, 1500)], "of steady rate are recorded before them, of 1.00 s that are needed"),
        ([(1, 1500)], "the log begins while it turns"),
    ],
)
def test_a_gap_that_touches_a_ramp_is_refused_by_name(stretches, words, tmp_path):
    results = recorded(tmp_path, faults=lose(*stretches))
    done = of_z(results, "segment/performed")
    assert not done["complete"] and not done["bridged"]
    assert words in done["sentence"]


@pytest.mark.slow
def test_two_gaps_in_the_steady_part_are_both_bridged(tmp_path):
    results = recorded(tmp_path, "noise", faults=lose((1800, 300), (2600, 500)))
    done = of_z(results, "segment/performed")
    assert done["bridged"] and done["missing_s"] == pytest.approx(8.0)
    one = inputs_of(results).turns[-1]
    assert [bridge.seconds for bridge in one.gaps] == pytest.approx([3.0, 5.0])
    assert degrees(one.turned(one.sums[:, 2])[-1]) == pytest.approx(-360.2, abs=0.1)

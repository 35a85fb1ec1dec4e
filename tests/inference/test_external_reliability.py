"""What an effect that is not detected moves: as much as the fit of readings that hold it."""

import chain
import numpy as np
import pytest

from inertial.estimation.least_squares import System

G = 9.80665


def test_it_is_the_change_of_the_estimate_by_readings_that_hold_the_effect():
    """Of 40 readings with two parameters, a tilt of 10⁻² and the second of two effects."""
    rng = np.random.default_rng(7)
    design, sigma = rng.standard_normal((40, 5)), rng.uniform(0.5, 2, 40)
    names = (("parameter", "0"), ("parameter", "1"), ("tilt", "a"), ("effect", "known"))
    system = System(
        design, np.zeros(40), sigma, np.zeros(5), np.array([1e4, 1e4, 1e-2, 1e4, 1e4]), 2,
        (*names, ("effect", "hidden")),
    )  # fmt: skip
    moved, shifts = system.shifts(1)
    weight = 1 / sigma[:, None]
    own = np.vstack([design[:, :4] * weight, np.diag([1e-4, 1e-4, 1e2, 1e-4])])
    read = np.append(design[:, 4] * weight[:, 0], np.zeros(4))
    expected = np.linalg.lstsq(own, read)[0][:2]
    deviation = np.sqrt(np.diag(np.linalg.inv(own.T @ own)))[:2]
    assert moved == ["0", "1"]
    np.testing.assert_allclose(shifts[:, 0], expected / deviation, rtol=1e-6)


@pytest.mark.slow
def test_an_effect_of_the_laboratory_below_its_limit_moves_what_is_said():
    """K2 of y, 10 µg/g², of which five sigma are 20: undetected, and the bias is 25 sigma off."""
    hidden = 10e-6 / G
    clean, with_it = (
        chain.in_memory_of(chain.demo(seed=3, effects=effects), "criticism", chain.BESIDE)
        for effects in ({}, {"accel_quadratic": {"k2_micro_g_g2": [0, 10, 0]}})
    )
    limits = clean["criticism/detection_limits"].set_index(["effect", "parameter"])
    own = limits.loc[("accel_quadratic", "k2_y")]
    assert (own["moved_sensor"], own["moved_parameter"]) == ("accel", "bias_y")
    both = [made.parameters("accelerometer", "joint").loc["bias_y"] for made in (clean, with_it)]
    moved = (both[1]["value"] - both[0]["value"]) / both[0]["sigma"]
    assert abs(moved) == pytest.approx(own["moves"] * hidden / own["limit"], rel=0.02)
    assert abs(moved) > 20 and with_it["criticism/findings"].empty

"""What to do against an effect: of each kind what a laboratory can do, and not one for all."""

import numpy as np
import pytest

from inertial.effects import KNOWN
from inertial.effects.warm_up import WarmUp
from stages.criticism.block_sentences import (
    action_against,
    action_against_heading,
    action_against_latitude,
)


def test_a_warm_up_is_waited_for_as_long_as_it_takes():
    effect = KNOWN["gyro_warm_up"]
    assert isinstance(effect, WarmUp)
    effect.at = 600.0  # s: five of them are 50 min
    try:
        assert "after 50 min" in action_against(effect)
    finally:
        effect.at = None


@pytest.mark.parametrize(
    ("effect", "free", "said"),
    [
        ("gyro_bias_temperature", False, "at the temperature at which the IMU is used"),
        ("gyro_g_sensitivity", False, "a property of the sensor"),
        ("latitude_sign", False, "Check the sign of latitude_deg"),
        ("latitude_sign", True, "accelerometer: {reads: gravity}"),
    ],
)
def test_what_is_done_is_that_which_helps(effect, free, said):
    action = action_against(KNOWN[effect], free=free)
    assert said in action and "at its origin" not in action


def test_what_is_stated_wrong_is_said_with_the_right_value():
    """A mark whose azimuth is 0.5° more than stated, of 39.5°: state 40°."""
    said = action_against_heading(np.radians(0.5))
    assert "0.500° further clockwise" in said and "larger" in said
    assert "smaller" in action_against_heading(-0.01)
    latitude = action_against_latitude(np.radians(48.15), surveyed=False)
    assert "48.15°" in latitude and "heading_deg" not in latitude

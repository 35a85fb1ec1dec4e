"""What a sentence says of an effect that all its parameters show together, and none by itself."""

import numpy as np
import pytest

from inertial.campaign.effect_sentences import Estimated, effect_sentence
from inertial.model_selection.cause import FOUND

UNIT = "(rad/s)/(m/s²)²"
PER_HOUR = np.pi / 180 / 3600 / 9.80665**2  # (rad/s)/(m/s²)² per °/h/g²
TOGETHER = "significant together, none of them by itself"


def sentence(*sizes: tuple[float, float]) -> str:
    """Of a g²-sensitivity of gyros, °/h/g², with sigmas."""
    parameters = [
        Estimated(f"g2_{axis}", UNIT, "", value * PER_HOUR, sigma * PER_HOUR)
        for axis, (value, sigma) in zip("xyz", sizes, strict=False)
    ]
    effect = "gyro_g2_sensitivity"
    return effect_sentence(effect, "it yields under load", parameters, FOUND, [effect], [])


def test_what_is_significant_together_alone_is_said_so():
    """As 2.5 sigma of one component, of which χ² of all three is 21."""
    said = sentence((32, 13), (-2.9, 6.1), (3.9, 9.3))
    assert "g2_x = 32 ± 13 °/h/g²" in said and TOGETHER in said


@pytest.mark.parametrize("sizes", [[(80, 13), (-2.9, 6.1), (3.9, 9.3)], [(32, 13)]])
def test_one_that_is_clear_or_the_only_one_stands_for_itself(sizes):
    assert TOGETHER not in sentence(*sizes)


def test_of_a_combination_that_shows_those_that_are_determined_are_no_size():
    """A gyro in one position without a heading: the bias along the vertical is not what is off."""
    told = [Estimated("b_x", "rad/s", ""), Estimated("b_z", "rad/s", "", 0.0, 1.8e-4)]
    name = "gyro_bias_of_position"
    said = effect_sentence(name, "something disturbs it", told, FOUND, [name], ["z-down"])
    assert "no parameter by itself" in said and "b_z" not in said

"""What is said of a cause in a result: what it gains, which parameter it shifts, its remedy."""

from math import radians
from types import SimpleNamespace

import numpy as np
import pytest

from inertial.campaign.estimates import reasons
from stages.diagnosis.causes import MASKED, MODELLED, _mean_of
from stages.diagnosis.sensor_results import Moved
from stages.diagnosis.sizes_of_causes import gain_of, most_moved_by
from stages.diagnosis.verdict import _limit

WARM_UP = SimpleNamespace(causes=frozenset({"gyro_warm_up"}), repair=None)


def result(*effects, drop=96.05, joint_share=0.0, method="extended"):
    rows = [{"effect": None}, *({"effect": name} for name in effects)]
    return SimpleNamespace(
        sensor="gyro",
        drop=drop,
        chosen=SimpleNamespace(rows=rows, method=method),
        models=lambda causes: not causes.isdisjoint(effects),
        decision=SimpleNamespace(joint_share=joint_share),
        # 5 °/h of a bias known to 0.25 °/h
        most_moved=lambda _: Moved(20.0, "bias_z", radians(5) / 3600, "rad/s"),
    )


def test_a_gain_says_of_which_sensor_and_with_which_other_effects_it_is():
    alone = gain_of(WARM_UP, 96.05, [result("gyro_warm_up")])
    assert alone == "χ² of the held-out manoeuvres of the gyros falls by 96.05."
    both = gain_of(WARM_UP, 96.05, [result("gyro_warm_up", "gyro_temperature")])
    assert both.endswith("falls by 96.05, together with gyro parameters with temperature.")
    assert gain_of(WARM_UP, None, [result("gyro_warm_up")]) is None


def test_the_parameter_that_is_shifted_most_is_named_with_its_shift():
    said = most_moved_by(WARM_UP, 20.0, [result("gyro_warm_up")])
    assert said == "Most of all b_z of the gyros, by 5.0 °/h. "
    assert not most_moved_by(WARM_UP, 31.0, [result("gyro_warm_up")])  # by something else
    assert not most_moved_by(WARM_UP, None, [result("gyro_warm_up")])


@pytest.mark.parametrize(
    ("effect", "share", "said"),
    [
        ("gyro_warm_up", 0.0, "corrected by a further term: use it"),
        ("gyro_warm_up", 0.1, "use it; the sigmas include the result without it"),
        ("table_tilt", 0.0, "in the model"),  # it is in no reading of the IMU elsewhere
    ],
)
def test_a_further_term_is_to_be_used(effect, share, said):
    main = SimpleNamespace(causes=frozenset({effect}))
    cause = SimpleNamespace(cure=MODELLED, main=main)
    assert _limit(cause, result(effect, joint_share=share)).endswith(said)
    masked = SimpleNamespace(cure=MASKED, main=main)
    assert _limit(masked, result(effect)) == "masked: its data were not used"


@pytest.mark.parametrize(
    ("verdict", "share", "method", "said"),
    [
        ("found", 0.0, "extended", ""),
        ("one_of_class", 0.0, "extended", ""),  # its members say the same
        ("one_of_class", 0.0, "mixture", "over all that it may be, by how"),
        ("one_of_class", 0.1, "mixture", "over the members of the class and over the result wit"),
        ("found", 0.1, "mixture", "of the result with it and the result without it"),
    ],
)
def test_a_mean_says_what_it_is_over(verdict, share, method, said):
    cause = SimpleNamespace(causes=WARM_UP.causes, verdict=verdict, places=())
    words = _mean_of(cause, [result("gyro_warm_up", joint_share=share, method=method)])
    assert words.startswith(f"The parameters are the mean {said}") if said else words == ""


def test_a_gyro_that_gave_no_reading_may_be_masked():
    there = np.array([True, True, False])
    why = reasons(np.ones(12, bool), there, "gyro", {"bias": "", "matrix": ""})
    assert set(why) == {"bias_z", "scale_z", "cross_zx", "cross_zy"}
    assert {*why.values()} == {"the z gyro is not recorded, or masked"}
    assert not reasons(np.ones(12, bool), np.ones(3, bool), "gyro", {"bias": "", "matrix": ""})

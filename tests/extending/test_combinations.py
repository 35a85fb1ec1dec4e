"""Of every class a member: one class is varied at a time, the most probable come first."""

from types import SimpleNamespace
from typing import Any

import pytest

from inertial.effects import CATALOGUE
from stages.extension.candidates import candidates_of, normalised
from stages.extension.named_effects import Member, NamedClass, combinations_of, compared


def of_class(finding: str, **probability: float) -> NamedClass:
    members = tuple(Member(CATALOGUE[name], p) for name, p in probability.items())
    return NamedClass(finding, members)


ACCEL = of_class("a", accel_quadratic=0.6, accel_scale_asymmetry=0.4)
GYRO = of_class("g", gyro_bias_ramp=0.7, gyro_warm_up=0.2, gyro_random_walk=0.1)


def shown(*effects: str) -> frozenset[str]:
    return frozenset(name for effect in effects for name in CATALOGUE[effect].columns)


def told(*shown_effects: str) -> dict[str, tuple[tuple[str, ...], float]]:
    candidates = candidates_of(combinations_of([ACCEL, GYRO]), shown(*shown_effects))
    return {
        one.method: (tuple(e.name for e in one.effects), one.probability)
        for one in normalised(candidates)
    }


def test_one_class_is_varied_at_a_time_and_the_most_probable_comes_first():
    combined = [tuple(e.name for e in one.effects) for one in combinations_of([ACCEL, GYRO])]
    assert combined == [
        ("accel_quadratic", "gyro_bias_ramp"),  # 0.6 × 0.7
        ("accel_scale_asymmetry", "gyro_bias_ramp"),  # 0.4 × 0.7
        ("accel_quadratic", "gyro_warm_up"),  # 0.6 × 0.2
        ("accel_quadratic", "gyro_random_walk"),
    ]
    assert combinations_of([]) == []


def test_members_that_a_sensor_does_not_show_are_one_model_for_it():
    accel = told("accel_quadratic", "accel_scale_asymmetry")
    assert accel["joint"][1] == 0.0
    assert accel["extended"][0] == ("accel_quadratic",)
    # 0.42 + 0.12 against 0.28; a random walk beside an effect is no candidate.
    assert accel["extended"][1] == pytest.approx(0.54 / 0.82)
    assert accel["member_1"] == (("accel_scale_asymmetry",), pytest.approx(0.28 / 0.82))
    gyro = told("gyro_bias_ramp", "gyro_warm_up")
    assert set(gyro) == {"joint", "extended", "member_2"}
    # The walk is in the covariance of the joint fit: 0.06 of 0.42 + 0.28 + 0.12 + 0.06.
    assert gyro["joint"][1] == pytest.approx(0.06 / 0.88)
    assert told() == {"joint": ((), pytest.approx(1.0))}


def test_an_effect_of_one_position_is_a_member_for_each_that_may_be_it():
    campaign: Any = SimpleNamespace(places=lambda effect: ["x-up", "y-up", "z-up"])
    # Reductions of 103 and 100: odds of e^1.5, 0.82 to 0.18.
    off = Member(CATALOGUE["table_position_error"].fixed(2.0), 0.5)
    tilt = Member(CATALOGUE["table_tilt"], 0.5)
    own = NamedClass("p", (off, tilt), (("z-up", 103.0), ("x-up", 100.0)))
    (told_of,) = compared(campaign, [own])
    named = [(one.effect.name, one.effect.at) for one in told_of.members]
    error = "table_position_error"
    assert named == [(error, 2.0), (error, 0.0), ("table_tilt", None)]
    shares = [one.probability for one in told_of.members]
    assert shares == pytest.approx([0.409, 0.091, 0.5], abs=0.001)
    (alone,) = compared(campaign, [NamedClass("p", (off,), (("z-up", 103.0),))])
    assert [(one.effect.at, one.probability) for one in alone.members] == [(2.0, 1.0)]


def test_not_more_than_eight_and_no_effect_twice():
    many = of_class("m", **dict.fromkeys([n for n in CATALOGUE if n.startswith("gyro")], 0.05))
    assert len(combinations_of([many])) == 8
    twice = [of_class("1", gyro_bias_ramp=1.0), of_class("2", gyro_warm_up=0.5, gyro_bias_ramp=0.5)]
    assert len(combinations_of(twice)) == 1

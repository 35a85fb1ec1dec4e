"""When the extended result counts: foretold better, no alarm, nothing lost."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from inertial.estimation.least_squares import EffectInformation, Estimate
from inertial.estimation.triad import linear_names
from stages.extension.cross_validation import Fold, HeldOut
from stages.extension.decision import decision, result
from stages.extension.estimates import Solved
from stages.extension.models import Told
from stages.extension.named_effects import Named

Row = dict[str, Any]


def row(parameter: str, value: float | None, method: str, stage: str) -> Row:
    return {"id": f"{stage}/{method}/{parameter}", "parameter": parameter, "value": value}


JOINT = [row(name, 1.0, "joint", "gyroscope") for name in linear_names()]


def extended(lost: str = "") -> Solved:
    names = [*linear_names(), "gyro_bias_ramp.c_x"]
    rows = [row(n, None if n == lost else 2.0, "gyroscope", "extension") for n in names]
    return Solved("gyro", "gyroscope", rows, np.eye(13), estimate(), 0.0)


def estimate() -> Estimate:
    return Estimate(np.zeros(1), np.eye(1), np.ones(1, bool), 9.0, 9, 9.0, 9)


def found(drop: float, stake: float = 40.0, alone: str = "", walked: float = 0.0) -> HeldOut:
    """Four folds; `walked`: what a walk of the joint model explains of each."""
    told = Told(estimate(), EffectInformation((), np.zeros((0, 0)), np.zeros(0), 9.0, 9), 0.0)
    whole = replace(told, walked=walked)
    folds = [(Fold((f"rest {i}",), 1.0, np.zeros(0), drop / 4, stake / 4), told) for i in range(4)]
    if alone:
        folds.append((Fold((alone,), 0.1, np.zeros(0), 0.0, 0.0), told))
    return HeldOut("gyro", whole, folds, stake)


def named(alarms: tuple[str, ...] = (), classes: tuple[str, ...] = ()) -> Named:
    return Named((), {}, {"gyro_bias_ramp": classes} if classes else {}, {"gyro": alarms})


def test_it_counts_where_others_foretell_it_and_nothing_warns():
    one = extended()
    decided = decision("gyro", "", named(), one, found(35.0), JOINT)
    assert (decided["result"], decided["drop"]) == ("extended", pytest.approx(35.0))
    assert (decided["folds"], decided["counted"]) == (4, 4)
    assert result(decided, one, JOINT) == one.of_sensor
    assert "drops by 35.0" in decided["sentence"] and "gyro bias ramp" in decided["sentence"]


@pytest.mark.parametrize(
    ("warned", "tested", "lost", "words"),
    [
        (("gyro_drift",), found(35.0), "", "something is not understood"),
        ((), found(-2.0), "", "grows by 2.0"),
        ((), found(35.0, walked=9.0), "", "grows by 1.0"),
        ((), found(1.0, stake=2.0), "", "not cross-validatable"),
        ((), found(35.0), "cross_xy", "cross_xy would not be determined"),
    ],
)
def test_the_joint_result_stays(warned, tested, lost, words):
    one = extended(lost)
    decided = decision("gyro", "", named(warned), one, tested, JOINT)
    assert decided["result"] == "joint" and words in decided["sentence"]
    assert result(decided, one, JOINT) == JOINT


def test_against_a_walk_the_effects_must_foretell_more_than_it():
    decided = decision("gyro", "", named(), extended(), found(35.0, walked=5.0), JOINT)
    assert (decided["result"], decided["drop"]) == ("extended", pytest.approx(15.0))
    assert "for a walk of the biases, it drops by 15.0" in decided["sentence"]


def test_a_sensor_that_shows_no_effect_keeps_its_result():
    decided = decision("accel", "lying", named(), None, None, JOINT)
    assert (decided["result"], decided["mount"], decided["effects"]) == ("joint", "lying", "")
    assert "show no effect" in decided["sentence"] and decided["drop"] is None


def test_classes_and_what_was_not_counted_are_said():
    told = decision(
        "gyro",
        "",
        named(classes=("gyro_bias_ramp", "gyro_warm_up")),
        extended(),
        found(35.0, alone="x-up"),
        JOINT,
    )
    assert told["result"] == "extended"  # of a class it does not matter which member it is
    assert "it may be gyro warm-up" in told["sentence"]
    assert "Not counted: x-up" in told["sentence"] and (told["folds"], told["counted"]) == (5, 4)

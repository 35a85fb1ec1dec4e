"""When the extended result counts: foretold better, no alarm, nothing lost."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from inertial.estimation.least_squares import EffectInformation, Estimate
from inertial.estimation.triad import linear_names
from stages.extension.cross_validation import CrossValidation, Fold
from stages.extension.decision import Candidate
from stages.extension.estimates import Solved
from stages.extension.models import SensorEvidence
from stages.extension.named_effects import Alarm, Named

Row = dict[str, Any]


def row(parameter: str, value: float | None, method: str, stage: str) -> Row:
    return {"id": f"{stage}/{method}/{parameter}", "parameter": parameter, "value": value}


def decision(*parts: Any) -> tuple[Candidate, dict[str, list[Row]]]:
    """The candidate, and its rows by table."""
    candidate = Candidate(*parts)
    rows: dict[str, list[Row]] = {}
    for table, one in candidate.rows():
        rows.setdefault(table, []).append(dict(one))
    return candidate, rows


def decided(*parts: Any) -> Row:
    _, rows = decision(*parts)
    (one,) = rows["decision"]
    return one


JOINT = [row(name, 1.0, "joint", "gyroscope") for name in linear_names()]


def extended(lost: str = "") -> Solved:
    names = [*linear_names(), "gyro_bias_ramp.c_x"]
    rows = [row(n, None if n == lost else 2.0, "gyroscope", "extension") for n in names]
    return Solved("gyro", rows, np.eye(13), estimate(), 0.0, ["gyro_bias_ramp"])


def estimate() -> Estimate:
    return Estimate(np.zeros(1), np.eye(1), np.ones(1, bool), 9.0, 9, 9.0, 9)


def found(
    drop: float, stake: float = 40.0, alone: str = "", walked: float = 0.0
) -> CrossValidation:
    """Four folds; `walked`: what a walk of the joint model explains of each."""
    training = SensorEvidence(
        estimate(), EffectInformation((), np.zeros((0, 0)), np.zeros(0), 9.0, 9), 0.0
    )
    whole = replace(training, walk_drop=walked)
    folds = [
        (Fold((f"rest {i}",), 1.0, np.zeros(0), drop / 4, stake / 4), training) for i in range(4)
    ]
    if alone:
        folds.append((Fold((alone,), 0.1, np.zeros(0), 0.0, 0.0), training))
    return CrossValidation("gyro", whole, folds, stake)


def named(alarms: tuple[str, ...] = (), classes: tuple[str, ...] = ()) -> Named:
    return Named(
        (),
        {},
        {"gyro_bias_ramp": classes} if classes else {},
        {"gyro": [Alarm(f"criticism/{one}", one) for one in alarms]},
    )


def test_it_counts_where_others_foretell_it_and_nothing_warns():
    one = extended()
    candidate, rows = decision("gyro", "", named(), JOINT, one, found(35.0))
    (row,) = rows["decision"]
    assert (row["result"], row["drop"]) == ("extended", pytest.approx(35.0))
    assert (row["folds"], row["counted"]) == (4, 4)
    assert [each["effect"] for each in rows["decision_effects"]] == ["gyro_bias_ramp"]
    assert candidate.final_rows() == one.of_sensor and "alarms" not in rows
    assert "reduced by 35.0" in row["sentence"] and "gyro bias ramp" in row["sentence"]


@pytest.mark.parametrize(
    ("warned", "tested", "lost", "words"),
    [
        (("gyro_drift",), found(35.0), "", "some findings are not explained"),
        ((), found(-2.0), "", "grows by 2.0"),
        ((), found(35.0, walked=9.0), "", "grows by 1.0"),
        ((), found(1.0, stake=2.0), "", "not cross-validatable"),
        ((), found(35.0), "cross_xy", "cross_xy would not be determined"),
    ],
)
def test_the_joint_result_stays(warned, tested, lost, words):
    candidate, rows = decision("gyro", "", named(warned), JOINT, extended(lost), tested)
    (row,) = rows["decision"]
    assert row["result"] == "joint" and words in row["sentence"]
    assert candidate.final_rows() == JOINT
    assert [one["cause"] for one in rows.get("alarms", [])] == list(warned)


def test_against_a_walk_the_effects_must_foretell_more_than_it():
    row = decided("gyro", "", named(), JOINT, extended(), found(35.0, walked=5.0))
    assert (row["result"], row["drop"]) == ("extended", pytest.approx(15.0))
    assert "random walk of the biases, it is reduced by 15.0" in row["sentence"]


def test_a_sensor_that_shows_no_effect_keeps_its_result():
    _, rows = decision("accel", "lying", named(), JOINT)
    (row,) = rows["decision"]
    assert (row["result"], row["mount"]) == ("joint", "lying")
    assert "decision_effects" not in rows
    assert "show no effect" in row["sentence"] and row["drop"] is None


def test_classes_and_what_was_not_counted_are_said():
    row = decided(
        "gyro",
        "",
        named(classes=("gyro_bias_ramp", "gyro_warm_up")),
        JOINT,
        extended(),
        found(35.0, alone="x-up"),
    )
    assert row["result"] == "extended"  # of a class it does not matter which member it is
    assert "it may be gyro warm-up" in row["sentence"]
    assert "Not counted: x-up" in row["sentence"] and (row["folds"], row["counted"]) == (5, 4)

"""The judge itself: what it must call right, missing, extra and flawed."""

import numpy as np
import pandas as pd
import pytest
from cases import GOOD, SIGNS, cause
from judge import judge

ROW = {"id": "1", "cause": "signs", "verdict": "found", "sensor": "gyro", "axis": "y", "log": None}
ROW |= {"manoeuvre": None, "count": 1, "moves": 900.0}


def tables(rows=(ROW,), members=(), verdict="usable", results=()):
    return {
        "causes": pd.DataFrame(list(rows), columns=list(ROW)),
        "members": pd.DataFrame(list(members), columns=["cause", "member"]),
        "verdict": pd.DataFrame([{"sensor": "gyro", "verdict": verdict}]),
        "result": pd.DataFrame(
            list(results), columns=["sensor", "parameter", "effect", "value", "sigma"]
        ),
    }


def test_the_right_row_and_nothing_else_is_right():
    assert judge(tables(), [cause(SIGNS, "gyro", "y")], {"gyro": GOOD}).good


def test_a_row_too_many_is_extra_and_one_too_few_is_missing():
    twice = judge(tables([ROW, ROW]), [cause(SIGNS, "gyro", "y")])
    assert (twice.right, twice.missing, len(twice.extra)) == (["signs"], [], 1)
    other = judge(tables(), [cause({"gap"})])
    assert (other.right, other.missing, len(other.extra)) == ([], ["gap"], 1)
    assert not twice.good and not other.good


@pytest.mark.parametrize("wrong", [{"axis": "x"}, {"sensor": "accel"}, {"count": 2}])
def test_another_axis_sensor_or_count_is_a_flaw(wrong):
    found = judge(tables([ROW | wrong]), [cause(SIGNS, "gyro", "y", count=1)])
    assert found.right and not found.good


def test_a_member_is_right_in_a_class_alone():
    classed = ROW | {"cause": "accel_scale_asymmetry", "verdict": "one_of_class", "axis": None}
    members = [{"cause": "1", "member": m} for m in ("accel_quadratic", "accel_scale_asymmetry")]
    wanted = [cause({"accel_quadratic"})]
    assert judge(tables([classed], members), wanted).good
    assert not judge(tables([classed | {"verdict": "found"}], members), wanted).good
    assert not judge(tables([classed], members), [cause({"accel_quadratic"}, alone=True)]).good


def test_errors_are_told_in_sigma_where_the_sensor_is_usable():
    rows = [("gyro", "bias_x", None, 3.0, 0.5), ("gyro", "bias_x", "gyro_bias_ramp", 9.0, 0.5)]
    rows += [("gyro", "scale_y", None, np.nan, np.nan)]
    results = [dict(zip(tables()["result"].columns, row, strict=True)) for row in rows]
    truth = {"gyro": {"bias_x": 2.0, "scale_y": 0.0}}
    assert judge(tables(results=results), [], None, truth).pulls == {"gyro bias_x": 2.0}
    assert not judge(tables(verdict="not_usable", results=results), [], None, truth).pulls

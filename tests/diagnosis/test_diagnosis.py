"""Every case of `cases.py` through all stages: the right rows, nothing else, the right verdict."""

import pytest
from campaigns import diagnosed
from cases import CASES, Case
from judge import judge, parameters_of

QUICK = ("clean-positions",)  # the others with the slow tests; the demo in test_check too
MOST_SIGMA = 4.5  # of some 700 errors of parameters in all cases, one in 200 runs is larger


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(
            case,
            id=case.name,
            marks=() if case.name in QUICK else pytest.mark.slow,
        )
        for case in CASES
    ],
)
def test_the_right_causes_and_nothing_else(case: Case) -> None:
    document = case.document()
    verdicts = {"accel": case.accel, "gyro": case.gyro}
    truth = parameters_of(document) if case.known else None
    judgement = judge(diagnosed(document), case.causes, verdicts, truth)
    assert judgement.good, str(judgement)
    far = {name: pull for name, pull in judgement.pulls.items() if abs(pull) > MOST_SIGMA}
    assert not far

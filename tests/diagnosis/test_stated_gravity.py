"""A gravity that was replaced for a latitude that was wrong is taken as stated, if it fits."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from inertial.campaign.competition import ExplainedFindings
from inertial.campaign.hypotheses import Hypothesis
from inertial.campaign.records import Known
from inertial.estimation.triad import linear_names
from stages.diagnosis.decision import Decision
from stages.diagnosis.result import Result
from stages.diagnosis.sensor_results import SensorResult
from stages.diagnosis.stated_gravity import restored

STATED_LATITUDE, LATITUDE = np.radians([34.2, 30.53])
AT_STATED, AT_LATITUDE = 9.796661, 9.793664  # m/s²: normal gravity at 0 m, WGS 84
SIGMA = 1e-5


def result(sensor: str, values: np.ndarray, shift: float | None) -> SensorResult:
    rows: list[dict[str, Any]] = [
        {"parameter": name, "effect": None, "value": float(value), "sigma": SIGMA}
        for name, value in zip(linear_names(), values, strict=True)
    ]
    if shift is not None:
        effect = {"parameter": "latitude_error.dphi", "effect": "latitude_error", "unit": "rad"}
        rows.append(effect | {"value": shift, "sigma": np.radians(0.3)})
    chosen = Result("extended", rows, np.diag(np.full(len(rows), SIGMA**2)))
    return SensorResult(sensor, "", chosen, {}, {}, Decision("extended", "."), {}, {})


def replaced(stated: float) -> list[ExplainedFindings]:
    row: Any = SimpleNamespace()
    wrong = Hypothesis("1", "criticism", "latitude_error", row, verdict="found")
    repair = {"state": "applied", "value": AT_STATED, "sigma": 5e-4, "stated": stated}
    return [
        ExplainedFindings(wrong, (wrong, Hypothesis("2", "q", "gravity_error", row, repair=repair)))
    ]


@pytest.mark.parametrize(
    ("stated", "found", "confirmed"),
    [
        (AT_LATITUDE, LATITUDE - STATED_LATITUDE, True),
        (AT_LATITUDE + 1e-3, LATITUDE - STATED_LATITUDE, True),  # an anomaly of 100 mGal: 2 sigma
        (9.80665, LATITUDE - STATED_LATITUDE, False),  # the unit g is of no such latitude
        (AT_LATITUDE, STATED_LATITUDE - LATITUDE, False),  # the other way
    ],
)
def test_the_stated_gravity_is_right_where_the_latitude_found_says_so(stated, found, confirmed):
    matrix = np.array([[1.001, 2e-4, -3e-4], [1e-4, 0.999, 5e-4], [-2e-4, 3e-4, 1.002]])
    bias = [0.01, -0.02, 0.03]
    # Readings at rest with each axis up are the columns of M g, whatever g is taken for.
    taken = np.array([*(matrix * stated / AT_STATED - np.eye(3)).ravel(), *bias])
    results = [result("gyro", np.zeros(12), found), result("accel", taken, None)]
    known = {"latitude": Known(STATED_LATITUDE, 0.0)}
    (gyro, accel), conditions = restored(results, replaced(stated), known)
    assert set(conditions) == ({"1"} if confirmed else set())
    assert gyro is results[0]
    values = [row["value"] for row in accel.chosen.rows]
    expected = [*(matrix - np.eye(3)).ravel(), *bias] if confirmed else taken
    np.testing.assert_allclose(values, expected, atol=1e-12)


def test_without_a_gravity_that_was_replaced_nothing_changes():
    results = [result("gyro", np.zeros(12), 0.06), result("accel", np.zeros(12), None)]
    assert restored(results, [], {}) == (results, {})

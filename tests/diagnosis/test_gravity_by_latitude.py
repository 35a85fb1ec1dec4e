"""Where the gyros show another latitude the accelerometers are referred to its gravity."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from inertial.campaign.competition import ExplainedFindings
from inertial.campaign.hypotheses import Hypothesis
from inertial.campaign.records import Known
from inertial.estimation.triad import linear_names
from stages.diagnosis.decision import Decision
from stages.diagnosis.gravity_by_latitude import referred
from stages.diagnosis.result import Result
from stages.diagnosis.sensor_results import SensorResult

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


WRONG = Hypothesis(
    "1", "criticism", "latitude_error", cast(Any, SimpleNamespace()), verdict="found"
)


def alone() -> list[ExplainedFindings]:
    return [ExplainedFindings(WRONG, (WRONG,))]


def replaced(stated: float) -> list[ExplainedFindings]:
    """Normal gravity of the wrong latitude took the place of a stated one."""
    repair = {"state": "applied", "value": AT_STATED, "sigma": 5e-4, "stated": stated}
    other = Hypothesis("2", "q", "gravity_error", WRONG.row, repair=repair)
    return [ExplainedFindings(WRONG, (WRONG, other))]


MATRIX = np.array([[1.001, 2e-4, -3e-4], [1e-4, 0.999, 5e-4], [-2e-4, 3e-4, 1.002]])
BIAS = [0.01, -0.02, 0.03]


def by_gravity(true: float, used: float, found: float) -> list[SensorResult]:
    """Readings at rest with each axis up are the columns of M g, whatever g is taken for."""
    taken = np.array([*(MATRIX * true / used - np.eye(3)).ravel(), *BIAS])
    return [result("gyro", np.zeros(12), found), result("accel", taken, None)]


def values(of: SensorResult) -> list[float]:
    return [row["value"] for row in of.chosen.rows]


RIGHT = [*(MATRIX - np.eye(3)).ravel(), *BIAS]
SHIFT = LATITUDE - STATED_LATITUDE


@pytest.mark.parametrize("anomaly", [0.0, 1e-3])  # m/s²: 100 mGal are 2 sigma
def test_a_stated_gravity_is_right_where_the_latitude_found_says_so(anomaly):
    stated = AT_LATITUDE + anomaly
    known = {"latitude": Known(STATED_LATITUDE, 0.0), "gravity": Known(AT_STATED, 5e-4)}
    results = by_gravity(stated, AT_STATED, SHIFT)
    (gyro, accel), gravity = referred(results, replaced(stated), known)
    assert gyro is results[0] and set(gravity) == {"1"}
    np.testing.assert_allclose(values(accel), RIGHT, atol=1e-12)
    assert accel.chosen.rows[0]["sigma"] == SIGMA


@pytest.mark.parametrize("unit", [True, False])
def test_else_gravity_is_that_of_the_latitude_found(unit):
    """The unit g is a gravity of neither latitude, or none was stated."""
    known = {"latitude": Known(STATED_LATITUDE, 0.0), "gravity": Known(AT_STATED, 5e-4)}
    explained = replaced(9.80665) if unit else alone()
    (_, accel), gravity = referred(by_gravity(AT_LATITUDE, AT_STATED, SHIFT), explained, known)
    assert gravity["1"].moved == pytest.approx(1 / SIGMA * (AT_STATED / AT_LATITUDE - 1), rel=0.02)
    # The formula at 0.3° of latitude: 5.2 mm/s² (1 − cos 2φ)′/2 = 2.4e-4 m/s², 25 ppm.
    np.testing.assert_allclose(values(accel), RIGHT, atol=2e-6)
    assert accel.chosen.rows[0]["sigma"] == pytest.approx(2.5e-5, rel=0.2)
    assert accel.chosen.covariance[0, 8] == pytest.approx(2.4e-5**2, rel=0.3)


@pytest.mark.parametrize(("shift", "is_wrong"), [(SHIFT, True), (SHIFT / 10, False)])
def test_a_stated_gravity_of_the_wrong_latitude_is_wrong_too(shift, is_wrong):
    """A tenth of the shift changes gravity by 30 mGal, less than an anomaly."""
    known = {"latitude": Known(STATED_LATITUDE, 0.0), "gravity": Known(AT_STATED, 2e-6)}
    results = by_gravity(AT_LATITUDE, AT_STATED, shift)
    (_, accel), gravity = referred(results, alone(), known)
    assert bool(gravity) == is_wrong
    np.testing.assert_allclose(
        values(accel), RIGHT if is_wrong else values(results[1]), atol=2e-6 if is_wrong else 0
    )
    # Anomalies are 51 ppm.
    assert accel.chosen.rows[0]["sigma"] == pytest.approx(5.8e-5 if is_wrong else SIGMA, rel=0.05)

"""The result that counts: the rows of a candidate, or of a mixture where members disagree."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inertial.estimation.triad import linear_names
from stages.diagnosis.result import result_of

Row = dict[str, Any]
SIGMA = 2.0


def rows(method: str, value: float | None, *effects: str) -> list[Row]:
    shared = {"stage": "extension", "mount": "lying", "sensor": "gyro", "method": method}
    shared |= {"unit": "1", "frame": "body", "meaning": "", "reason": ""}
    named = [(name, None, value) for name in linear_names()]
    named += [(f"{effect}.k", effect, 7.0) for effect in effects]
    return [
        shared
        | {"id": f"{method}/{name}", "parameter": name, "effect": effect, "value": number}
        | {"sigma": None if number is None else SIGMA}
        for name, effect, number in named
    ]


def covariance(*of: list[Row]) -> dict[tuple[str, str], float]:
    return {
        (one["id"], other["id"]): SIGMA**2 * (1.0 if one is other else 0.1)
        for own in of
        for one in own
        for other in own
        if one["sigma"] and other["sigma"]
    }


def made(values: tuple[float, float | None], **probability: float) -> Any:
    parameters = {
        "extended": rows("extended", values[0], "gyro_bias_ramp"),
        "member_1": rows("member_1", values[1], "gyro_warm_up"),
    }
    return result_of("extended", parameters, covariance(*parameters.values()), probability)


def test_one_result_is_handed_on_with_ids_of_its_own():
    result = made((3.0, 99.0), extended=1.0)
    assert result.method == "extended" and len(result.rows) == 13
    first, effect = result.rows[0], result.rows[-1]
    assert (first["id"], first["stage"]) == ("diagnosis/gyroscope@lying/scale_x", "diagnosis")
    assert (first["value"], first["sigma"], effect["effect"]) == (3.0, SIGMA, "gyro_bias_ramp")
    table = result.covariance_rows().set_index(["first", "second"])["covariance"]
    assert len(table) == 13**2
    assert table[first["id"], first["id"]] == SIGMA**2
    assert table[first["id"], effect["id"]] == pytest.approx(0.1 * SIGMA**2)


def test_members_within_a_sigma_stay_one_result():
    assert made((3.0, 4.9), extended=0.6, member_1=0.4).method == "extended"


def test_members_that_disagree_are_mixed():
    result = made((3.0, 13.0), extended=0.6, member_1=0.4)
    assert result.method == "mixture" and {row["method"] for row in result.rows} == {"mixture"}
    first, effect = result.rows[0], result.rows[-1]
    assert first["value"] == pytest.approx(7.0)  # 0.6 · 3 + 0.4 · 13
    # Within: 4; between: 0.6 · 16 + 0.4 · 36 = 24.
    assert first["sigma"] == pytest.approx(np.sqrt(28.0))
    assert (effect["effect"], effect["value"], effect["sigma"]) == ("gyro_bias_ramp", 7.0, SIGMA)
    table = result.covariance_rows().set_index(["first", "second"])["covariance"]
    assert table[first["id"], first["id"]] == pytest.approx(28.0)
    assert table[first["id"], effect["id"]] == pytest.approx(0.6 * 0.1 * SIGMA**2)


def test_drifts_are_compared_and_mixed_by_their_means():
    """A ramp of 7 a unit whose bias is that of its beginning, 3: on average 3 + 2 · 7 = 17."""
    ramp, other = rows("extended", 3.0, "gyro_bias_ramp"), rows("member_1", 3.0, "gyro_warm_up")
    parameters, bias = {"extended": ramp, "member_1": other}, linear_names().index("bias_x")
    weights = {"extended": 0.6, "member_1": 0.4}

    def result(mean: float) -> Any:
        means = {"extended": {("gyro_bias_ramp.k", "bias_x"): 2.0}}
        means["member_1"] = {("gyro_warm_up.k", "bias_x"): mean}
        return result_of("extended", parameters, covariance(ramp, other), weights, means)

    assert result(2.0).method == "extended"  # they agree
    mixed = result(4.0)  # 3 + 4 · 7 = 31; the mixture is 0.6 · 17 + 0.4 · 31 = 22.6 on average
    assert mixed.method == "mixture"
    assert mixed.rows[bias]["value"] == pytest.approx(22.6 - 2 * 7)
    assert [row["value"] for row in mixed.rows if row["parameter"] != "bias_x"] == [*[3] * 11, 7]
    # The mean of each has 4 (1 + m² + 2 m 0.1) within, and 0.6 · 5.6² + 0.4 · 8.4² between them.
    mean = 0.6 * 4 * 5.4 + 0.4 * 4 * 17.8 + 0.6 * 5.6**2 + 0.4 * 8.4**2
    with_ramp = 0.6 * 4 * (0.1 + 2)
    assert mixed.rows[bias]["sigma"] ** 2 == pytest.approx(mean - 4 * with_ramp + 4 * 4)


def test_what_a_member_does_not_determine_is_not_determined():
    result = made((3.0, None), extended=0.6, member_1=0.4)
    assert {row["value"] for row in result.rows[:12]} == {None}
    assert all("determined" in row["reason"] for row in result.rows[:12])
    assert len(result.covariance_rows()) == 1  # of the effect


def test_a_constant_of_an_effect_has_no_covariance():
    parameters = {"extended": rows("extended", 3.0, "gyro_bias_jump")}
    parameters["extended"][-1]["sigma"] = None
    result = result_of("extended", parameters, covariance(*parameters.values()), {})
    assert result.rows[-1]["value"] == 7.0
    assert len(result.covariance_rows()) == 12**2


def test_a_sensor_without_a_result_has_no_rows():
    result = result_of("joint", {"joint": []}, {}, {})
    assert (list(result.rows), len(result.covariance_rows())) == ([], 0)


def test_widened_its_sigmas_and_covariances_agree():
    result = made((3.0, 99.0), extended=1.0).widened(1.5)
    assert {row["sigma"] for row in result.rows} == {1.5 * SIGMA}
    assert [row["value"] for row in result.rows] == [3.0] * 12 + [7.0]
    assert np.diag(result.covariance) == pytest.approx((1.5 * SIGMA) ** 2)
    assert made((None, None), extended=1.0).widened(1.5).rows[0]["sigma"] is None


def test_a_slip_that_a_sensor_does_not_show_is_in_its_sigmas():
    """The case has turned by θ with probability 0.2: before it M is M R(θ), as it now stands M."""
    turn, chance = np.array([2e-3, -1e-3, 5e-4]), 0.2
    own = rows("joint", None)
    matrix = np.array([[1.01, 0.002, -0.003], [0.001, 0.98, 0.004], [-0.002, 0.003, 1.02]])
    for row, value in zip(own, [*(matrix - np.eye(3)).ravel(), 0.1, 0.2, 0.3], strict=True):
        row |= {"value": float(value), "sigma": SIGMA}
    known = result_of("joint", {"joint": own}, covariance(own), {})
    result = known.turned(turn, chance)
    moved = (matrix @ Rotation.from_rotvec(turn).as_matrix() - matrix).ravel()
    values, sigmas = (np.array([row[key] for row in result.rows[:9]]) for key in ("value", "sigma"))
    expected = (matrix - np.eye(3)).ravel() + chance * moved
    np.testing.assert_allclose(values, expected, atol=2e-6)  # R to the second order of θ
    spread = (sigmas**2 - SIGMA**2) ** 0.5
    np.testing.assert_allclose(spread, 0.4 * np.abs(moved), atol=2e-6)
    assert result.method == "mixture"
    assert [row["value"] for row in result.rows[9:12]] == pytest.approx([0.1, 0.2, 0.3])

"""A ripple of the table in turns that others foretell: the same against the angle, or not."""

import numpy as np
import pytest

from inertial.campaign.steady_residuals import SteadyTurn
from stages.extension.gain import gain_of_ripple

RATE, STEP, NOISE = np.radians(10.0), 0.01, 3.5e-5  # rad/s, s, rad/s of a sample
AHEAD = np.radians(0.5 / 3600)


def turns(phases: list[float]) -> list[SteadyTurn]:
    """Turns there and back about z, rippling 36 times, each with its own phase."""
    random = np.random.default_rng(8)
    found = []
    for number, phase in enumerate(phases):
        rate = RATE * (-1) ** number
        angle = rate * STEP * (np.arange(3600) + 0.5)
        truth = NOISE * random.normal(size=(3600, 3))
        truth[:, 2] += 36 * rate * AHEAD * np.cos(36 * angle + phase)
        found.append(
            SteadyTurn(
                f"turn {number}",
                np.array([0, 0, 1.0]),
                np.eye(3),
                truth,
                np.zeros_like(truth),
                angle,
                STEP,
                averaged=False,
                tilted=False,
            )
        )
    return found


def drop(scope: str, phases: list[float], common: bool = True) -> dict[str, float]:
    values = {"n": 36.0} | ({"a": AHEAD, "b": 0.0} if common else {})
    rows = list(gain_of_ripple(turns(phases), "table_ripple", values, ""))
    (own,) = (row for table, row in rows if table == "gain" and row["scope"] == scope)
    held_out = [row for table, row in rows if table == "held_out"]
    return {**own, "not counted": [row["fold"] for row in held_out if not row["counted"]]}


def test_one_phase_against_the_angle_is_foretold_from_turn_to_turn():
    held_out, fitted = drop("held-out", [0.3] * 4), drop("fitted", [0.3] * 4)
    # Amplitude 36 RATE AHEAD in 3600 samples of each of four turns.
    expected = 4 * 3600 * (36 * RATE * AHEAD / NOISE) ** 2 / 2
    assert fitted["snr_squared"] == pytest.approx(expected, rel=0.2)
    assert held_out["drop"] == pytest.approx(held_out["snr_squared"], rel=0.1)
    assert (held_out["folds"], held_out["counted"], held_out["not counted"]) == (4, 4, [])
    assert fitted["rms_after"] == pytest.approx(1.0, abs=0.05)


def test_a_phase_of_its_own_in_each_turn_is_not():
    assert drop("held-out", [0.0, 1.6, 3.1, 4.7])["drop"] < 0


def test_but_its_amplitude_is():
    held_out = drop("held-out", [0.0, 1.6, 3.1, 4.7], common=False)
    expected = 4 * 3600 * (36 * RATE * AHEAD / NOISE) ** 2 / 2
    assert held_out["drop"] == pytest.approx(expected, rel=0.2)
    assert (held_out["folds"], held_out["counted"]) == (4, 4)


def test_an_eccentric_encoder_is_of_the_first_order_and_nothing_is_said_without_turns():
    every = list(gain_of_ripple(turns([0.0, 0.0]), "table_eccentricity", {}, "lying"))
    rows = [row for table, row in every if table == "gain"]
    assert len(rows) == 2 and {row["mount"] for _, row in every} == {"lying"}
    assert abs(rows[0]["drop"]) < 20  # there is none
    assert list(gain_of_ripple([], "table_ripple", {"n": 36.0}, "")) == []

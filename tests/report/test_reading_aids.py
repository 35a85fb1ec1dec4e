"""What the tables and figures say beside their numbers, so that nobody takes them for others."""

from __future__ import annotations

import numpy as np
import pytest

from stages.report.sections import (
    basis,
    navigation,
    noise,
    noise_by_manoeuvre,
    periodic_figures,
    residual_figures,
)
from tests.report import synthetic


def test_a_histogram_reaches_as_far_as_the_residuals() -> None:
    """Of a second mode at 3.5 σ with a spread of its own 99.9 % are below 3.5 + 3.09."""
    random = np.random.default_rng(4)
    values = np.concatenate([random.normal(size=10_000), random.normal(3.5, 1, 20_000)])
    assert residual_figures.reach_of(values) == pytest.approx(7, abs=0.5)
    assert residual_figures.reach_of(values[:10_000]) == 4.5


@pytest.mark.parametrize(
    ("level", "sigma", "marked"),
    [(0.35, 0.02, True), (0.193, 0.02, False), (0.35, 0.06, False), (0.16, 0.001, False)],
)
def test_the_noise_of_an_axis_that_turns_is_marked(
    level: float, sigma: float, marked: bool
) -> None:
    """Beside 0.15 °/√h at rest."""
    row = {"white_noise": level, "sigma": sigma}
    assert noise_by_manoeuvre.is_high(row, 0.15) == marked


def test_every_time_at_rest_that_is_not_tried_is_named() -> None:
    tables = synthetic.campaign(logs=())
    rows = tables["navigation_errors"]
    rest = rows["motion"] == "rest"
    rows.loc[rest, "seconds"], rows.loc[rest, "calibrated"] = 60.0, np.nan
    html = synthetic.section_on(tables, navigation.SECTION)
    assert "The errors after 60 s at rest are predicted" in html


def test_a_session_of_positions_has_no_time_of_the_plan() -> None:
    """Its plan states the least rest, 1 s, and not how long the session is."""
    tables = synthetic.campaign(logs=())
    plan, done = tables["manoeuvres"], tables["performed"]
    plan.loc[0, ["do", "seconds"]] = ["positions", 1.0]
    done.loc[done["manoeuvre"] == plan.loc[0, "manoeuvre"], "seconds"] = 0.0
    html = synthetic.section_on(tables, basis.RECORDED)
    row = next(line for line in html.split("<tr") if "positions, attitudes unknown" in line)
    assert ">1.0<" not in row and ">0.0<" not in row


def test_the_coefficient_beside_the_floor_of_a_data_sheet_is_explained() -> None:
    """IEEE Std 952: the floor is B √(2 ln 2/π), so that 50 µg stand beside 75.3."""
    assert 50 / np.sqrt(2 * np.log(2) / np.pi) == pytest.approx(75.3, abs=0.05)
    tables = synthetic.campaign(logs=())
    terms = tables["noise_terms"]
    terms.loc[terms["term"] == "bias_instability", "data_sheet"] = 1e-6
    html = synthetic.section_on(tables, noise.SECTION)
    assert "that floor over 0.664" in html


def test_the_angle_of_a_picture_counts_from_the_start_of_the_turn() -> None:
    """At 60 °/s² a turn is at 30 °/s after half a second, and 7.5° on."""
    turn = {"manoeuvre": "up", "rate": np.radians(-30), "acceleration": np.radians(60)}
    assert np.degrees(periodic_figures.spun_up([turn], "up")) == pytest.approx(7.5)

"""A table that jumps at one place of each turn has ripples of all whole orders, and one cause."""

from dataclasses import replace

import numpy as np
import pytest
from residuals_of_turns import ARC_SECOND, STEP, rippling, turns
from test_time_or_angle import LEVEL, LOWEST, SNR_15, found

from stages.criticism.angle_steps import step_per_turn
from stages.criticism.oscillation_results import OscillationResults
from stages.criticism.oscillation_search import find_oscillations
from stages.diagnosis.sizes_of_causes import sizes


def jumping(seed, arcsec, at, width, rates=(20, -20)):
    """Turns of a table that goes ahead by so much over `width`, °, about `at`, ° of each turn.

    Over the rest of it the table falls back evenly, as one whose encoder skips and is whole again.
    """
    made = []
    for turn in turns(seed, rates=rates):
        half = turn.rate * STEP / 2
        edges = np.append(turn.angle - half, turn.angle[-1] + half)
        since = (edges - np.radians(at - width / 2)) / (2 * np.pi)
        risen = np.floor(since) + np.minimum((since % 1) * 360 / width, 1.0)
        ahead = arcsec * ARC_SECOND * (risen - since)
        made.append(replace(turn, truth=turn.truth + np.outer(np.diff(ahead) / STEP, turn.about)))
    return made


@pytest.mark.parametrize(
    ("arcsec", "at", "width"), [(180, 115, 2.0), (-60, 300, 0.5), (30, 180, 8.0)]
)
def test_size_and_place_of_a_step_come_back(arcsec, at, width):
    step = step_per_turn(jumping(1, arcsec, at, width, (20, -20, 40)))
    assert step.turns == 9
    assert step.size / ARC_SECOND == pytest.approx(arcsec, abs=0.02 * abs(arcsec))
    assert np.degrees(step.at) == pytest.approx(at, abs=width / 4 + 0.4)
    assert np.degrees(step.width) < 2 * width + 1


def test_one_step_per_turn_is_one_cause():
    (one,) = found(jumping(3, 40, 115, 2.0))
    assert one["cause"] == "table_ripple" and one["verdict"] == "found"
    assert one["size"] == pytest.approx(40 * ARC_SECOND, rel=0.03)
    assert "at 115° of its angle since the start of each turn" in one["sentence"]
    assert "up to 40″" in one["consequence"]


def tables_of(made):
    """The rows of the search by their table."""
    tables = {}
    for table, row in OscillationResults(find_oscillations(made, LEVEL, LOWEST), "").rows():
        tables.setdefault(table, []).append(row)
    return tables


def test_the_size_that_is_shown_is_that_of_the_jump():
    """And not that of the ripple of its lowest order, 1/(πn) of it."""
    tables = tables_of(jumping(3, 400, 115, 2.0))
    [finding] = tables["findings"]
    size = sizes(tables["effects"])[finding["id"]]
    assert abs(size.value) == pytest.approx(400 * ARC_SECOND, rel=0.03)
    assert finding["snr"] == pytest.approx(abs(size.value) / size.sigma, rel=0.1)


def test_what_only_the_step_leaves_over_is_not_called_not_detected():
    """Of a large step more lines remain than are searched for: nothing is known beside them."""
    tables = tables_of(jumping(3, 400, 115, 2.0))
    (score,) = (row for row in tables["scores"] if row["effect"] == "oscillation")
    assert score["p_value"] < 1e-3 and not score["named"]
    assert "not told from the step" in score["sentence"]
    (limit,) = (row for row in tables["detection_limits"] if row["effect"] == "oscillation")
    assert limit["limit"] is None
    assert "not told from the step" in limit["explanation"]


def test_a_step_does_not_take_the_teeth_of_gears_with_it():
    """Lines of the same orders as a step has, with phases of their own."""
    orders = (26.0, 29.0, 34.0, 47.0)
    of_each = rippling(3, [(order, SNR_15) for order in orders])
    parts = 2 * ARC_SECOND * np.random.default_rng(5).standard_normal((4, 2))
    of_all = turns(3, ripples=[(order, *own) for order, own in zip(orders, parts, strict=True)])
    for made in (of_each, of_all):
        several = found(made)
        assert len(several) == 4
        assert not any("jumps" in one["sentence"] for one in several)

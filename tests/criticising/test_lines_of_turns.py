"""Oscillations of turns are found, bound to time or to the table's angle; noise is silent."""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import chain
import numpy as np
import pandas as pd
import pytest
from residuals_of_turns import ARC_SECOND, MATRIX, NOISE, line, locked, turns

from inertial import tables
from inertial.campaign.steady_residuals import SteadyTurn
from stages.criticism.oscillation_removal import without_lines
from stages.criticism.oscillation_results import OscillationResults
from stages.criticism.oscillation_search import find_oscillations

LEVEL = 1e-3  # of the spectrum: a tenth of the accepted one in a hundred
LOWEST = 2.0  # Hz
A, B = 0.3 * ARC_SECOND, 0.4 * ARC_SECOND
RINGING = (20.013, 0.01, "x")
TWO_RATES = (20, -20, 30)


Rows = dict[str, list[Mapping[str, Any]]]


def said(made: list[SteadyTurn]) -> Rows:
    """The rows by table."""
    rows: Rows = defaultdict(list)
    for table, row in OscillationResults(find_oscillations(made, LEVEL, LOWEST), "").rows():
        rows[table].append(row)
    return rows


def members(rows: Rows, finding: Mapping[str, Any]) -> list[str]:
    return [row["effect"] for row in rows["members"] if row["finding"] == finding["id"]]


def named(made: list[SteadyTurn]) -> dict[str, Mapping[str, Any]]:
    return {finding["cause"]: finding for finding in said(made)["findings"]}


def estimated(lines: Rows) -> dict[tuple[str, str], tuple[float, float]]:
    rows = [row for row in lines["effects"] if row["value"] is not None]
    return {(row["effect"], row["parameter"]): (row["value"], row["sigma"]) for row in rows}


def assert_near(found: tuple[float, float], true: float) -> None:
    assert abs(found[0] - true) < 4 * found[1]


@pytest.mark.parametrize("order", [36.0, 7.25])
def test_a_ripple_is_found_with_its_order_and_its_parts(order):
    a, b = 36 / order * A, 36 / order * B
    lines = said(turns(2, ripples=[(order, a, b)], rates=TWO_RATES))
    (finding,) = lines["findings"]
    assert [finding["cause"]] == members(lines, finding) == ["table_ripple"]
    assert finding["verdict"] == "found" and finding["p_value"] < 1e-9
    values = estimated(lines)
    assert_near(values["table_ripple", "n"], order)
    assert_near(values["table_ripple", "a"], a)
    assert_near(values["table_ripple", "b"], b)
    assert values["table_ripple", "n"][1] < 0.05


def test_the_sigmas_of_a_ripple_are_true():
    pulls = []
    for seed in range(10):
        values = estimated(said(turns(seed, ripples=[(36.1, A, B)], rates=(60, -60), axes="xy")))
        truth = {"a": A, "b": B, "n": 36.1}
        found = {name: values["table_ripple", name] for name in truth}
        pulls += [(found[name][0] - truth[name]) / found[name][1] for name in truth]
    assert 0.65 < np.std(pulls) < 1.4
    assert np.abs(pulls).max() < 4


def test_what_rings_in_time_is_an_oscillation_about_its_axis():
    lines = said(turns(3, ringing=[RINGING]))
    (finding,) = lines["findings"]
    assert [finding["cause"]] == members(lines, finding) == ["oscillation"]
    assert "oscillates about x" in finding["sentence"]
    assert "order 360.2" in finding["sentence"]  # what it would be against the angle
    assert_near(estimated(lines)["oscillation", "frequency"], RINGING[0])
    assert_near(estimated(lines)["oscillation", "amplitude"], RINGING[1])


def test_several_are_told_apart_at_once():
    ripples = [(36.0, A, B), (1.0, 20 * ARC_SECOND, -20 * ARC_SECOND)]
    lines = said(turns(8, ripples=ripples, ringing=[RINGING], rates=TWO_RATES))
    assert {finding["cause"] for finding in lines["findings"]} == {
        "oscillation",
        "table_ripple",
        "table_eccentricity",
    }
    values = estimated(lines)
    assert_near(values["table_ripple", "a"], A)
    assert_near(values["table_eccentricity", "a"], 20 * ARC_SECOND)
    assert_near(values["table_eccentricity", "b"], -20 * ARC_SECOND)
    assert_near(values["oscillation", "frequency"], RINGING[0])
    rows = lines["lines"]
    tables.LINES.arrow(pd.DataFrame(rows))
    assert {row["effect"] for row in rows} - {None} == {one for one, _ in values}
    for row in rows:
        if row["effect"] == "table_ripple":
            assert row["order"] == pytest.approx(36, abs=0.2)
            assert row["axis"] == row["manoeuvre"][0]  # the axis that the table turns about


def test_an_eccentricity_that_is_too_small_is_a_blind_spot():
    assert set(named(turns(6, ripples=[(1.0, 20 * ARC_SECOND, 0.0)]))) == {"table_eccentricity"}
    lines = said(turns(6, ripples=[(1.0, 1.0 * ARC_SECOND, 0.0)]))
    assert not list(lines["findings"])
    (spot,) = [
        row
        for row in lines["detection_limits"]
        if row["effect"] == "table_eccentricity" and row["parameter"] == "a"
    ]
    assert 2 * ARC_SECOND < spot["limit"] < 10 * ARC_SECOND
    assert "0.89 of its periods" in spot["sentence"]


def test_a_blind_spot_is_five_sigma_of_what_is_found():
    lines = said(turns(2, ripples=[(36.0, A, B)]))
    sigma = estimated(lines)["table_ripple", "a"][1]
    (spot,) = [
        row
        for row in lines["detection_limits"]
        if row["effect"] == "table_ripple" and row["parameter"] == "a"
    ]
    # Sigma goes as one over the order: the spot is told for the middle of 1.5 to 60.
    assert spot["limit"] * 30.75 / 36 == pytest.approx(5 * sigma, rel=0.1)
    assert spot["smallest"] * 60 / 36 == pytest.approx(5 * sigma, rel=0.1)
    assert spot["largest"] > 10 * spot["limit"]


@pytest.mark.slow
def test_noise_is_silent():
    for seed in range(20):
        assert not named(turns(seed, rates=(40, -40))), seed


@pytest.mark.slow
def test_a_random_walk_of_the_biases_is_no_ripple():
    for seed in range(12):
        assert not named(turns(100 + seed, rates=(40, -40), walk=1e-5)), seed


def test_an_oscillation_that_begins_with_each_turn_is_not_taken_for_a_ripple():
    """20 Hz are 360 periods in a turn at 20 °/s; about one axis of the case, whatever turns."""
    findings = named(locked(5, 20.0, 1e-3, "x"))
    assert set(findings) == {"oscillation"}
    assert findings["oscillation"]["verdict"] == "found"


def test_a_ripple_of_the_order_of_an_oscillation_may_be_either_at_one_rate():
    findings = named(turns(5, ripples=[(360.0, A, B)]))
    assert set(findings) == {"table_ripple"}
    assert findings["table_ripple"]["verdict"] == "one_of_class"
    assert "20.000 Hz" in findings["table_ripple"]["sentence"]


def test_two_rates_tell_time_from_angle():
    rates = (20, -20, 50)
    assert set(named(turns(7, ripples=[(36.0, A, B)], rates=rates))) == {"table_ripple"}
    findings = named(turns(7, ringing=[(20.0, 5e-5, "y")], rates=rates))
    assert set(findings) == {"oscillation"}
    assert "(order 360.0)" in findings["oscillation"]["sentence"]


def test_what_no_turn_shows_by_itself_all_show_together():
    """A signal-to-noise ratio of 5 in each of six turns, with phases by chance."""
    size = 5 * NOISE / np.sqrt(1600 / 2)
    findings = named(turns(4, ringing=[(20.3, size, "z")]))
    assert set(findings) == {"oscillation"}
    assert "oscillates about z" in findings["oscillation"]["sentence"]
    assert findings["oscillation"]["p_value"] < 1e-6


def test_one_turn_cannot_tell_time_from_angle_and_another_rate_would():
    lines = said(turns(9, ripples=[(36.0, A, B)], rates=(20,), axes="x"))
    (finding,) = lines["findings"]
    assert finding["verdict"] == "one_of_class"
    assert set(members(lines, finding)) == {"oscillation", "table_ripple"}
    assert "twice the rate" in finding["split_manoeuvre"] and finding["split_snr"] > 10
    scores = {row["effect"]: row for row in lines["scores"]}
    assert sum(row["named"] for row in scores.values()) == 1
    # A slow ripple is not told from a drift by one turn.
    assert scores["table_eccentricity"]["degrees"] is None


def test_the_axis_that_only_sees_it_by_coupling_is_named_so():
    (found,) = find_oscillations(turns(3, ringing=[RINGING]), LEVEL, LOWEST).oscillations
    assert found.likeliest.axis == "x"
    for one in found.coupled:
        expected = RINGING[1] * abs(MATRIX["xyz".index(one.axis), 0])
        assert one.expected == pytest.approx(expected, rel=1e-3)
        assert one.read == pytest.approx(expected, abs=3e-6) and not one.exceeds
    also = [RINGING, (RINGING[0], 3e-4, "z")]
    (found,) = find_oscillations(turns(3, ringing=also), LEVEL, LOWEST).oscillations
    more = {one.axis: one.exceeds for one in found.coupled}
    assert found.likeliest.axis == "x" and more == {"y": False, "z": True}


def test_gravity_that_goes_round_in_the_case_is_no_eccentricity():
    """A g-sensitivity of 1 °/h/g in turns about a level axis; it does not go with the rate."""
    made = []
    for turn in turns(4):
        felt = 1e-5 * np.outer(np.cos(turn.angle), turn.about)
        made.append(replace(turn, truth=turn.truth + felt, tilted=True))
    assert not named(made)
    assert set(named([replace(turn, tilted=False) for turn in made]))  # else this shows nothing


def test_where_the_gyros_tell_the_angle_their_residuals_tell_no_ripple():
    """The residuals about the table's axis are then nothing; those across it are as they are."""
    made = []
    for turn in turns(4, ringing=[(20.0, 1e-3, "x")]):
        nothing = turn.truth * (1 - np.abs(turn.about)) + 1e-9 * turn.truth * np.abs(turn.about)
        made.append(replace(turn, truth=nothing, angle=np.full(len(nothing), np.nan)))
    (finding,) = said(made)["findings"]
    assert finding["cause"] == "oscillation" and finding["verdict"] == "found"
    assert finding["size"] == pytest.approx(1e-3, rel=0.01)
    assert "y 20, y -20, z 20, z -20" in finding["sentence"]
    scores = {row["effect"]: row for row in said(made)["scores"]}
    assert scores["table_ripple"]["degrees"] is None
    assert "rate and acceleration are stated" in scores["table_ripple"]["sentence"]


def test_without_a_turn_it_says_so():
    for row in said([])["scores"]:
        assert not row["named"]
        assert row["degrees"] is row["statistic"] is row["p_value"] is None
        assert "no whole turn at a steady rate" in row["sentence"]
        assert ("sought in the recording" in row["sentence"]) == (row["effect"] == "oscillation")


@pytest.mark.slow
def test_what_the_laboratory_hides_in_a_campaign_is_named():
    effects = {
        "table_ripple": {"order": 36, "amplitude_arcsec": 0.5, "phase_deg": 30},
        "oscillation": {"frequency_hz": 20, "amplitude_rad_s": 0.01, "axis": "+x"},
    }
    document = chain.short(effects=effects, seed=5)
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    scores = results["criticism/scores"].set_index("effect")
    assert scores["named"][["table_ripple", "oscillation"]].all()
    assert not scores.loc["table_eccentricity", "named"]
    values = results["criticism/effects"].set_index(["effect", "parameter"])
    for parameter, true in {
        "n": 36.0,
        "a": 0.5 * ARC_SECOND * np.cos(np.pi / 6),
        "b": 0.5 * ARC_SECOND * np.sin(np.pi / 6),
    }.items():
        found = values.loc["table_ripple", parameter]
        assert_near((found["value"], found["sigma"]), true)
    causes = results["criticism/findings"].set_index("cause")
    # The case tips by 16″ into the table's rate, which no cross term tells.
    assert "is expected as the case tilts" in causes.loc["oscillation", "sentence"]


def test_a_line_in_time_is_removed_from_the_accelerometers_too():
    """What shakes the case is in their blocks as well, with a phase of its own in each turn.

    7.3 Hz in a block of 0.2 s is 0.2 of the amplitude; of the noise is removed no more than that
    of two of 1700 parts.
    """
    rng = np.random.default_rng(5)
    noise, size, hertz, long = 0.01, 0.05, 7.3, 20
    shaken, blocks, free = [], [], []
    for turn in turns(61, ringing=[(hertz, 4e-4, "y")]):
        n = len(turn.truth) // long * long
        turn = replace(turn, truth=turn.truth[:n], angle=turn.angle[:n], start=100.0)
        still = noise * rng.standard_normal((n, 3))
        force = still.copy()
        force[:, 0] += line(n, hertz, size, rng.uniform(0, 2 * np.pi))
        shaken.append(replace(turn, force=force))
        means = force.reshape(-1, long, 3).mean(axis=1)
        middle = turn.start + (np.arange(len(means)) * long + (long - 1) / 2) * turn.step
        own = {"manoeuvre": turn.name, "phase": "steady", "time": middle, "count": long}
        of_force = dict(zip(tables.ACCEL, means.T, strict=True))
        blocks.append(
            pd.DataFrame(own | {"seconds": 0.2} | dict.fromkeys(tables.GYRO, 0.0) | of_force)
        )
        free.append(still.reshape(-1, long, 3).mean(axis=1))
    read = pd.concat(blocks, ignore_index=True)
    lines = find_oscillations(shaken, LEVEL, LOWEST).oscillations
    quiet = without_lines(read, [], shaken, lines)[[*tables.ACCEL]].to_numpy()
    truth = np.concatenate(free)
    before = (read[[*tables.ACCEL]].to_numpy() - truth).std(axis=0)
    left = (quiet - truth).std(axis=0)
    assert before[0] > 2 * noise / np.sqrt(long)
    assert (left < 0.1 * noise / np.sqrt(long)).all()


def test_of_a_table_that_is_simulated_at_rest_rounding_is_no_rate():
    """Angles that change by rounding alone have no order: of half the sample rate it is endless."""
    *made, last = turns(9)
    standing = replace(last, angle=last.angle[0] + 1e-16 * np.arange(len(last.angle)))
    assert np.isnan(standing.rate)
    assert not said([*made, standing])["findings"]

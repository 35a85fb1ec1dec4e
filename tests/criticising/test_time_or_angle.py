"""The frequency over all turns tells what is bound to time from what is bound to the angle."""

from collections.abc import Sequence
from typing import Any

import chain
import numpy as np
import pytest
from residuals_of_turns import NOISE, rippling, turns

from inertial.campaign.steady_residuals import SteadyTurn
from stages.criticism.oscillation_results import OscillationResults
from stages.criticism.oscillation_search import find_oscillations

LEVEL, LOWEST = 1e-3, 2.0  # of false alarm; Hz
TWO_RATES = (20, -20, 40, -40)
SLOW = (6, -6, 12, -12)  # 36 cycles per turn: 0.6 and 1.2 Hz
SAMPLES = 1600  # in a turn at 20 °/s
SNR_15 = 15 * NOISE * np.sqrt(2 / SAMPLES)  # rad/s, amplitude of a ratio of 15 in such a turn
BOTH = {"oscillation", "table_ripple"}
# The others of its cases are drawn as the first.
SEEDS = [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2, 3))]


def found(made: Sequence[SteadyTurn]) -> list[dict[str, Any]]:
    """The findings, each with the effects that it may be and its manoeuvres."""
    rows: dict[str, list[Any]] = {"findings": [], "members": [], "effects": [], "lines": []}
    for table, row in OscillationResults(find_oscillations(made, LEVEL, LOWEST), "").rows():
        rows.setdefault(table, []).append(row)
    return [
        {
            **row,
            "members": {m["effect"] for m in rows["members"] if m["finding"] == row["id"]},
            "in": {line["manoeuvre"] for line in rows["lines"] if line["finding"] == row["id"]},
            "values": {e["parameter"]: e for e in rows["effects"] if e["finding"] == row["id"]},
        }
        for row in rows["findings"]
    ]


@pytest.mark.parametrize(
    "power", [0.0, *(pytest.param(p, marks=pytest.mark.slow) for p in (1.0, -1.0))]
)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_ripple_is_one_whatever_its_amplitude_does_with_the_rate(seed, power):
    (one,) = found(rippling(seed, [(36.0, 5e-5)], power, SLOW))
    assert one["cause"] == "table_ripple" and one["verdict"] == "found"
    assert len(one["in"]) == 12 and "36 times" in one["sentence"]
    order = one["values"]["n"]
    assert abs(order["value"] - 36.0) < 4 * order["sigma"] < 0.1
    # The angle of each turn is size / (36 · rate), its rms over turns weighted by power.
    angle = 5e-5 / (36 * np.radians(6)) * np.array([1.0, 2 ** (power - 1)])
    rms = np.sqrt(np.average(angle**2, weights=[1.0, 2.0]))
    assert one["size"] == pytest.approx(rms, rel=0.05)


@pytest.mark.parametrize("seed", SEEDS)
def test_an_oscillation_has_one_frequency_at_two_rates(seed):
    (one,) = found(turns(seed, ringing=[(0.6, 1e-4, "y")], rates=SLOW))
    assert one["cause"] == "oscillation" and one["verdict"] == "found"
    assert len(one["in"]) == 12
    frequency = one["values"]["frequency"]
    assert abs(frequency["value"] - 0.6) < 4 * frequency["sigma"] < 1e-3


@pytest.mark.parametrize("seed", SEEDS)
def test_at_one_rate_a_line_about_the_tables_axis_may_be_either(seed):
    (one,) = found(rippling(seed, [(36.0, SNR_15)], rates=(20, -20)))
    assert one["verdict"] == "one_of_class" and one["members"] == BOTH
    assert "twice the rate" in one["split_manoeuvre"]


@pytest.mark.parametrize("seed", SEEDS[:3])
def test_a_line_that_turns_of_one_rate_alone_show_may_be_either(seed):
    """At the other rate it is lost in the noise."""
    (one,) = found(rippling(seed, [(36.0, 0.02 * SNR_15)], 6.0, TWO_RATES))
    assert one["verdict"] == "one_of_class" and one["members"] == BOTH


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_near_the_limit_it_is_still_told(seed):
    """A ratio of 5 in each turn: hardly one is significant alone."""
    for power in (0.5, 1.0):  # at twice the rate a turn is half as long
        (one,) = found(rippling(seed, [(90.0, SNR_15 / 3)], power, TWO_RATES))
        assert one["members"] == {"table_ripple"}
    (one,) = found(turns(seed, ringing=[(7.3, SNR_15 / 3, "x")], rates=TWO_RATES))
    assert one["members"] == {"oscillation"}


@pytest.mark.slow
def test_multiples_of_one_order_are_one_finding_and_other_orders_another():
    (one,) = found(rippling(3, [(36.0, SNR_15), (72.0, SNR_15), (108.0, SNR_15)]))
    assert "36 times" in one["sentence"] and "108.0" in one["sentence"]
    two = found(rippling(3, [(36.0, SNR_15), (50.0, SNR_15)]))
    assert [one["cause"] for one in two] == ["table_ripple"] * 2


@pytest.mark.slow
def test_multiples_of_one_frequency_are_one_finding_and_other_frequencies_another():
    harmonics = [(13.7, SNR_15, "x"), (27.4, SNR_15, "x"), (41.1, SNR_15, "x")]
    (one,) = found(turns(4, ringing=harmonics, rates=TWO_RATES))
    assert one["cause"] == "oscillation" and "41.1" in one["sentence"]
    # Beyond 50 Hz, half the sample rate, three times 21.1 Hz shows at 36.7 Hz.
    (one,) = found(turns(4, ringing=[(21.1, 1e-4, "x"), (42.2, 1e-4, "x"), (36.7, 1e-4, "x")]))
    assert one["cause"] == "oscillation"
    two = found(turns(4, ringing=[(13.7, SNR_15, "x"), (22.4, SNR_15, "y")], rates=TWO_RATES))
    assert [one["cause"] for one in two] == ["oscillation"] * 2


def test_a_ripple_beyond_half_the_sample_rate_of_fast_turns_is_one():
    """Order 480: 26.7 Hz at 20 °/s; 80 Hz at 60 °/s, which samples at 100 Hz show at 20 Hz."""
    (one,) = found(rippling(5, [(480.0, 3e-4)], 0.0, (20, -20, 60, -60)))
    assert one["cause"] == "table_ripple" and one["members"] == {"table_ripple"}


def test_an_oscillation_that_several_gyros_see_is_one():
    seen = [(20.3, 1e-3, "x"), (20.3, 7e-4, "y"), (20.3, 2e-4, "z")]
    (one,) = found(turns(6, ringing=seen, rates=TWO_RATES))
    assert one["cause"] == "oscillation" and "about x" in one["sentence"]


def two_rates(**changes: Any) -> dict[str, Any]:
    """The short campaign with turns at 30 and at 60 °/s."""
    document = chain.short(**changes)
    plan = document["campaign"]["plan"]
    slow = [
        {**m, "id": f"{m['id']}-slow", "rate_deg_s": 30, "log": f"{m['id']}-slow.asc"}
        for m in plan
        if m["do"] == "turn"
    ]
    document["campaign"]["plan"] = [*plan, *slow]
    return document


RIPPLE = {"order": 36, "amplitude_arcsec": 0.7, "phase_deg": 50, "at_rate_deg_s": 30}


@pytest.mark.slow
@pytest.mark.parametrize("power", [0, -1, -2])
def test_the_ripple_of_the_laboratory(power):
    """Its rate goes with the table's; is the same at both; is the inverse."""
    effects = {"table_ripple": {**RIPPLE, "rate_power": power}}
    document = two_rates(effects=effects, seed=40 - power)
    results = chain.in_memory_of(document, "extension", chain.BESIDE)
    (one,) = results["criticism/findings"].to_dict("records")
    assert (one["cause"], one["verdict"]) == ("table_ripple", "found")
    assert results["criticism/lines"].query("finding == @one['id']")["manoeuvre"].nunique() == 12
    assert 0 <= one["moves"] < 0.5  # whole turns are free of it
    gain = results["extension/gain"].query("model == 'table_ripple'").set_index("scope")
    assert gain.loc["held-out", "drop"] > 0.8 * gain.loc["fitted", "drop"] > 0


@pytest.mark.slow
def test_the_oscillation_of_the_laboratory():
    effects = {"oscillation": {"frequency_hz": 6, "amplitude_rad_s": 2e-4, "axis": "+z"}}
    document = two_rates(effects=effects, seed=44)
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    (one,) = results["criticism/findings"].to_dict("records")
    assert (one["cause"], one["verdict"]) == ("oscillation", "found")
    assert 0 <= one["moves"] < 0.5


def test_beside_a_bias_that_jumps_within_a_rest_an_oscillation_moves_what_it_does_without():
    """The drift that this rest shows is in the equations with the oscillation and without, or not.

    Whole turns are free of it: 3e-4 rad/s at 6 Hz are 1.6" at either end of 360°.
    """
    effects = {"oscillation": {"frequency_hz": 6, "amplitude_rad_s": 3e-4, "axis": "+x"}}
    step = {"log": "y-up.asc", "channel": "gyro_x", "line": 1000, "size_rad_s": 2e-4}
    document = chain.short(effects=effects, faults=[{"step": step}], seed=45)
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    findings = results["criticism/findings"].set_index("cause")
    assert 0 <= findings.loc["oscillation", "moves"] < 0.5

"""The scores of made-up outcomes: what counts as a false name, and what does not."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hidden_bars import bars
from hidden_named_sizes import (
    FIRST,
    MATE,
    NOTHING,
    SCANNED,
    WAYS_OF_ESTIMATING,
    Truth,
    counted,
    summed,
)
from hidden_page import write
from hidden_scores import (
    class_right,
    detected,
    false_names,
    first_name,
    gains,
    pulls,
    sets,
    unknown_or_true,
    warned,
)
from hidden_sizes import Reference
from scipy.stats import ncx2

from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.cause import Cause
from inertial.model_selection.evidence import Evidence, searched_effect


def named(cause: str, *members: str, verdict: str = "") -> dict[str, Any]:
    verdict = verdict or ("one_of_class" if members else "found")
    return {"cause": cause, "verdict": verdict, "snr": 9.0, "members": [cause, *members]}


def gain_of(hidden: str, at_stake: float = 30.0) -> dict[str, Any]:
    told = {"sensor": "gyro", "effects": hidden, "drop": 36.0}
    return told | {"at_stake": at_stake, "whole": 36.0}


def outcome(hidden: str, *causes: dict[str, Any], **more: Any) -> dict[str, Any]:
    effects = hidden.split()
    made: dict[str, Any] = {
        "number": 0,
        "plan": "positions",
        "kind": "single" if effects else "clean",
        "sort": "ratio" if effects else "plain",
        "hidden": effects,
        "ratios": dict.fromkeys(effects, 6.0),
        "on_disk": True,
        "samples": 204_000,
        "simulating": 0.5,
        "seconds": 7.0,
        "named": list(causes),
        "unexplained": [],
        "quality": [],
        "pulls": [0.5, -3.0] if effects else [],
        "curse": dict.fromkeys(effects, 1.0),
        "gain": [gain_of(hidden)] if effects else [],
        "limits": {"degrees": 3, "limit": 0.97, "textbook": 0.96},
    }
    return made | more


def test_a_cause_that_was_not_put_in_is_a_false_name():
    assert false_names(outcome("", named("lever_arm"))) == ["lever_arm"]
    beside = outcome("table_tilt", named("table_tilt"), named("lever_arm"))
    assert false_names(beside) == ["lever_arm"] and not class_right(beside)
    assert detected(beside, "table_tilt")


def test_a_class_mate_of_what_was_put_in_is_none():
    one = outcome("size_effect", named("lever_arm", "size_effect"))
    assert false_names(one) == [] and class_right(one)
    assert first_name(one) == "lever_arm"


def test_a_class_without_what_was_put_in_is_one():
    one = outcome("table_tilt", named("lever_arm", "size_effect"))
    assert false_names(one) == ["lever_arm"] and not detected(one, "table_tilt")


def test_unknown_is_no_name_and_no_detection():
    one = outcome(
        "gyro_bias_ramp", named("gyro_drift", "gyro_bias_ramp", verdict="unknown_structure")
    )
    assert false_names(one) == [] and not class_right(one)
    assert warned(one) and unknown_or_true(one) and first_name(one) == "unknown"


def test_a_walk_of_unknown_cause_is_the_truth_of_a_walk_alone():
    walk = named("gyro_random_walk", verdict="unknown_structure")
    assert detected(outcome("gyro_random_walk", walk), "gyro_random_walk")
    assert not detected(outcome("gyro_bias_ramp", walk), "gyro_bias_ramp")
    assert false_names(outcome("", walk)) == []
    # Found, and not there: that is a name.
    assert false_names(outcome("", named("gyro_random_walk"))) == ["gyro_random_walk"]


def test_silence_is_no_warning_and_no_truth():
    one = outcome("", kind="outside")
    assert not warned(one) and not unknown_or_true(one) and first_name(one) == "nothing"
    seen = outcome("", kind="outside", quality=["gap"])
    assert warned(seen) and unknown_or_true(seen)
    told_anyway = outcome("", quality=["temperature_drift"])
    assert not warned(told_anyway)


def test_quality_finds_what_the_samples_show():
    one = outcome("gyro_saturation", quality=["saturation"])
    assert detected(one, "gyro_saturation") and not detected(one, "table_tilt")


def test_one_of_two_is_not_both():
    assert not class_right(outcome("table_tilt lever_arm", named("lever_arm")))
    assert class_right(outcome("table_tilt lever_arm", named("lever_arm"), named("table_tilt")))


def test_figures_of_several():
    right, wrong = (
        outcome("table_tilt", named("table_tilt")),
        outcome("table_tilt", named("lever_arm")),
    )
    assert pulls([right, wrong]) == (2, 4)
    alone = right | {"gain": [gain_of("table_tilt", at_stake=12.0)]}
    assert gains([right, wrong, alone]) == ([pytest.approx(1.0)], 1)
    assert sets([right, wrong]) == ((1, 2), 1.0)


def test_a_bar_is_met_by_its_figures():
    def verdict(words: str, *outcomes: dict[str, Any]) -> bool | None:
        return next(bar.met for bar in bars(outcomes, []) if bar.words.startswith(words))

    clean, false = outcome(""), outcome("", named("lever_arm"))
    assert verdict("clean campaigns", *[clean] * 292, *[false] * 8) is True
    assert verdict("clean campaigns", *[clean] * 291, *[false] * 9) is False
    assert verdict("clean campaigns", *[clean] * 9, *[false] * 1) is False  # 0.27 of 10 are allowed
    right, silent = outcome("table_tilt", named("table_tilt")), outcome("table_tilt")
    wrong = outcome("table_tilt", named("lever_arm"))
    given = "class right where anything is named, SNR 6"
    assert verdict(given, *[right] * 19, wrong, *[silent] * 9) is True
    assert verdict(given, *[right] * 18, *[wrong] * 2) is False
    assert verdict("class right where anything is named, SNR 8", right) is None
    decoy, named_falsely = (
        outcome("gravity_error", *said, kind="decoy") for said in ((), (named("lever_arm"),))
    )
    assert verdict("decoys", *[decoy] * 49, named_falsely) is True
    assert verdict("decoys", *[decoy] * 48, named_falsely) is False
    assert verdict("campaigns that end", right, outcome("", error="ValueError: none")) is False
    assert verdict("CPU time", outcome("", seconds=10.5)) is False


def test_several_are_judged_on_all_and_counted_where_none_does_for_another():
    one = outcome("table_tilt lever_arm", named("table_tilt"), named("lever_arm"))
    two = outcome("table_tilt lever_arm", named("table_tilt"))
    rows = [
        row | {"kind": "several", "sort": "2 at 6 to 12", "apart": apart, "limit": 0.8}
        for row, apart in ((one, True), (two, False))
    ]
    bar = next(bar for bar in bars(rows, []) if bar.words.startswith("2 effects at once at SNR 6"))
    assert bar.met is False and "(1 of 2)" in bar.measured
    assert bar.words.endswith("(limit 0.800)")
    assert bar.measured.endswith("; 1 of 1 where none accounts for another")


def test_the_limit_of_several_is_that_of_what_the_others_leave():
    """Two columns of a tilt and three of a lever arm; their first ones have 0.8 in common."""
    common, threshold, tilt, arm = 0.8, 18.0, 6.0, 7.0
    information = np.eye(5)
    information[0, 2] = information[2, 0] = common
    said = Evidence((EffectInformation(tuple("abcde"), information, np.zeros(5), 0.0, 9),), ("",))
    asked = [searched_effect("table_tilt", [0, 1]), searched_effect("lever_arm", [2, 3, 4])]
    law = SimpleNamespace(
        tails=[SimpleNamespace(degrees=2), SimpleNamespace(degrees=3)],
        threshold=lambda number, degrees: threshold,
    )
    hidden = {one.name: one.candidates for one in asked}
    known = Reference("positions", None, said, asked, hidden, law, np.inf)
    truth = {
        name: dict(zip("pqr", size * known.typical(name), strict=False))
        for name, size in (("table_tilt", [0.0, tilt]), ("lever_arm", [0.0, arm, 0.0]))
    }
    apart = ncx2.sf(threshold, 2, tilt**2) * ncx2.sf(threshold, 3, arm**2)
    assert known.limit_together(truth, {}) == pytest.approx(apart, rel=1e-9)
    truth["table_tilt"] = dict(zip("pq", [tilt, 0.0] * known.typical("table_tilt"), strict=True))
    left = tilt**2 * (1 - common**2)
    less = ncx2.sf(threshold, 2, left) * ncx2.sf(threshold, 3, arm**2)
    assert known.limit_together(truth, {}) == pytest.approx(less, rel=1e-9)


TRUE = np.array([5.0, 0.0])


def sizes_of(draws: int) -> dict[str, dict[str, float]]:
    """Of an effect of two parameters: 8 % too large by least squares, 1 % as reported."""
    own = NOTHING | {"draws": draws, "parameters": 2 * draws}
    for way, ratio, outside, missed in zip(
        WAYS_OF_ESTIMATING, (1.08, 1.01), (2, 1), (2, 1), strict=True
    ):
        own |= {f"ratio {way}": ratio * draws, f"squares {way}": ratio**2 * draws}
        own |= {f"inside {way}": 2 * draws - outside, f"ellipsoid {way}": draws - missed}
    return {FIRST: own, MATE: dict(NOTHING), SCANNED: dict(NOTHING)}


@pytest.mark.parametrize(("draws", "met"), [(999, False), (1000, True)])
def test_the_size_of_what_is_named_is_judged_by_a_thousand_draws(draws: int, met: bool):
    rows = [{"ratio": 5.0, "limit": 0.8, "power": 1, "trials": 1, "sizes": sizes_of(draws)}]
    size, intervals = (
        next(bar for bar in bars([], rows) if bar.words.startswith(f"{what} of what is named"))
        for what in ("size", "95 % intervals")
    )
    assert size.met is met and size.measured.startswith(f"1.010 ± 0.000 of {draws}")
    assert size.measured.endswith("by least squares 1.080")
    assert intervals.met is False  # nearly all hold it, which is more than 0.97


def test_a_named_draw_counts_along_the_true_direction():
    """Two parameters, of sigma 1 and 0.5, found at (6, 1) where (5, 0) is true."""
    total = EffectInformation(("p", "q"), np.diag([1.0, 4.0]), np.array([6.0, 4.0]), 40.0, 40)
    cause = Cause(
        *("hidden", 0, "found", ("hidden",), (0,), (1.0,), (1.0,), 40.0, 2, 0.0, 6.0, (0, 1)),
        values=np.array([6.0, 1.0]),
        covariance=np.diag([1.0, 0.25]),
        threshold=36.0,
    )
    counts = counted(total, [cause], cause, (0, 1), Truth((0, 1), TRUE, TRUE, 5.0))
    assert counts["ratio least squares"] == pytest.approx(30 / 25)
    assert counts["inside least squares"] == 1  # the second is two sigma off
    assert counts["ellipsoid least squares"] == 1  # 1 + 4 < 5.99
    # Of two parameters, |z| = √40 where √36 names: nearer to the truth by 8 to 16 %.
    assert 1.0 < counts["ratio reported"] < 1.12
    # Without a threshold it is least squares, and so is another member's fit of its own columns.
    given = replace(cause, threshold=0.0)
    counts = counted(total, [given], given, (1,), Truth((0,), TRUE[:1], TRUE[:1], 5.0))
    assert counts["ratio reported"] == counts["ratio least squares"] == 0.0
    assert summed([counts, counts])["draws"] == 2


def test_the_page_tells_every_bar(tmp_path: Path):
    rows = [
        {"plan": "positions", "effect": "table_tilt", "ratio": 6.0, "trials": 10, "power": 9}
        | {"in_class": 8, "limit": 0.97, "textbook": 0.96, "degrees": 2, "seconds": 1.0}
        | {"sizes": sizes_of(8)},
        {"plan": "positions", "effect": "clean 0", "ratio": 0.0, "trials": 100, "power": 1},
    ]
    outcomes = [
        outcome(""),
        outcome("table_tilt", named("table_tilt")),
        outcome("table_tilt lever_arm", named("table_tilt"), kind="several", sort="2 at 6 to 12")
        | {"apart": True, "limit": 0.9},
        outcome("gravity_error", kind="decoy", sort="absorbed"),
        outcome("", named("lever_arm"), kind="outside", sort="gyro_telegraph"),
        outcome("oscillation", named("oscillation"), sort="elsewhere"),
    ]
    page = tmp_path / "page.md"
    told = write(outcomes, rows, page)
    text = page.read_text(encoding="utf-8")
    for bar in bars(outcomes, rows):
        assert f"| {bar.words} | {bar.wanted} | {bar.measured} | {bar.verdict} |" in text
        assert bar.words in told
    assert "| gyro_telegraph | 1 of 1 | 0 of 1 | lever_arm (1) |" in text
    assert "**0.90 / 0.97 (0.96); 0.80**" in text
    assert "| 6 | all | 8 | 1.080 → 1.010 ± 0.000 | 0.875 → 0.938 | 0.750 → 0.875 |" in text
    assert page.with_suffix(".png").stat().st_size > 10_000

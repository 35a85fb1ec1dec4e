"""A step within one rest is no drift; a drift is in all rests."""

from dataclasses import replace

import chain
import numpy as np
import pytest

from stages.noise.static_stretches import CLEAR, QUIET, Course, Step, of_one_manoeuvre

RESTS, SAMPLES = 6, 4000


def course(values: np.ndarray) -> Course:
    """In pieces of uneven length, as logs are read."""
    made = Course()
    for piece in np.split(values, [7, 900, 2500]):
        made.add(piece)
    return made


def rests(seed: int, step: float = 0.0, walk: float = 0.0) -> list[Step]:
    """White noise of 1, x also with a walk in all rests, y with a step within the third."""
    random = np.random.default_rng(seed)
    made = []
    for number in range(RESTS):
        values = random.normal(size=(SAMPLES, 3))
        values[:, 0] += walk * np.cumsum(random.normal(size=SAMPLES))
        values[SAMPLES // 3 :, 1] += step * (number == 2)
        made.append(Step(f"rest {number}", *course(values).step()))
    return made


def test_the_ratio_is_that_of_the_means_before_and_after():
    """Half of 64 means of 64 samples each: a step of d is d / √(2 · 2/4096) sigma."""
    values = np.random.default_rng(1).normal(size=(4096, 1))
    values[2048:] += 0.3
    samples, ratio = course(values).step()
    assert samples == 4096
    assert ratio[0] == pytest.approx(0.3**2 / (2 / 2048), rel=0.5)


def test_a_step_within_one_rest_alone_is_found_and_a_walk_is_none():
    for seed in range(20):
        clean, stepped = rests(seed), rests(seed, step=0.5)
        assert not of_one_manoeuvre(clean, 3).any()
        assert of_one_manoeuvre(stepped, 3).tolist() == [False, True, False]
        assert not of_one_manoeuvre(rests(seed, walk=0.02), 3).any()
        assert max(step.ratios.max() for step in clean) < CLEAR
    assert QUIET < CLEAR


def test_two_rests_that_change_are_a_drift_unless_they_are_of_one_manoeuvre():
    first, second = rests(1, step=0.5)[:4], rests(2, step=0.5)[:4]
    again = [replace(step, manoeuvre=f"again {step.manoeuvre}") for step in second]
    assert not of_one_manoeuvre([*first, *again], 3).any()
    assert of_one_manoeuvre([*first, *second], 3).tolist() == [False, True, False]


@pytest.mark.slow
def test_a_jump_within_a_rest_is_named_and_does_not_hide_itself() -> None:
    """400 µg from 20 s into the third of six rests of 40 s: 10 sigma of the two halves."""
    document = chain.short(
        seed=3, effects={"accel_bias_jump": {"size_micro_g": [400, 0, 0], "at_s": 220}}
    )
    document["noise"]["velocity_random_walk_m_s_sqrt_h"] = 0.07
    for manoeuvre in document["campaign"]["plan"]:
        if manoeuvre["do"] == "rest":
            manoeuvre["seconds"] = 40
    results = chain.in_memory_of(document, "criticism", chain.BESIDE)
    assert not results["criticism/findings"].query("cause == 'accel_random_walk'").size
    (cause,) = results["criticism/findings"].to_dict("records")
    assert cause["cause"] == "accel_bias_jump"
    found = results["criticism/effects"].set_index(["effect", "parameter"]).loc["accel_bias_jump"]
    size = found.loc["b_x"]
    assert size["value"] == pytest.approx(400e-6 * 9.80665, abs=4 * size["sigma"])

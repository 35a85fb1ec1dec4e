"""Some draws of `make challenge`: what is hidden is found, or its class is; nothing else."""

import chain
import hidden_plans
import in_memory
import numpy as np
import pandas as pd
import pytest
from hidden_campaigns import run
from hidden_courses import known_course
from hidden_draws import CYCLE, EACH_FROM, KINDS, draw
from hidden_elsewhere import ELSEWHERE
from hidden_outside import OUTSIDE
from hidden_scores import class_right, detected, false_names, truly_named, warned
from hidden_sizes import BESIDE, LEVEL, reference, size
from hidden_statistics import tried
from hidden_ways import ABSORBED, REMEMBERING, WAYS

import laboratory
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.observations import campaign_of
from inertial.effects import CATALOGUE
from inertial.model_selection.null_simulation import chance

# One of each kind, each at a size at which it must be found.
CLEAN, OF_A_CLASS, SHOWN_BY_ONE_PLAN, DECOY, TOGETHER = 13, 9, 32, 5, 24


def test_every_effect_of_the_catalogue_is_drawn():
    elsewhere = {name for one in ELSEWHERE for name in one.hidden}
    elsewhere |= {"latitude_sign"}  # a fault of what is stated: tests/diagnosis draws it
    elsewhere |= {"gyro_bias_of_position", "accel_bias_of_position"}  # a fault: tests/diagnosis
    elsewhere |= {"tumble_eccentricity"}  # of tumbles alone, turns show it first: tests/diagnosis
    elsewhere |= {"mounting_slip"}  # of one turn: tests/criticising
    elsewhere |= {"gyro_scale_jump"}  # of a plan that is performed twice: tests/criticising
    # of turns one after another in one sense, about oblique axes, and by a table that shakes
    elsewhere |= {"table_backlash", "gyro_rate_products", "gyro_cross_axis_squares"}
    elsewhere |= {"gyro_vibration_rectification"}  # these too: tests/criticising
    assert set(CATALOGUE) == set(WAYS) | elsewhere | set(ABSORBED)


def test_the_kinds_are_drawn_as_often_as_is_wanted():
    wanted = {"clean": 0.25, "single": 0.35, "decoy": 0.15, "several": 0.15, "outside": 0.10}
    assert {kind: KINDS.count(kind) / CYCLE for kind in wanted} == wanted
    assert OUTSIDE and len({one.name for one in OUTSIDE}) == len(OUTSIDE)


@pytest.mark.slow
@pytest.mark.parametrize(
    "plan",
    list(hidden_plans.PLANS),
)
def test_a_plan_shows_what_is_hidden_in_it(plan):
    """What is hidden there is seen, and noise alone makes a name of it as often as allowed."""
    known = reference(plan)
    for name, way in WAYS.items():
        if plan in way.plans:
            limits = known.limits(name, 8.0)
            assert limits["limit"] > 0.95 and limits["textbook"] > 0.95, name
            if way.scan is None:  # the laboratory and the model have the same law, or nearly
                assert known.left(name, None, known.typical(name), name) < 0.05, name
    # 50 of 20 000 fresh draws are expected below the share, which is from 5000.
    information = known.said.observable().total.information
    fresh = chance(information, known.asked, LEVEL, draws=20_000, seed=1).smallest
    assert np.mean(fresh < known.law.share) == pytest.approx(LEVEL, rel=0.4)


@pytest.mark.slow
def test_a_draw_can_be_made_again_and_is_as_large_as_it_says():
    for one in (draw(number, size) for number in range(CYCLE)):
        assert one == draw(one.number, size)
        laboratory.specify(one.document())
        for name, values in one.truth.items():
            if name in REMEMBERING:
                continue
            told = size(one.plan, name, one.at.get(name), np.array([*values.values()]))
            assert told == pytest.approx(one.ratios[name])
    assert draw(1, size).effects != draw(1 + CYCLE, size).effects


@pytest.mark.slow
def test_what_remembers_forces_is_as_large_as_it_says_by_its_own_moves():
    """By the equations of its own campaign; by the moves of the reference it is another size."""
    for name in REMEMBERING:
        one = draw(EACH_FROM + list(WAYS).index(name) + 4 * len(WAYS), size)
        hidden, plain = (
            laboratory.perform(laboratory.specify(one.document(effects=effects)))
            for effects in (one.effects, {})
        )
        (data,) = chain.mounts(chain.in_memory(plain, "gyroscope", BESIDE))
        course = known_course("known_course", [hidden], plain)
        told = evidence(campaign_of(data), [course]).total.information[0, 0] ** 0.5
        assert told == pytest.approx(one.ratios[name], rel=0.03)
        by_the_reference = size(one.plan, name, None, np.array([*one.truth[name].values()]))
        assert abs(by_the_reference - told) > 0.2 * told


@pytest.mark.slow
def test_in_memory_is_as_on_disk(tmp_path):
    """The readers hand over what the bytes say, also of a log with a temperature."""
    document = chain.short(seed=3)
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    columns = document | {"receiver": document["receiver"] | {"message": "columns"}}
    columns["temperature"] = {"start_deg_c": 20, "slope_k_h": 60}
    for name, told in (("counts", chain.short(seed=3)), ("columns", columns)):
        recording = laboratory.perform(laboratory.specify(told))
        laboratory.write(recording, tmp_path / name / "raw")
        one = chain.run(tmp_path / name / "raw", tmp_path / name / "on-disk", "decode")
        with in_memory.recorded(recording, tmp_path / name / "none" / "raw") as raw:
            other = chain.run(raw, tmp_path / name / "in-memory", "decode")
        for table in ("samples", "clocks"):
            left, right = one[f"decode/{table}"], other[f"decode/{table}"]
            offsets = ["offset"] if table == "samples" else []
            assert left.drop(columns=offsets).equals(right.drop(columns=offsets))


@pytest.mark.slow
def test_a_run_in_memory_has_the_tables_of_one_on_disk(tmp_path):
    recording = laboratory.perform(laboratory.specify(chain.short(seed=4)))
    laboratory.write(recording, tmp_path / "raw")
    disk = chain.run(tmp_path / "raw", tmp_path / "derived", "diagnosis", BESIDE)
    memory = chain.in_memory(recording, "diagnosis", BESIDE)
    of_bytes = ("plan/", "decode/")  # these tell sizes and hashes of files too
    compared = [name for name in memory if not name.startswith(of_bytes)]
    assert len(compared) > 40
    for name in compared:
        pd.testing.assert_frame_equal(memory[name], disk[name], obj=name)


@pytest.mark.slow
def test_nothing_is_named_where_nothing_is_hidden():
    one = draw(CLEAN, size)
    assert one.kind == "clean" and not one.hidden
    outcome = run(one)
    assert not outcome.get("error") and false_names(outcome) == []


@pytest.mark.slow
@pytest.mark.parametrize("number", [OF_A_CLASS, SHOWN_BY_ONE_PLAN])
def test_a_single_effect_is_named_with_its_class(number):
    one = draw(number, size)
    assert one.kind == "single" and min(one.ratios.values()) > 9.9
    outcome = run(one)
    assert class_right(outcome), outcome["named"]
    assert outcome["on_disk"] == one.on_disk and outcome["limits"]["limit"] > 0.99


@pytest.mark.slow
def test_a_decoy_is_not_named():
    one = draw(DECOY, size)
    assert one.sort == "absorbed"
    assert false_names(run(one)) == []


@pytest.mark.slow
def test_effects_at_once_are_all_named():
    one = draw(TOGETHER, size)
    assert one.kind == "several" and min(one.ratios.values()) >= 12
    outcome = run(one)
    assert class_right(outcome), outcome["named"]
    assert all(detected(outcome, effect) for effect in one.effects)


@pytest.mark.slow
def test_what_is_sought_elsewhere_is_found():
    one = draw(17, size)
    assert one.sort == "elsewhere" and truly_named(run(one))


@pytest.mark.slow
def test_of_what_is_in_no_catalogue_there_is_a_warning():
    one = draw(59, size)
    assert one.kind == "outside" and min(one.ratios.values()) >= 12
    assert warned(run(one))


@pytest.mark.slow
def test_power_on_sufficient_statistics_reaches_its_limit():
    counted = tried("positions", "gyro_bias_ramp", 6.0, 60)
    assert counted["power"] / 60 > counted["limit"] - 0.05 - 2 * np.sqrt(0.25 / 60)
    assert counted["in_class"] <= counted["power"]
    clean = tried("positions", "clean 0", 0.0, 300)
    assert clean["power"] <= 11  # 2.7 wanted; more than 11 by chance once in 10⁵

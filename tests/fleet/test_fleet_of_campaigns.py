"""Campaigns of the laboratory pooled: an effect too small for each, and the page that says it."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import chain
import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
from scipy import stats

import laboratory
from inertial import tables
from inertial.campaign.references import NAMELESS
from inertial.model_selection.fleet_evidence import Shared
from inertial.model_selection.fleet_search import FleetEffect
from inertial.tables.errors import Refusal
from inertial.text.messages import speak
from overviews.fleet.members import members_of
from overviews.fleet.page import WOULD_TELL, fleet_page
from overviews.fleet.results import as_likeliest, results_of
from overviews.fleet.selection import keep, name_of, parts, selected

pytestmark = pytest.mark.slow

# IMU, table and seed: A on both tables, B on the first.
CAMPAIGNS = {"one": ("A", "left", 171), "two": ("A", "right", 172), "three": ("B", "left", 173)}
G_SENSITIVITY = 13.0  # °/h/g, 3.5 sigmas in each, of the x gyro by the force along y, of the type
SETTINGS = {"false_discoveries": 0.03, "outliers": 0.01}


@pytest.fixture(scope="module")
def derived(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three campaigns of two minutes, each with the same small g-sensitivity."""
    folder = tmp_path_factory.mktemp("fleet")
    for name, (serial, table, seed) in CAMPAIGNS.items():
        matrix = [[0.0, G_SENSITIVITY, 0.0], [0.0] * 3, [0.0] * 3]
        document = chain.short(
            seed=seed, effects={"gyro_g_sensitivity": {"matrix_deg_h_g": matrix}}
        )
        document["campaign"] |= {"serial": serial}
        document["campaign"]["table"] |= {"name": table}
        document["noise"]["angle_random_walk_deg_sqrt_h"] = 0.3
        made = chain.in_memory(
            laboratory.perform(laboratory.specify(document)), "diagnosis", chain.BESIDE
        )
        for place, arrow in made.arrow.items():
            file = folder / name / f"{place}.parquet"
            file.parent.mkdir(parents=True, exist_ok=True)
            pq.write_table(arrow, file)
        budget = folder / name / "compensation/uncertainty_budget.parquet"
        budget.parent.mkdir()
        pq.write_table(tables.UNCERTAINTY_BUDGET.arrow(tables.UNCERTAINTY_BUDGET.frame([])), budget)
        _with_own_logs(folder / name)
    return folder


def _with_own_logs(folder: Path) -> None:
    """Logs in memory are all alike on the disk: they get a hash each."""
    file = folder / "plan/inputs.parquet"
    inputs = tables.INPUTS.read(file)
    inputs["sha256"] = [f"{folder.name} {name}" for name in inputs["file"]]
    pq.write_table(tables.INPUTS.arrow(inputs), file)


@pytest.fixture(scope="module")
def pooled(derived):
    return results_of(members_of(list(CAMPAIGNS), derived), **SETTINGS)


def table(derived, name, place):
    return pd.read_parquet(derived / name / f"{place}.parquet")


def test_what_is_stored_gives_the_statistics_of_the_campaign(derived):
    """χ² = bᵀ F⁻¹ b of an effect is that of its own test, where nothing is named."""
    score, matrix = (
        table(derived, "one", f"criticism/{name}")
        for name in ("score_vector", "information_matrix")
    )
    scores = table(derived, "one", "criticism/scores").set_index("effect")
    compared = 0
    for effect, rows in score.groupby("effect"):
        own = matrix[(matrix["effect"] == effect) & (matrix["with_effect"] == effect)]
        place = {name: i for i, name in enumerate(rows["parameter"])}
        f = np.zeros((len(rows), len(rows)))
        for row in own.itertuples():
            i, j = place[row.parameter], place[row.with_parameter]
            f[i, j] = f[j, i] = row.information
        if len(rows) == scores.loc[effect, "degrees"] and scores.loc[effect, "statistic"] > 1:
            b = rows["score"].to_numpy()
            expected = scores.loc[effect, "statistic"]
            assert b @ np.linalg.solve(f, b) == pytest.approx(expected, rel=1e-3), effect
            compared += 1
    assert compared > 5


def test_no_campaign_names_the_effect_and_the_fleet_does(derived, pooled):
    for name in CAMPAIGNS:
        assert not table(derived, name, "criticism/scores")["named"].any()
    rows, searched = pooled
    assert searched > 50
    (finding,) = rows["findings"]
    assert finding["effect"] == "gyro_g_sensitivity" and finding["group"] == "NovAtel SPAN-CPT"
    assert (finding["named_by"], finding["asked"]) == (0, 3)
    possible = [one["level"] for one in rows["sharings"] if one["possible"]]
    assert "type" in possible
    (size,) = [one for one in rows["sizes"] if one["parameter"] == "g_xy"]
    truth = G_SENSITIVITY * np.radians(1) / 3600 / 9.80665
    assert size["value"] == pytest.approx(truth, abs=3 * size["sigma"])
    others = [one["value"] / one["sigma"] for one in rows["sizes"] if one["parameter"] != "g_xy"]
    assert stats.chi2.sf(np.sum(np.square(others)), len(others)) > 1e-3


def test_the_population_has_the_truth_of_all_24_parameters(pooled):
    rows, _ = pooled
    assert len(rows["population"]) == 24
    truth = chain.short()["truth"]["accelerometer"]
    for axis, place in zip("xyz", range(3), strict=True):
        (row,) = [
            one
            for one in rows["population"]
            if (one["sensor"], one["parameter"]) == ("accel", f"bias_{axis}")
        ]
        assert row["mean"] == pytest.approx(truth["bias_m_s2"][place], abs=4 * row["mean_sigma"])
        assert row["imus"] == 2 and row["prior_sigma"] >= row["mean_sigma"]


def test_the_page_says_which_findings_campaigns_name_alone(derived):
    members = members_of(list(CAMPAIGNS), derived)
    both = [replace(m, named=frozenset({"gyro_g_sensitivity"})) for m in members[:2]]
    rows, searched = results_of([*both, *members[2:]], **SETTINGS)
    (finding,) = rows["findings"]
    assert (finding["named_by"], finding["asked"]) == (2, 3)
    html = fleet_page(rows, searched, 0.03, "test", [], "c0de", simulated=True)
    assert "Effects that the campaigns show together" in html and "2 of 3" in html


@pytest.mark.parametrize(("language", "words"), [("en", "Effects found"), ("zh", "发现的效应")])
def test_the_page_says_it(pooled, language, words):
    rows, searched = pooled
    speak(language)
    try:
        html = fleet_page(rows, searched, 0.03, "test", [], "c0de", simulated=True)
    finally:
        speak("en")
    text = re.sub(r"<[^>]+>", " ", html)
    assert words in text and "<script" not in html
    assert "<b>" not in text and "NovAtel SPAN-CPT B" in text


def test_a_second_campaign_of_the_same_logs_is_not_pooled(derived, tmp_path):
    for name, source in {"one": "one", "again": "one", "two": "two"}.items():
        (tmp_path / name).symlink_to(derived / source)
    members = members_of(["one", "again", "two"], tmp_path)
    rows, _ = results_of(members, **SETTINGS)
    assert [row["pooled"] for row in rows["campaigns"]] == [True, False, True]


# ---- Selections.


@pytest.mark.parametrize("name", NAMELESS)
def test_a_placeholder_joins_neither_tables_nor_imus(name, derived, tmp_path):
    """Tables of drafts, "not known", were one table of that name."""
    for campaign in CAMPAIGNS:
        shutil.copytree(derived / campaign, tmp_path / campaign)
        file = tmp_path / campaign / "plan/campaign.parquet"
        about = tables.CAMPAIGN.read(file)
        pq.write_table(tables.CAMPAIGN.arrow(about.assign(table=name, serial="unknown")), file)
    members = members_of(list(CAMPAIGNS), tmp_path)
    assert not any(m.references.named for m in members)
    assert len({m.table for m in members}) == len({m.imu for m in members}) == len(members)


def test_a_selection_is_by_key_or_by_name():
    assert parts("table='rate table' serial=A/1") == ({"table": "rate table", "serial": "A/1"}, [])
    assert parts("june july") == ({}, ["june", "july"])
    assert name_of("table='rate table'") == "table-rate-table"


@pytest.mark.parametrize(
    ("text", "found"), [("", "nothing"), ("colour=red", "colour"), ("a serial=1", "together")]
)
def test_what_is_no_selection_is_refused(text, found):
    with pytest.raises(Refusal, match=found):
        parts(text)


def test_the_campaigns_of_a_selection(derived, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data/fleets").mkdir(parents=True)

    def of(text):
        (tmp_path / "data/fleets/f.txt").write_text(text)
        return selected("f", list(CAMPAIGNS), derived)

    assert of("table=left") == ["one", "three"]
    assert of("serial=A") == ["one", "two"]
    assert of("all") == list(CAMPAIGNS)
    assert of("three one") == ["three", "one"]
    with pytest.raises(Refusal, match="1 of 3 campaigns with a result: three"):
        of("serial=B")
    with pytest.raises(Refusal, match="four"):
        of("one four")


def test_what_selects_nothing_is_refused_with_what_there_is_and_leaves_no_file(derived, tmp_path):
    (tmp_path / "data").mkdir()
    (tmp_path / "data/derived").symlink_to(derived)
    for text in ("serial=NOPE", "serial=NOPE table=left", "serial=B", "one four"):
        with pytest.raises(Refusal) as refusal:
            keep(text, "", list(CAMPAIGNS), tmp_path)
        said = str(refusal.value)
        assert said.startswith(f"SELECT, {text}\n") and "data/fleets" not in said
        if "NOPE" in text:
            assert "no campaign with a result has serial=NOPE" in said
            assert "serial=A or serial=B" in said
    assert not (tmp_path / "data/fleets").exists()
    assert keep("table=left", "", list(CAMPAIGNS), tmp_path) == "table-left"
    assert (tmp_path / "data/fleets/table-left.txt").read_text() == "table=left\n"


def test_every_pair_of_levels_has_a_campaign_that_would_tell():
    assert len(WOULD_TELL) == 6


def test_sizes_and_shares_are_of_the_likeliest_member():
    """Found as 4, it is 2 with 71 %; of two that would be one effect the other stays as found."""

    def found(effect: int, members: dict[int, float]) -> FleetEffect:
        return FleetEffect(Shared(effect, "sensor", 0), 60.0, 3, 1e-9, {"sensor": 1.0}, members)

    both = [found(4, {2: 0.71, 4: 0.10}), found(7, {7: 0.9, 2: 0.1}), found(5, {2: 0.6, 5: 0.4})]
    assert [one.effect for one in as_likeliest(both)] == [2, 7, 5]

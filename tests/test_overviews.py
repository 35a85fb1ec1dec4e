"""Pages of several campaigns: what they compare, by numbers that do not come from the code."""

import re
from argparse import Namespace
from dataclasses import replace
from pathlib import Path

import chain
import numpy as np
import pytest
import test_history as archive
from scipy import stats
from scipy.spatial.transform import Rotation

from inertial.campaign.references import TABLE_RATE, References, references_of
from inertial.tables.errors import Refusal
from overviews.compare.page import as_text, comparison_page
from overviews.compare.pair import READ, pair_of_campaigns
from overviews.compare.remounted import remounted
from overviews.compare.shared import Shared
from overviews.history.page import documents, due_in_words, history_page
from overviews.index.page import Without, index_page
from overviews.known import kept, pair_of, refuse_reserved, serials, with_result
from overviews.tables_of import RESULT
from overviews.tables_of import tables_of as of_campaign
from overviews.units import Imu, imus_of
from stages.history.repeatability import Observed, change
from stages.report.tables import Tables
from tests.report.synthetic import campaign as synthetic
from tests.report.synthetic import tables_of

LEVEL = 0.01
BIASES = (1.00, 1.03, 0.98, 1.01, 1.60, 1.63, 1.58, 1.61)  # 1e-5 rad/s, known to 1e-7


# ---- names and files


def test_a_pair_is_found_in_names_with_hyphens():
    assert pair_of("history-1-history-2", ["history-1", "history-2"]) == ("history-1", "history-2")
    assert pair_of("a-b-c", ["a", "b-c", "d"]) == ("a", "b-c")


@pytest.mark.parametrize("names", [["a", "a-b", "b-c", "c"], ["a", "b"], []])
def test_an_ambiguous_or_unknown_pair_is_refused(names):
    with pytest.raises(Refusal, match=r"compare-a-b-c\.html"):
        pair_of("a-b-c", names)


@pytest.mark.parametrize("name", ["index", "compare-1-2", "fleet-1"])
def test_a_campaign_cannot_have_the_name_of_another_page(name):
    with pytest.raises(Refusal, match="rename"):
        refuse_reserved(["demo", name])
    refuse_reserved(["demo", "indexed", "comparison"])


def test_a_campaign_has_a_result_when_all_its_tables_are_there(tmp_path):
    archive.run(tmp_path)
    assert with_result(["spring"], tmp_path / "derived") == []


def test_the_serials_of_the_archive_without_unknown_ones(tmp_path):
    for serial in ("A-017", "B/2", "unknown"):
        archive.run(tmp_path, serial=serial)
    archive.run(tmp_path, serial="S-1", simulated=True)
    assert serials(tmp_path / "history") == ["A-017", "B%2F2", "S-1"]
    assert len(kept(tmp_path / "history")) == 4
    (file,) = kept(tmp_path / "history", "S-1")
    assert file.startswith("simulated/span-cpt/S-1/")


# ---- the history of an IMU


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An archive of eight calibrations of one IMU, and the pages of two campaigns."""
    place = tmp_path_factory.mktemp("fleet")
    for number, bias in enumerate(BIASES):
        archive.run(place, bias * 1e-5, campaign=f"c{number}", date=f"20{18 + number}-03-02")
    (place / "reports").mkdir()
    for name in ("c7", "one"):
        (place / f"reports/{name}.html").write_text("")
    return place


@pytest.fixture(scope="module")
def imu(place: Path) -> Imu:
    """It, with a tolerance."""
    (imu,) = imus_of(
        place / "history", "A-017", place / "derived", level=LEVEL, tolerance={"gyro_bias": 1e-6}
    )
    return imu


def test_the_history_page_has_the_jump_the_due_date_and_every_value(place, imu):
    html = history_page([imu], place / "history", place / "reports", "c0de")
    assert "jumped between 2021-03-02 and 2022-03-02" in html
    sentence, _tone = due_in_words(imu)
    assert "2025-03-02" <= imu.due < "2034" and f"Due on {imu.due}, by gyro bias x." == sentence
    assert sentence in html
    assert '<a href="../c7.html">c7</a>' in html and "../c6.html" not in html
    values = 1e-5 * np.array(BIASES) * 180 / np.pi * 3600  # °/h
    for value in values:
        assert f'<td class="number" data-label="value">{value:.3f}</td>' in html
    sigmas = (values[4] - values[3]) / (0.0206265 * np.sqrt(2))
    assert f"{sigmas:.1f}" in html  # 41.7 sigma
    assert f"1 of 1, most bx of the gyros, by {sigmas:.1f} σ" in re.sub("<[^>]*>", "", html)
    for entry in imu.calibrations:
        assert entry.file in html
    assert "<script" not in html and not re.search(r"(src|href)=\"https?:", html)


def test_an_unknown_serial_number_has_no_history(tmp_path):
    """Several IMUs may be of it, and were one page."""
    archive.run(tmp_path, 1e-5, serial="unknown")
    given = Namespace(names=["unknown"], settings={"history": {"level": LEVEL}})
    given.archive, given.derived = tmp_path / "history", tmp_path / "derived"
    given.reports = tmp_path
    with pytest.raises(Refusal, match="no calibration of it"):
        documents(given, "c0de")


def test_every_value_of_the_history_has_the_unit_of_its_parameter(tmp_path):
    """615.1 ppm, and a cross term of 2.5273e-3 rad, 521.30″."""
    further = [
        archive.counted("scale_x", 615.1e-6, 2e-6),
        archive.counted("cross_xy", 2.5273e-3, 1e-6),
    ]
    archive.run(tmp_path, further=further)
    (imu,) = imus_of(tmp_path / "history", "A-017", tmp_path, level=LEVEL, tolerance={})
    html = history_page([imu], tmp_path / "history", tmp_path / "reports", "c0de")
    table = html[html.rindex("The numbers behind the figures") :]
    for heading, value, unit in (
        ("scale x", "615.1", "ppm"),
        ("cross xy", "521.29", "arcsec"),
        ("bias x", "2.063", "°/h"),
    ):
        row = re.sub(r"<[^>]*>", " ", table[table.index(heading) :])[:200].split()
        assert value in row and unit in row, row


def test_a_reference_that_two_calibrations_share_is_in_no_change_of_theirs():
    """5 ppm of noise each, and 50 ppm of a gravity that both take: σ is √2 · 5 ppm, 7.07 ppm."""
    first = Observed("a", "2025-01-02", "m", "s", 100e-6, np.hypot(5e-6, 50e-6), {"here": 50e-6})
    second = replace(first, campaign="b", value=130e-6)
    assert change(first, second) == (pytest.approx(30e-6), pytest.approx(7.071e-6, rel=1e-3))
    other = replace(second, shared={"there": 50e-6})
    assert change(first, other)[1] == pytest.approx(71.06e-6, rel=1e-3)


def test_a_calibration_that_is_dated_earlier_but_came_later_counts_at_its_place(tmp_path):
    """The tables of the stage keep what was known when it ran; the page is of the archive."""
    for bias, date in ((1.0, "2026-01-02"), (3.0, "2024-01-02"), (2.0, "2025-01-02")):
        archive.run(tmp_path, bias * 1e-5, campaign=f"on-{date}", date=date)
    (imu,) = imus_of(tmp_path / "history", "A-017", tmp_path, level=LEVEL, tolerance={})
    values = [value.value for value in imu.series["gyro", "bias_x"]]
    assert values == pytest.approx([3e-5, 2e-5, 1e-5])
    (row,) = imu.tables.rows("forecast")
    assert row["drift"] == pytest.approx(-1e-5, rel=0.01)  # rad/s in a year


# ---- the index


def index(folder: Path, imu: Imu, **changes: object) -> str:
    made = synthetic()
    made["campaign"] = made["campaign"].assign(**changes)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("overviews.tables_of.hash_of_file", lambda _file: "c0de")
        return index_page(
            {"one": Tables({name: made[name] for name in RESULT}, {})},
            [Without("two", "plan: no such <key>")],
            {"A-017": [imu]},
            (folder / "derived", folder / "reports"),
            "c0de",
        )


def test_the_index_has_verdict_cause_sigma_and_due_date(place, imu):
    made = synthetic()
    html = index(place, imu, date="2026-03-02")
    row = html[html.index('<a href="one.html">') :].partition("</tr>")[0]
    assert 'data-sort="date:2026-03-02"' in row
    biases = made["result"]
    biases = biases[
        (biases["sensor"] == "gyro") & biases["parameter"].isin(["bias_x", "bias_y", "bias_z"])
    ]
    worst = biases["sigma"].max() * 180 / np.pi * 3600 if biases["value"].notna().all() else None
    shown = re.findall(r'data-label="worst σ, gyro bias, °/h" data-sort="([^"]*)"', row)
    assert shown == ["" if worst is None else f"{worst:.6g}"]
    assert "plan: no such &lt;key&gt;" in html
    imu = html[html.index("A-017</td>") :].partition("</tr>")[0]
    assert 'data-sort="due:20' in imu


def test_what_a_campaign_is_called_cannot_act_in_the_page(place, imu):
    html = index(place, imu, serial="</script><script>alert(1)</script>")
    assert html.count("<script") == html.count("</script") == 1
    assert "&lt;script&gt;alert" in html


# ---- two campaigns


def result(scale: float, sigma: float, share: float, **about: object) -> Tables:
    """The synthetic campaign with one scale factor of an accelerometer, mostly known by gravity."""
    made = synthetic()
    row = {"mount": "", "sensor": "accel", "quantity": "scale_x", "source": "gravity"}
    one = (
        made["result"]
        .iloc[:1]
        .assign(
            id="diagnosis/accelerometer/scale_x",
            mount="",
            sensor="accel",
            effect=None,
            parameter="scale_x",
            value=scale,
            sigma=sigma,
            unit="1",
        )
    )
    budget = made["uncertainty_budget"].iloc[:1].assign(**row, sigma=sigma, unit="1", share=share)
    inputs = made["inputs"].assign(sha256=[f"{scale}{n}" for n in range(len(made["inputs"]))])
    campaign = made["campaign"].assign(**about)
    return tables_of(
        made | {"result": one, "uncertainty_budget": budget, "inputs": inputs, "campaign": campaign}
    )


def test_the_error_of_one_gravity_is_not_in_a_difference():
    """51 ppm of which 1.2 ppm are noise: of the difference σ is √2 · 1.2 ppm = 1.70 ppm."""
    share = 1 - (1.2 / 51) ** 2
    pair = pair_of_campaigns(
        ("a", "b"), (result(330e-6, 51e-6, share), result(337e-6, 51e-6, share)), LEVEL
    )
    (one,) = pair.compared
    assert one.sigma == pytest.approx(1.697e-6, rel=1e-3)
    assert one.p_value == pytest.approx(2 * stats.norm.sf(7 / 1.697), rel=1e-2)
    assert one.beyond
    apart = pair_of_campaigns(
        ("a", "b"),
        (result(330e-6, 51e-6, share), result(337e-6, 51e-6, share, latitude=0.1)),
        LEVEL,
    )
    (one,) = apart.compared
    assert one.sigma == pytest.approx(72.1e-6, rel=1e-3) and not one.beyond


def test_the_same_logs_are_not_compared_as_independent_ones():
    both = (result(330e-6, 51e-6, 0.9), result(330e-6, 51e-6, 0.9))
    pair = pair_of_campaigns(("a", "b"), both, LEVEL)
    assert pair.common_logs and pair.compared[0].sigma is None
    assert "not independent" in as_text(pair)


@pytest.mark.parametrize("table", ["by hand", "not named", "not known"])
def test_a_table_without_a_name_is_not_the_same_as_another(table):
    """The placeholder of a draft was."""
    campaign = {"table": table, "latitude": None, "height": None}
    assert references_of(campaign, [], []).table is None
    assert TABLE_RATE not in references_of(campaign, [], []).sources
    named = references_of(campaign | {"table": "north"}, [], [])
    assert named.table == "north" and TABLE_RATE in named.sources


def test_other_parameters_share_it_only_where_the_plans_are_the_same():
    key = ("", "accel", "bias_x")
    shares = {(key, "gravity"): 0.25}
    first = References({"gravity": "here"}, None, "six positions")
    for plan, expected in (("six positions", 0.25 * 6.0), ("a tumble", 0.0)):
        shared = Shared((first, replace(first, plan=plan)), (shares, shares))
        assert shared.covariance(key, (2.0, 3.0)) == pytest.approx(expected)


DRIFT = (4e-6, 0.0, 0.0)  # rad/s, of the biases of the gyros
TURNED = np.radians([0.12, -0.3, 0.05])  # of the IMU in its mounting


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory: pytest.TempPathFactory) -> tuple[Tables, ...]:
    """Short campaigns of one IMU, the second with another gyro bias, the third remounted."""
    made, place = [], tmp_path_factory.mktemp("pair")
    for seed in (5, 6, 7):
        document = chain.short(seed=seed)
        document["campaign"]["site"] = {"latitude_deg": 48.15, "height_m": 520}
        gyro = document["truth"]["gyro"]
        if seed == 6:
            gyro["bias_rad_s"] = [b + d for b, d in zip(gyro["bias_rad_s"], DRIFT, strict=True)]
        for sensor in ("gyro", "accelerometer") if seed == 7 else ():
            matrix = np.array(document["truth"][sensor]["matrix"])
            turned = matrix @ Rotation.from_rotvec(TURNED).inv().as_matrix()
            document["truth"][sensor]["matrix"] = turned.tolist()
        raw, derived = chain.simulate(document, place / f"raw/{seed}"), place / f"derived/{seed}"
        chain.run(raw, derived, "compensation", chain.BESIDE)
        made.append(of_campaign(derived, READ))
    return tuple(made)


@pytest.mark.slow
def test_two_simulated_campaigns_differ_by_what_was_changed_and_nothing_else(calibrated):
    pair = pair_of_campaigns(("one", "two"), calibrated[:2], LEVEL)
    assert not list(remounted(pair))
    by_name = {one.key[1:]: one for one in pair.compared if one.effect is None}
    assert len(by_name) == 24
    moved = by_name["gyro", "bias_x"]
    assert moved.difference == pytest.approx(DRIFT[0], abs=4 * moved.sigma)
    assert [key for key, one in by_name.items() if one.beyond] == [("gyro", "bias_x")]
    pulls = np.array([one.in_sigmas for key, one in by_name.items() if key != ("gyro", "bias_x")])
    assert stats.chi2.sf((pulls**2).sum(), len(pulls)) > 1e-3
    scales = [by_name["accel", f"scale_{axis}"] for axis in "xyz"]
    assert all(one.first["sigma"] > 40e-6 and one.sigma < 10e-6 for one in scales)
    chi2, count, p_value = pair.together("accel")
    assert count == 12 and p_value == pytest.approx(stats.chi2.sf(chi2, 12)) and p_value > 1e-3
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("overviews.tables_of.hash_of_file", lambda _file: "c0de")
        html = comparison_page(pair, Path("derived"), "c0de")
    assert "<script" not in html and "1 of 24 values differ" in html
    text = as_text(pair)
    assert "A: Gyros: usable." in text and "B: Accelerometers: usable." in text
    assert "bias_x *" in text and max(map(len, text.splitlines())) < 160


@pytest.mark.slow
def test_an_imu_that_was_mounted_anew_is_said_to_be_turned_and_nothing_else(calibrated):
    pair = pair_of_campaigns(("one", "three"), (calibrated[0], calibrated[2]), LEVEL)
    (found,) = remounted(pair)
    assert np.abs(found.rotation - TURNED).max() < 4 * found.sigma.max() < 1e-4
    assert found.count == 18 and found.before > 1e4 and not found.still
    assert stats.chi2.sf(found.after, 15) > 1e-3
    text = " ".join(as_text(pair).split())
    assert "turned alike" in text and "Beside it no element differs" in text

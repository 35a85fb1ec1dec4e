"""Differences in units of their sigmas: silent where there is nothing, named where there is."""

from typing import Any

import chain
import numpy as np
import pandas as pd
import pytest

from inertial import tables
from inertial.estimation.consistency import holm_rejections, normal_p_value
from inertial.estimation.gyroscope_formulas import Upright, both_ways, two_positions
from inertial.estimation.gyroscope_observations import Earth, Position, WholeTurn
from inertial.estimation.gyroscopes import bias_and_scale
from inertial.physics.site import earth_rate
from inertial.tables.errors import Refusal
from inertial.tables.yaml_file import YamlFile
from stages.comparison.stage import Results, method_against_method
from stages.plan.published import published_values

DEGREE_PER_HOUR = np.radians(1 / 3600)  # rad/s
UP, LEVEL = earth_rate(np.radians(30.5278))
WUHAN = Earth(UP, 0.0, LEVEL)
NO_CROSS = np.zeros(3)


def random_walk(degrees_per_root_hour: float) -> float:
    """An angle random walk in rad/√s."""
    return np.radians(degrees_per_root_hour) / 60


def up_and_down(
    arw: float, seconds: float, means: tuple[float, float] = (WUHAN.up, -WUHAN.up)
) -> list[Upright]:
    """Two rests with x up and x down, of unknown azimuth."""
    return [
        Upright(
            Position(f"x {sign:+d}", np.array([sign, 0.0, 0.0])), sign, mean, arw / seconds**0.5
        )
        for sign, mean in zip((1, -1), means, strict=True)
    ]


# ---- the formulas, against what is known of S0


def test_s0_rests_and_turns_differ_with_the_noise_of_its_data():
    """Design study 4.5, T14: chi-squared 18.44 with 0.012 °/√h, rests of 300 s, turns of 40 s."""
    turns = np.array([2.96905e-07, 7.16724e-07, 3.64076e-07])  # S0, table 5-2
    rests = np.array([-2.15039e-08, -7.45963e-07, -6.06855e-07])  # S0, table 5-7
    arw = random_walk(0.012)
    static = two_positions(up_and_down(arw, 300), NO_CROSS, WUHAN, 0.0)
    both = [WholeTurn(a, a, 1e-12, 40, 1, arw) for a in (2 * np.pi, -2 * np.pi)]
    sigma = np.hypot(static.bias_sigma, bias_and_scale(both, WUHAN).sigma[0])
    assert sigma == pytest.approx(4.15e-7, rel=0.005)
    assert np.sum(((turns - rests) / sigma) ** 2) == pytest.approx(18.44, rel=0.01)


def test_s0_scale_factors_from_rests_are_no_evidence():
    """Design study 4.5, T15: chi-squared 0.49 with 0.1 °/√h and rests of 120 s."""
    scales = np.array([0.029747, -0.016849, -0.009088])  # S0, table 5-8
    static = two_positions(up_and_down(random_walk(0.1), 120), NO_CROSS, WUHAN, 0.0)
    assert static.scale_sigma == pytest.approx(0.0507, rel=0.005)
    assert np.sum((scales / static.scale_sigma) ** 2) == pytest.approx(0.49, abs=0.01)


@pytest.mark.parametrize("azimuth", [0.0, 1.0, 2.5])
def test_the_level_earth_rate_reaches_the_gyro_through_a_cross_term(azimuth):
    """Design study 4.5, T16: a cross term of 7.608 mrad changes s by up to 0.01290."""
    cross = np.array([0, 0.007608, 0])
    north = np.array([0, np.cos(azimuth), np.sin(azimuth)])
    coupled = WUHAN.level * cross @ north
    means = (WUHAN.up + coupled, -WUHAN.up - coupled)
    rests = up_and_down(1e-9, 300, means)
    blind = two_positions(rests, cross, WUHAN, 0.0)
    assert blind.scale == pytest.approx(0.01290 * np.cos(azimuth), rel=0.002)
    assert blind.scale_sigma == pytest.approx(0.01290 / 2, rel=0.002)  # two random azimuths
    assert blind.bias_sigma == pytest.approx(0.0986 * DEGREE_PER_HOUR / 2, rel=0.01)
    known = [
        Upright(Position("", r.position.up, north=north * r.up), r.up, r.mean, r.sigma)
        for r in rests
    ]
    seen = two_positions(known, cross, WUHAN, 0.0)
    assert seen.scale == pytest.approx(0, abs=1e-6)
    assert seen.scale_sigma < 1e-5


def test_positions_with_a_common_mark_share_their_azimuth():
    """Turned over about the mark, what it couples stays in the bias: γ ω_e cosφ / √2 for random."""
    mark = np.array([0.0, 1.0, 0.0])
    rests = [
        Upright(Position("", r.position.up, mark=mark), r.up, r.mean, r.sigma)
        for r in up_and_down(1e-9, 300)
    ]
    static = two_positions(rests, np.array([0, 0.0076, 0]), WUHAN, 0.0)
    assert static.bias_sigma == pytest.approx(0.0986 * DEGREE_PER_HOUR / np.sqrt(2), rel=0.01)


def test_one_end_up_is_not_two_positions_and_an_unknown_latitude_has_no_scale():
    rests = up_and_down(1e-6, 100)
    assert two_positions(rests[:1], NO_CROSS, WUHAN, 0.0) is None
    unknown = two_positions(rests, NO_CROSS, Earth(0.0, 4e-5, 6e-5), 0.0)
    assert unknown.scale is None and unknown.bias_sigma > 0


@pytest.mark.parametrize("seconds_of_rest", [5, 100, 3000])
def test_the_sigma_of_forward_against_backward_counts_the_shared_data_once(seconds_of_rest):
    """A joint bias from rests and these turns; its error enters both scale factors."""
    random = np.random.default_rng(seconds_of_rest)
    arw, bias, t, alpha, angle = random_walk(0.012), 2e-6, 38.0, 2 * np.pi, 1e-5
    of_turns = np.sqrt((arw**2 * t + angle**2) / (2 * t**2))
    of_rest = arw / np.sqrt(seconds_of_rest)
    joint_sigma = (of_turns**-2 + of_rest**-2) ** -0.5
    pulls = []
    for _ in range(2000):
        noise = random.normal(0, np.hypot(arw * np.sqrt(t), angle), 2)
        summed = np.array([alpha, -alpha]) + (bias + WUHAN.up) * t + noise
        turns = [
            WholeTurn(s, a, angle, t, 1, arw) for s, a in zip(summed, (alpha, -alpha), strict=True)
        ]
        alone = summed.sum() / (2 * t) - WUHAN.up
        rest = bias + random.normal(0, of_rest)
        joint = joint_sigma**2 * (alone / of_turns**2 + rest / of_rest**2)
        found = both_ways(*turns, joint, joint_sigma, WUHAN)
        pulls.append((found.forward - found.backward) / found.sigma)
    assert np.std(pulls) == pytest.approx(1, abs=4 / np.sqrt(2 * 2000))


def test_a_bias_that_drifts_is_not_taken_for_a_part_of_the_noise_of_the_turns():
    """Its sigma is as large as that by the turns alone: the difference is no surer for it."""
    arw, t, alpha, angle = random_walk(0.012), 38.0, 2 * np.pi, 1e-5
    turns = [WholeTurn(s, s, angle, t, 1, arw) for s in (alpha, -alpha)]
    of_turns = float(np.sqrt((arw**2 * t + angle**2) / (2 * t**2)))
    of_noise = both_ways(*turns, 0.0, 0.0, WUHAN).sigma
    drifting = both_ways(*turns, 0.0, 1.01 * of_turns, WUHAN).sigma
    assert drifting == pytest.approx(of_noise * np.sqrt(1 + 1.01**2), rel=1e-2)


def test_a_family_of_comparisons_is_judged_together():
    # Holm (1979); the smallest of four is held against 0.05/4, the next against 0.05/3.
    np.testing.assert_array_equal(
        holm_rejections([0.01, 0.04, 0.03, 0.005], 0.05), [True, False, False, True]
    )
    assert holm_rejections([], 0.01).shape == (0,)
    assert normal_p_value(-1.959964) == pytest.approx(0.05, abs=1e-6)


# ---- the stage, on simulated campaigns


def of_kind(table: pd.DataFrame, kind: str) -> pd.DataFrame:
    return table[table["kind"] == kind].set_index(["sensor", "quantity"])


@pytest.mark.slow
def test_clean_campaigns_differ_by_no_more_than_chance(clean):
    for results in clean:
        table = results["comparison/differences"]
        assert not table["sentence"].str.contains(": more than chance").any()
        assert table["id"].is_unique
        assert dict(table["kind"].value_counts()) == {
            "static_against_turns": 6,
            "forward_against_backward": 3,
            "method_against_method": 18,
        }
        assert (
            table["in_sigmas"].isna() == table["sentence"].str.contains("not independent")
        ).all()
    for kind in ("static_against_turns", "forward_against_backward", "method_against_method"):
        pulls = pd.concat([of_kind(r["comparison/differences"], kind) for r in clean])["in_sigmas"]
        pulls = pulls.dropna().to_numpy(float)
        assert len(pulls) >= 9
        # The rms of n pulls scatters by 1/√(2n), and some pulls share their data.
        assert (
            1 - 3 / np.sqrt(len(pulls)) < np.sqrt(np.mean(pulls**2)) < 1 + 3 / np.sqrt(len(pulls))
        )


def test_the_hidden_g_sensitivity_parts_rests_from_turns(demo):
    """It adds +G to turns with the axis up; in the bias of rests up and down it cancels."""
    table = of_kind(demo["comparison/differences"], "static_against_turns")
    earth = WUHAN.up / DEGREE_PER_HOUR
    for axis, hidden in (("x", 1.4), ("y", -1.0)):  # °/h/g, data/simulated/demo.yaml
        for name, size in (("bias", -hidden * DEGREE_PER_HOUR), ("scale", hidden / earth)):
            row = table.loc["gyro", f"{name}_{axis}"]
            assert abs(row["difference"] - size) < 3.5 * row["sigma"]
            assert abs(row["in_sigmas"]) > 6
            assert ": more than chance" in row["sentence"]
    sentence = table.loc[("gyro", "bias_x"), "sentence"]
    assert sentence.startswith("bias of the x gyro: rests and turns differ by −1.")
    assert "°/h" in sentence
    assert not any(quantity.endswith("z") for _, quantity in table.index)  # a turn has a gap
    both = of_kind(demo["comparison/differences"], "forward_against_backward")
    assert both.loc[("gyro", "scale_x"), "in_sigmas"] > 3


def test_each_value_is_the_one_that_its_stage_tells(demo):
    table = demo["comparison/differences"]
    for stage in ("accelerometer", "gyroscope"):
        values = demo[f"{stage}/parameters"].set_index("id")["value"]
        for side in ("first", "second"):
            named = table[table[side].isin(values.index)]
            np.testing.assert_allclose(named[f"{side}_value"], values[named[side]], rtol=1e-9)


# ---- what others published

RIGHT = """\
source: data sheet
accelerometer:
  scale_x: {value: 328.52, sigma: 10, unit: ppm}
gyro:
  bias_x: {value: 1.3e-6, sigma: 3.0e-7}
  bias_y: {value: -0.43316, unit: deg/h}
  cross_xz: {value: 7.5448, unit: mrad}
"""


def published(folder, text: str) -> pd.DataFrame:
    path = folder / "published.yaml"
    path.write_text(text, encoding="utf-8")
    return tables.PUBLISHED.arrow(pd.DataFrame(published_values(YamlFile(path)))).to_pandas()


def test_published_values_become_si(tmp_path):
    table = published(tmp_path, RIGHT).set_index(["sensor", "quantity"])
    assert table.loc[("accel", "scale_x"), "value"] == pytest.approx(328.52e-6)
    assert table.loc[("accel", "scale_x"), "sigma"] == pytest.approx(1e-5)
    assert table.loc[("gyro", "bias_y"), "value"] == pytest.approx(-2.1e-6, rel=1e-4)
    assert np.isnan(table.loc[("gyro", "bias_y"), "sigma"])
    assert list(table["unit"]) == ["1", "rad/s", "rad/s", "1"]


def test_a_right_published_value_agrees_and_a_wrong_one_is_named(clean, tmp_path):
    right = chain.again(clean[0], "history", **of_history(tmp_path, RIGHT))
    table = of_kind(right["published_differences"], "published")
    assert len(table) == 4 and (table["in_sigmas"].abs() < 3.5).all()
    assert not table["sentence"].str.contains(": more than chance").any()
    alone = table.loc["gyro", "bias_y"]
    ours = clean[0]["diagnosis/result"].set_index(["sensor", "parameter"]).loc["gyro"]
    assert alone["sigma"] == ours.loc["bias_y", "sigma"] and "it is ours alone" in alone["sentence"]
    shared = table.loc[("gyro", "bias_x"), "sigma"]
    assert shared == np.hypot(ours.loc["bias_x", "sigma"], 3e-7)

    wrong = of_history(tmp_path, RIGHT.replace("-0.43316", "0.43316"))
    table = chain.again(clean[0], "history", **wrong)["published_differences"]
    named = table[table["sentence"].str.contains(": more than chance")]
    assert list(named["id"]) == ["comparison/published/gyroscope/bias_y"]
    assert "the published value (data sheet)" in named["sentence"].iloc[0]


def of_history(folder, text: str) -> dict[str, Any]:
    """Published values, and an archive of their own."""
    return {"published": published(folder, text), "archive": [folder / "archive"]}


MISTAKES = {
    # what is wrong: (what to write instead of what, what the error must say)
    "mistyped sensor": ("gyro:", "gyros:", ["line 4, gyros", "write gyro"]),
    "unknown parameter": ("bias_x:", "bias_w:", ["line 5, gyro.bias_w", "bias_x"]),
    "another unit": ("deg/h", "deg/min", ["line 6, gyro.bias_y.unit", "deg/h"]),
    "unit of another kind": ("ppm", "m/s2", ["line 3, accelerometer.scale_x.unit", "ppm"]),
    "no number": ("1.3e-6", "small", ["line 5, gyro.bias_x.value", "in unit"]),
    "not a number": ("1.3e-6", ".nan", ["line 5, gyro.bias_x.value", "finite"]),
    "a sigma of zero": ("sigma: 10", "sigma: 0", ["line 3, accelerometer.scale_x.sigma"]),
    "no value": ("value: 7.5448, ", "", ["line 7, gyro.cross_xz", "add value"]),
    "no source": ("source: data sheet\n", "", ["no key 'source'", "add source"]),
}


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_in_published_values_is_refused_with_place_and_cure(mistake, tmp_path):
    right, wrong, said = mistake
    assert right in RIGHT
    with pytest.raises(Refusal) as refused:
        published(tmp_path, RIGHT.replace(right, wrong, 1))
    for part in [str(tmp_path / "published.yaml"), "found:", "expected:", "cure:", *said]:
        assert part in str(refused.value)


@pytest.mark.slow
def test_published_values_beside_the_campaign_pass_through_the_chain(tmp_path):
    campaign = chain.simulate(chain.short(seed=5), tmp_path / "told")
    (campaign / "published.yaml").write_text(RIGHT, encoding="utf-8")
    results = chain.run(campaign, tmp_path / "derived", until="history")
    assert len(results["plan/published"]) == 4
    assert len(of_kind(results["history/published_differences"], "published")) == 4
    assert "published.yaml" not in list(results["plan/inputs"]["file"])


def test_a_poor_campaign_has_few_differences_and_no_failure(clean):
    blank = tables.PARAMETERS.empty()
    found = chain.again(
        clean[0], "comparison", gyroscope_parameters=blank, accelerometer_parameters=blank
    )
    assert found["differences"].empty


@pytest.mark.parametrize(
    ("sigmas", "variances"), [((2.0, 3.0), (4 - 1, 9 - 4)), ((0.5, 3.0), (0.25 + 1, 9 + 4))]
)
def test_a_method_that_allows_for_less_is_not_weighed_as_if_it_were_the_best(sigmas, variances):
    """Hausman's variance needs the joint fit, 1 and 2, to be the better one throughout."""
    rows = [
        {"method": method, "parameter": f"bias_{axis}", "mount": "", "unit": "m/s²"}
        | {"id": f"{method}/{axis}", "value": 0.0, "sigma": sigma}
        for method, own in (("joint", (1.0, 2.0)), ("six_position", sigmas))
        for axis, sigma in zip("xy", own, strict=True)
    ]
    found = method_against_method(Results("accelerometer", pd.DataFrame(rows), ""), "six_position")
    assert [difference.sigma**2 for difference in found] == pytest.approx(variances)

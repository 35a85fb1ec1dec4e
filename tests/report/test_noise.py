"""The section on noise: two figures and the terms, from tables alone."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from stages.report.outline import Figure, Paragraph, Table
from stages.report.sections import noise, noise_by_manoeuvre, noise_figures
from stages.report.sections.noise_figures import LOWEST, allan_figure
from tests.report import synthetic, synthetic_noise

MICRO_G = 9.80665e-6  # m/s²


def made(**changed: Any) -> list[Any]:
    tables = synthetic.campaign(logs=()) | changed
    return list(noise.SECTION.parts(synthetic.tables_of(tables)))


def plain(cell: str) -> str:
    return re.sub("[\u2007\u2008]", "", cell)


def test_allan_deviation_spectrum_and_terms_in_this_order() -> None:
    allan, spectrum, gyros, accelerometers = made()
    assert isinstance(allan, Figure) and isinstance(spectrum, Figure)
    assert "2 static stretches" in allan.caption
    assert "Allan deviation, °/h" in allan.drawn and "Allan deviation, µg" in allan.drawn
    assert "data sheet" in allan.drawn
    assert "amplitude spectral density, °/√h" in spectrum.drawn
    hertz = re.findall(r"(\d+\.\d) Hz", spectrum.drawn)
    assert len(hertz) == 1 and float(hertz[0]) == pytest.approx(12.5, rel=0.04)
    assert isinstance(gyros, Table) and isinstance(accelerometers, Table)
    assert [row.cells[0] for row in gyros.rows] == ["x", "y", "z", "data sheet"]


@pytest.mark.slow
def test_a_term_has_value_and_sigma_or_an_upper_limit_that_is_written_as_one() -> None:
    *_unused, gyros, accelerometers = made()
    named = [column.group for column in gyros.columns]
    walk = [plain(row.cells[named.index("Rate random walk")]) for row in gyros.rows]
    assert walk == ["0.50", "0.62", "0.80", ""]  # °/h/√h, by the numbers of the made-up recording
    white = [plain(row.cells[named.index("Angle random walk")]) for row in gyros.rows]
    assert white[0] == "0.05336" and white[3] == "0.0667"
    named = [column.group for column in accelerometers.columns]
    place = named.index("Acceleration random walk")
    # 6e-7 m/s²/√s, of 60 √s a √h and 9.80665e-6 m/s² a µg: 3.67
    assert [plain(row.cells[place]) for row in accelerometers.rows[:3]] == ["< 3.7"] * 3
    assert accelerometers.rows[0].cells[place + 1] == ""
    assert "upper limit, 95 %" in accelerometers.note


def test_an_instability_that_may_hide_is_told_beside_the_sigma_of_the_bias() -> None:
    """0.664 of 30 µg are 20 µg: more than the σ of 4 µg of the bias, and less than one of 25 µg."""
    tables = synthetic.campaign(logs=())
    terms, result = tables["noise_terms"].copy(), tables["result"].copy()
    hidden = terms["channel"].str.startswith("accel") & (terms["term"] == "bias_instability")
    terms.loc[hidden, ["value", "sigma"]] = np.nan
    terms.loc[hidden, "detected"] = False
    terms.loc[hidden, "upper"] = 30 * MICRO_G
    bias = (result["sensor"] == "accel") & result["parameter"].str.startswith("bias_")
    for sigma, told in ((4.0, True), (25.0, False)):
        result.loc[bias, "sigma"] = sigma * MICRO_G
        *_unused, accelerometers = made(noise_terms=terms, result=result)
        assert ("bias_instability_ug" in accelerometers.note) == told
        if told:
            assert "B = 30 µg" in accelerometers.note
            assert "up to 20 µg to a bias whose σ is 4.0 µg" in accelerometers.note
    # Of a drift that no single term has to itself, or that the other axes show, σ holds some.
    levels = tables["levels"].copy()
    levels.loc[levels["channel"].str.startswith("accel"), "bias_instability"] = 30 * MICRO_G
    result.loc[bias, "sigma"] = 4.0 * MICRO_G
    *_unused, accelerometers = made(noise_terms=terms, result=result, levels=levels)
    assert "bias_instability_ug" not in accelerometers.note
    result.loc[result["sensor"] == "accel", "method"] = "free_positions"
    *_unused, accelerometers = made(noise_terms=terms, result=result, levels=levels)
    assert "bias_instability_ug" in accelerometers.note


def test_without_a_long_stretch_a_sentence_says_why_and_the_levels_stay() -> None:
    tables = synthetic.campaign(logs=())
    empty = {name: tables[name].iloc[:0] for name in ("allan", "spectra", "noise_terms")}
    why, levels = made(**empty)
    assert isinstance(why, Paragraph) and isinstance(levels, Table)
    assert "no static stretch is long enough: the longest has 300 s" in why.text
    assert len(levels.rows) == 6
    assert plain(levels.rows[0].cells[1]).startswith("0.0065")  # m/s/√h
    (why, _levels) = made(**empty, segments=tables["segments"].iloc[:0])
    assert "no static stretch with time stamps" in why.text


def test_one_sensor_and_terms_without_a_model_or_a_data_sheet() -> None:
    tables = synthetic.campaign(logs=())
    less = {
        name: tables[name].query("channel.str.startswith('accel')")
        for name in ("allan", "spectra", "noise_terms")
    }
    less["allan"] = less["allan"].assign(model=np.nan)
    less["noise_terms"] = less["noise_terms"].assign(data_sheet=np.nan)
    sheet = tables["sensors"].assign(white_noise=np.nan, source=None)
    allan, _spectrum, terms = made(**less, sensors=sheet)
    assert "Gyros" not in allan.drawn and "data sheet" not in allan.drawn
    assert [row.cells[0] for row in terms.rows] == ["x", "y", "z"]


def test_a_bias_instability_of_the_data_sheet_is_drawn_at_its_lowest_point() -> None:
    """Lowest point 10 µg: a level line; its path keeps one height over the whole panel."""
    rows = [r for r in synthetic_noise.allan() if r["channel"].startswith("accel")]
    lowest = 10e-6 * 9.80665
    stated = {"white_noise": None, "bias_instability": lowest / 0.6643, "random_walk": None}
    sheet = [{"sensor": "accel", "axis": axis, **stated, "source": "s"} for axis in "xyz"]
    assert abs(LOWEST - 0.6643) < 1e-4  # √(2 ln 2 / π), IEEE Std 952
    drawn = allan_figure(rows, sheet).drawn
    both = re.findall(r'<path d="([^"]+)"[^>]*stroke-dasharray: 3\.6', drawn)
    dashed = max(both, key=len)  # the other one is that of the legend
    heights = [float(y) for y in re.findall(r"[ML] [\d.]+ ([\d.]+)", dashed)]
    assert np.ptp(heights) < 1e-3


def test_white_noise_by_manoeuvre_stands_in_a_section_of_its_own() -> None:
    tables = synthetic.tables_of(synthetic.campaign(logs=()))
    kinds = [type(part) for part in noise_by_manoeuvre.SECTION.parts(tables)]
    assert kinds == [Figure, Table, Table, Table]


def test_bins_of_few_degrees_of_freedom_are_one_point_and_an_oscillation_stays_apart() -> None:
    """30 bins of 2 degrees in a tenth of a decade: their mean, and 60 degrees together."""
    frequency = np.geomspace(0.01, 0.0115, 30)
    rows = [
        {"frequency": f, "density": float(i % 3), "degrees": 2.0, "line": i == 29}
        for i, f in enumerate(frequency)
    ]
    place, density, degrees = noise_figures.pooled(rows)
    assert degrees.tolist() == [58.0, 2.0]
    assert density == pytest.approx([28 / 29, 2.0])
    assert frequency[0] < place[0] < frequency[28] and place[1] == pytest.approx(0.0115)

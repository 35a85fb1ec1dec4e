"""The report as a reader of the page sees it."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from inertial.tables import CERTIFICATE
from inertial.text.units import DEGREES_PER_HOUR
from stages.report import results
from stages.report.outline import Heading, Paragraph, Part, Section, Table
from stages.report.sections import (
    basis,
    certificate,
    certified_values,
    characteristics,
    uncertainty_budget,
    unmodelled_effects,
)
from stages.report.sections.effect_terms import (
    OF_A_LAW,
    OF_ANOTHER_MODEL,
    OF_THE_PLAN,
    SET,
    with_scanned_sigmas,
    without_sigma,
)
from stages.report.sections.parameters import PARAMETERS
from stages.report.stage import ANNEXES, EVIDENCE, STAGE, report
from tests.report import synthetic, synthetic_faults, synthetic_unmodelled
from tests.report.synthetic_diagnosis import diagnosed
from tests.report.synthetic_values import Held, rows_as

TITLES = [
    "Result",
    "What is wrong, and what was done",
    "Noise",
    "Residuals",
    "Unmodelled effects",
    "Comparisons",
    "Compensation",
    "Navigation performance",
    "Alignment and rotation modulation",
    "Uncertainty budget",
    "Temperature",
    "Earlier calibrations",
    "Repeatability and drift",
    "Parameters",
    "Undetermined parameters",
    "What shows each cause",
    "What shows each effect",
    "Residuals of the joint fit",
    "Checks of the compensated readings",
    "Sensor characteristics",
    "Parameters against averaging time",
    "Studies",
    "Recorded manoeuvres",
    "Raw data",
    "White noise by manoeuvre",
    "Known quantities",
    "Ideal readings at the site",
    "Data accounting",
    "Provenance",
    "Terms",
]
UNITS = {  # by their definitions
    "µg": 9.80665e-6,
    "°/h": np.pi / 180 / 3600,
    "ppm": 1e-6,
    "arcsec": np.pi / 180 / 3600,
    "10⁻³ m/s²": 1e-3,
    "10⁻⁶ rad/s": 1e-6,
    "10⁻⁶": 1e-6,
    "µrad": 1e-6,
}
AT_REST = "at rest on the level"
HOSTILE = '<script>alert("1")</script>&$x_1$</style><img src=x onerror=alert(1)>'


class Page(HTMLParser):
    """The elements of a page, the cells of rows by identifier, and its text."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.rows: dict[str, list[str]] = {}
        self.text = ""
        self.headings: list[str] = []
        self.traced: dict[str, tuple[str, str, str]] = {}  # value, sigma, unit by identifier
        self._cells: list[str] = []
        self._ids: dict[int, str] = {}
        self._row: list[str] | None = None
        self._heading = False
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: Sequence[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += attrs
        if tag == "tr":
            identifier = dict(attrs).get("id")
            self._row = self.rows.setdefault(identifier, []) if identifier else None
            self._cells, self._ids = [], {}
        if tag == "td":
            self._cells.append("")
        if tag == "td" and self._row is not None:
            self._row.append("")
        if identifier := dict(attrs).get("data-id"):
            self._ids[len(self._cells) - 1] = identifier
        if tag == "h2":
            self.headings.append("")
            self._heading = True

    def handle_endtag(self, tag: str) -> None:
        if tag == "tr":
            units = ["", *(cell for cell in self._cells if cell in UNITS)]
            for place, identifier in self._ids.items():
                value, sigma = self._cells[place : place + 2]
                self.traced[identifier] = (value, sigma, units[-1])
            self._row = None
        if tag == "h2":
            self._heading = False

    def handle_data(self, data: str) -> None:
        self.text += data
        if self._row:
            self._row[-1] += data
        if self._cells:
            self._cells[-1] += data
        if self._heading:
            self.headings[-1] += data


def number(cell: str) -> float:
    """What a cell says, its padding and signs of typography taken off."""
    for letter in "\u2007\u2008\u202f±":
        cell = cell.replace(letter, "")
    return float(cell.replace("−", "-"))


@pytest.mark.slow
def test_sections_stand_in_their_order() -> None:
    page = Page(synthetic.documents()["html"])
    assert [heading.partition(" ")[2] for heading in page.headings] == TITLES
    assert page.headings[13].startswith("A ")


def test_every_determined_parameter_stands_with_its_sigma_and_unit() -> None:
    page = Page(synthetic.documents()["html"])
    tables = synthetic.campaign()
    both = pd.concat([tables["accelerometer_parameters"], tables["gyroscope_parameters"]])
    for row in both.dropna(subset=["value"]).itertuples():
        value, sigma, unit = page.traced[row.id]
        assert number(value) * UNITS[unit] == pytest.approx(row.value, abs=0.06 * row.sigma)
        assert number(sigma) * UNITS[unit] == pytest.approx(row.sigma, rel=0.06)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("system", "unit", "per_si"), [("laboratory", "°/h", 180 / np.pi * 3600), ("SI", "rad/s", 1e6)]
)
def test_a_table_is_in_one_system_of_units(system, unit, per_si):
    """A bias of 1.30e-6 rad/s is 0.268 °/h."""
    made = synthetic.brief()
    provenance = synthetic.provenance_of(made)
    page = Page(report(**{**made, "provenance": provenance}, units=system)["html"])
    value, _, shown = page.traced["gyroscope/joint/bias_x"]
    assert shown.endswith(unit)
    assert number(value) == pytest.approx(1.30e-6 * per_si, rel=0.02)


def test_what_is_not_determined_has_its_reason_and_no_value() -> None:
    page = Page(synthetic.documents()["html"])
    assert "gyroscope/turns/cross_xy" not in page.rows
    assert "rests in six positions would help" in page.text


def parameters_of(made: dict[str, Any], section: Section = PARAMETERS) -> list[Part]:
    """The section of parameters, built from the tables that it declares."""
    own = {name: made[name] for name in (*section.reads, "provenance")}
    return list(section.parts(synthetic.tables_of(own)))


def words_of(parts: Sequence[Part]) -> str:
    return " ".join(part.text for part in parts if isinstance(part, Paragraph | Heading))


def fits_of(parts: Sequence[Part]) -> str:
    (fits,) = (
        part for part in parts if isinstance(part, Table) and part.columns[1].heading == "χ²"
    )
    return " ".join(row.cells[-1] for row in fits.rows)


def test_the_result_that_counts_stands_first_and_once() -> None:
    made = synthetic.brief()
    made["result"]["value"] += made["result"]["sigma"]  # by no method: a mixture
    made["result"]["method"] = "mixture"
    page = Page(synthetic.report_on(made)["html"])
    first = [row for row in page.rows if re.fullmatch(r"diagnosis/\w+/bias_x", row)]
    assert first == ["diagnosis/accelerometer/bias_x", "diagnosis/gyroscope/bias_x"]
    # 1.30e-6 rad/s and five sigma of 2.1e-8 (the extended fit moved it by four) are 0.2898 °/h
    assert number(page.rows["diagnosis/gyroscope/bias_x"][1]) == pytest.approx(0.2898, abs=1e-4)
    assert page.text.count("Result: Gyro, mean over the models that") == 1
    assert page.text.index("Result: Gyro") < page.text.index("By method")


def spoilt() -> dict[str, Any]:
    """The result of the gyros withheld, for their verdict."""
    made, why = synthetic.brief(), "Gyros: saturation. Not usable."
    own = made["result"]["sensor"] == "gyro"
    made["result"].loc[own, ["value", "sigma"]] = np.nan
    made["result"].loc[own, "reason"] = why
    made["verdict"].loc[made["verdict"]["sensor"] == "gyro", ["verdict", "sentence"]] = (
        "not_usable",
        why,
    )
    return made


def test_a_result_that_is_withheld_is_said_to_be_and_why_once() -> None:
    made = spoilt()
    page = Page(synthetic.report_on(made)["html"])
    assert page.text.count("Gyros: saturation. Not usable.") == 1
    assert "Gyros: the result is withheld" in page.text
    assert "values above are evidence" not in page.text
    assert "Withheld: the sensor is not usable, as page one says." in page.text
    assert "the result that counts is withheld: Gyro." in page.text
    captions = [part.caption for part in parameters_of(made) if isinstance(part, Table)]
    assert [text for text in captions if "value and sigma of each" in text] == [
        "Accelerometer, joint fit of all manoeuvres: value and sigma of each parameter."
    ]
    assert any(text.startswith("Gyro: the same parameters by") for text in captions)  # as evidence


@pytest.mark.slow
def test_terms_are_those_that_the_report_uses() -> None:
    made = synthetic.documents()["html"]
    listed = made[made.index('<section id="terms">') :]
    assert "<dt>held-out</dt>" in listed and "<dt>joint fit</dt>" in listed
    little = synthetic.report_on(synthetic.poor())["html"]
    assert "<dt>SNR</dt>" not in little[little.index('<section id="terms">') :]


def test_without_a_laboratory_it_is_no_certificate() -> None:
    made = synthetic.brief()
    assert "Released by" not in synthetic.section_on(made, certificate.SECTION)
    stated = made["certificate"]
    row = {"item": "laboratory.name", "text": "A laboratory", "unit": "", "file": ""}
    row |= {"required": True}
    made["certificate"] = pd.concat([stated, rows_as(CERTIFICATE, [row])])
    shown = synthetic.section_on(made, certificate.SECTION)
    signed = "<span>Calibrated by</span> not stated"
    for words in ("Certificate</h2>", signed, "Released by", "End of the certificate"):
        assert words in shown


@pytest.mark.slow
def test_effects_of_the_result_stand_below_its_parameters() -> None:
    made = synthetic.brief()
    effect = made["result"].query("sensor == 'gyro'").iloc[:1].assign(
        id="diagnosis/gyroscope/gyro_g_sensitivity.g_xx",
        parameter="gyro_g_sensitivity.g_xx",
        effect="gyro_g_sensitivity",
        value=6.92e-7,
        sigma=1.38e-8,
        unit="(rad/s)/(m/s²)",
    )  # fmt: skip
    made["result"] = pd.concat([made["result"], effect], ignore_index=True)
    page = Page(synthetic.report_on(made)["html"])
    cells = page.rows["diagnosis/gyroscope/gyro_g_sensitivity.g_xx"]
    # 6.92e-7 (rad/s)/(m/s²) is 6.92e-7 · 9.80665 m/s² · 3600 s · 180°/π = 1.3998 °/h/g
    assert cells[0] == "gxx"
    assert number(cells[1]) == pytest.approx(1.3998, abs=0.002)
    assert cells[3] == "°/h/g"


def test_effects_whose_constants_come_last_are_listed_whole() -> None:
    """All bias terms first and the constants of both effects after them, as the result has them."""
    made = synthetic.brief()
    one = made["result"].query("sensor == 'gyro'").iloc[:1]

    def row(effect: str, name: str, sigma: float, unit: str, frame: str) -> pd.DataFrame:
        name = f"{effect}.{name}"
        own = {"id": f"diagnosis/gyroscope/{name}", "effect": effect, "parameter": name}
        return one.assign(**own, value=41.0, sigma=sigma, unit=unit, frame=frame)

    made["result"] = pd.concat(
        [
            made["result"],
            *(row("gyro_warm_up", f"b_{axis}", 1e-4, "rad/s", "body") for axis in "xyz"),
            row("gyro_temperature", "bias_x_1", 1e-4, "rad/s/K", "body"),
            row("gyro_warm_up", "tau", np.nan, "s", ""),
            row("gyro_temperature", "T0", np.nan, "K", ""),
        ],
        ignore_index=True,
    )
    tables = [part for part in parameters_of(made) if isinstance(part, Table)]
    (own,) = (
        part for part in tables if "value and sigma" in part.caption and "Gyr" in part.caption
    )
    last = [row.cells[-1].rpartition("/")[2] for row in own.rows[-8:]]
    assert [name for name in last if "." in name] == [
        *(f"gyro_warm_up.{name}" for name in ("b_x", "b_y", "b_z", "tau")),
        *(f"gyro_temperature.{name}" for name in ("bias_x_1", "T0")),
    ]
    heads = [row.cells[0] for row in own.rows if "frame" in row.cells[0]]
    assert heads[-1].endswith("frame: case")  # constants have none


def test_constants_of_effects_are_no_gaps_and_temperatures_are_in_celsius() -> None:
    """τ of 41.7 s was scanned and is known to 2.1 s; 298.38 K are 25.23 °C."""
    own = {"mount": "", "sensor": "gyro", "effect": "gyro_warm_up", "meaning": "", "id": "a"}

    def row(name: str, value: float, sigma: float | None, unit: str) -> dict[str, Any]:
        return own | {"parameter": name, "value": value, "sigma": sigma, "unit": unit}

    rows = [
        row("gyro_warm_up.b_z", 0.00438, 8e-5, "rad/s"),
        row("gyro_warm_up.tau", 41.674, None, "s"),
        row("gyro_warm_up.T_min", 298.38, None, "K"),
    ]
    detected = [row("tau", 41.674, 2.126, "s")]
    table = certified_values.further_terms(rows, {}, detected)
    _head, _b, tau, low = (line.cells for line in table.rows)
    assert tau[1:4] == ("41.7", "4.3", "s")  # U is twice sigma
    assert float(low[1]) == pytest.approx(25.23) and low[2:4] == ("—", "°C")
    assert "constant of the effect" in table.note
    assert "constant of" not in certified_values.further_terms(rows[:2], {}, detected).note


def test_a_scanned_constant_has_its_sigma_or_the_reason_why_it_has_none() -> None:
    own = {"mount": "", "sensor": "gyro"}
    tau = own | {"effect": "gyro_warm_up", "parameter": "gyro_warm_up.tau", "value": 41.7}
    found = own | {"effect": "gyro_warm_up", "parameter": "tau", "value": 41.7, "sigma": 2.1}
    rows = [tau | {"sigma": None}]
    assert with_scanned_sigmas(rows, [found]) == [tau | {"sigma": 2.1}]
    elsewhere = with_scanned_sigmas(rows, [found | {"value": 40.0}])  # in another model
    assert [*without_sigma(elsewhere)] == [OF_ANOTHER_MODEL]
    turn = own | {"effect": "turn_angle_error", "parameter": "turn_angle_error.turn", "value": 3.0}
    assert [*without_sigma([turn | {"sigma": None}])] == [OF_THE_PLAN]
    degree = tau | {"effect": "gyro_temperature", "parameter": "gyro_temperature.T0"}
    law = {"effect": "gyro_all_ramp_of_time", "parameter": "gyro_all_ramp_of_time.shape_1"}
    constants = [degree | {"sigma": None}, tau | law | {"sigma": None}]
    assert [*without_sigma(constants)] == [SET, OF_A_LAW]


def test_a_constant_of_an_effect_is_not_called_undetermined() -> None:
    made = synthetic.brief()
    one = made["result"].query("sensor == 'gyro'").iloc[:1].assign(effect="gyro_warm_up")
    size = one.assign(parameter="gyro_warm_up.b_z", value=0.00438, sigma=8e-5)
    tau = one.assign(parameter="gyro_warm_up.tau", value=41.674, sigma=np.nan)
    made["result"] = pd.concat([made["result"], size, tau], ignore_index=True)
    known = [
        {"parameter": "b_z", "value": 0.0044, "sigma": 9e-5},
        {"parameter": "tau", "value": 41.674, "sigma": 2.126},
        {"parameter": "b_y", "value": 1e-5, "sigma": 9e-5},  # the result does without it
    ]
    tables = synthetic.tables_of({name: made[name] for name in ("result", "provenance")})
    finding = {"mount": "", "cause": "gyro_warm_up"}
    values = [row["value"] for row in unmodelled_effects._of_result(tables, finding, known)]
    assert values == [0.00438, 41.674, None]


def test_a_model_that_does_not_fit_says_so_plainly() -> None:
    parts = parameters_of(synthetic.brief())
    said = words_of(parts)
    assert "χ² = 590.0 with 594 degrees of freedom: the model describes the data within" in said
    words = "The model does not describe the data within the noise; the σ include noise only"
    assert words in fits_of(parts)


def test_a_scatter_that_the_sigmas_include_is_stated() -> None:
    made = synthetic.brief()
    made["gyroscope_fit"]["scatter"] = 0.5 * np.pi / 180 / 3600
    words = "With a scatter of the manoeuvres by 0.50 °/h, which this χ² and the σ allow for; noise"
    assert words in fits_of(parameters_of(made))
    made["gyroscope_fit"]["scatter_seconds"] = 32.4
    words = "by 0.50 °/h in a rest of 32 s and less in a longer one, which this χ²"
    assert words in fits_of(parameters_of(made))


def test_mounts_stand_apart() -> None:
    made = synthetic.brief()
    upright = made["result"].query("sensor == 'accel'")
    lying = upright.assign(mount="lying", value=np.nan, id=upright["id"] + "@lying")
    made["result"] = pd.concat([made["result"], lying], ignore_index=True)
    said = words_of(parameters_of(made))
    assert "Result: Accelerometer, joint fit of all manoeuvres" in said
    assert "Result: Accelerometer (mount lying), joint fit of all manoeuvres" in said
    values = synthetic.section_on(made, certificate.SECTION)
    assert values.count("frame: case") == 2
    assert "mount lying, frame: case" in values


def test_the_budget_has_the_shares_of_each_kind() -> None:
    """Parts of 3 and 4 ppm are 36 and 64 % of (5 ppm)²."""
    shown = synthetic.section_on(synthetic.brief(), uncertainty_budget.SECTION)
    cells = re.findall(r"<td[^>]*>([^<]*)</td>", shown)
    assert cells == [
        *("Accelerometer, scale error", "5.0", "ppm", "36", "64"),
        *("Gyro, scale error", "5.0", "ppm", "36", "64"),
    ]


def test_parameters_without_shares_are_said() -> None:
    made = synthetic.brief()
    made["uncertainty_budget"] = made["uncertainty_budget"].iloc[:0]
    shown = synthetic.section_on(made, uncertainty_budget.SECTION)
    for sensor in ("Accelerometer", "Gyro"):
        assert f"{sensor}, not split: all parameters; its σ differs" in shown
    made["result"]["method"] = "mixture"
    shown = synthetic.section_on(made, uncertainty_budget.SECTION)
    assert "not split: all parameters; the result is a mean over models" in shown


def test_an_unmodelled_effect_is_named_with_its_numbers() -> None:
    page = Page(synthetic.documents()["html"])
    assert "Detected: gyro g-sensitivity and oscillation." in page.text
    # 6.92e-7 (rad/s)/(m/s²) is 6.92e-7 · 9.80665 m/s² · 3600 s · 180°/π = 1.3998 °/h/g
    cells = page.rows["criticism/gyro_g_sensitivity/g_xx"]
    assert number(cells[1]) == pytest.approx(1.3998, abs=0.002)
    assert cells[3] == "°/h/g"
    assert number(cells[4]) == pytest.approx(6.92e-7 / 1.38e-8, abs=0.1)
    assert "criticism/gyro_g_sensitivity/g_xy" not in page.rows  # within 3 σ
    assert "6 parameters within 3 σ of zero not listed." in page.text


def test_detection_limits_say_what_would_have_been_detected() -> None:
    page = Page(synthetic.documents()["html"])
    effect, worst, best, unit, *_ = page.rows["limit/lever_arm/r_y"]  # the worst of three axes
    assert [effect, worst, best, unit] == ["Lever arm", "1.6", "0.90", "mm"]
    assert "limit/table_tilt/north" not in page.rows
    assert "limit/gyro_g_sensitivity/g_xx" not in page.rows  # it was named
    assert "No manoeuvre excites it.Table tilt." in page.text


def test_a_shift_of_the_extended_model_is_in_sigmas_of_the_joint_fit() -> None:
    page = Page(synthetic.documents()["html"])
    assert number(page.rows["extension/gyroscope/bias_x"][6]) == 4.0
    assert number(page.rows["extension/gyroscope/bias_y"][6]) == 0.0


def test_which_result_counts_is_stated_beside_the_effects() -> None:
    text = Page(synthetic.documents()["html"]).text
    assert "The result of the gyros includes gyro g-sensitivity." in text
    assert "The joint result of the accelerometers counts" not in text  # they show no effect


def test_the_error_of_navigation_is_stated_in_mrad_and_mm_per_second() -> None:
    text = " ".join(Page(synthetic.documents()["html"]).text.split())
    # 1 °/h for 60 s: 1/60° are 0.291 mrad, and 9.8 · ψ t / 2 are 86 mm/s; a tenth in turns.
    assert "is up to 0.291 ± 0.001 mrad and 85.5 ± 0.3 mm/s at rest, 0.029" in text


@pytest.mark.slow
def test_no_effect_is_detected() -> None:
    tables = synthetic_unmodelled.without_effects()
    tables["scores"]["degrees"] = 3
    documents = synthetic.report_on(tables)
    assert "None detected: none of the five effects is significant." in Page(documents["html"]).text
    assert "Detected" not in documents["txt"]


@pytest.mark.slow
def test_an_effect_of_two_mounts_stands_twice() -> None:
    tables = synthetic.brief()
    for name in ("scores", "effects", "criticism_findings", "members", "detection_limits"):
        both = [tables[name], tables[name].copy()]
        both[1]["mount"] = "lying"
        for key in {"id", "finding"} & set(both[1].columns):
            both[1][key] += " of lying"
        tables[name] = pd.concat(both, ignore_index=True)
    page = Page(synthetic.report_on(tables | diagnosed(tables))["html"])
    assert "Oscillation (mount lying)" in page.text
    twice = [page.rows[f"limit/lever_arm{mount}/r_y"][1:] for mount in ("/lying", "")]
    assert twice[0] == twice[1]


def test_what_is_hardly_known_does_not_stand_before_what_is() -> None:
    """A scale factor by rests is off by 30 of its σ, each of which is 25 000 σ of the result."""
    made = synthetic.brief()
    clear = made["differences"].query("kind == 'static_against_turns'").iloc[:1]  # of bias x
    coarse = clear.assign(id="comparison/coarse", quantity="scale_x", unit="1", sigma=0.065)
    made["differences"] = pd.concat([coarse.assign(in_sigmas=30.0), made["differences"]])
    page = Page(synthetic.report_on(made)["html"])
    places = [row for row in page.rows if row.startswith("comparison/")]
    assert places.index(clear["id"].item()) < places.index("comparison/coarse")
    assert "At rest a gyro senses the earth's rate alone" in page.text
    difference = page.rows[clear["id"].item()][4]
    assert number(difference) == pytest.approx(
        DEGREES_PER_HOUR.of(clear["in_sigmas"].item() * clear["sigma"].item()), rel=0.02
    )


def test_comparisons_come_worst_first() -> None:
    page = Page(synthetic.documents()["html"])
    places = [row for row in page.rows if row.startswith("comparison/")]
    assert places == [
        "comparison/static_against_turns/gyroscope/bias_x",
        "comparison/method_against_method/gyroscope/bias_y",
        "comparison/published/gyroscope/bias_y",
    ]
    assert "Not compared. Not independent: scale factor of the x gyro." in page.text
    assert "1 of 2 pairs of values differs by more than chance." in page.text


def test_checks_stand_before_and_after() -> None:
    page = Page(synthetic.documents()["html"])
    cells = page.rows["compensation/gravity/x-up"]
    # 5e-3 m/s² before, 0.4 · 6e-6 m/s² after, in µg of 9.80665e-6 m/s²
    assert number(cells[2]) == pytest.approx(509.86, abs=0.01)
    assert number(cells[3]) == pytest.approx(0.245, abs=0.01)
    assert number(page.rows["compensation/angle/x-forward"][5]) == 7.0


def test_the_figures_of_the_standards_stand_beside_what_noise_explains() -> None:
    page = Page(synthetic.documents()["html"])
    cells = page.rows["compensation/gyro/linearity_error_x"]
    assert cells == ["x", "30.0", "±\u202f4.0", "11", "ppm", "10.0 °/s", "8"]
    assert "y gyro, linearity error: not determined, for nothing was applied." in page.text


def test_a_difference_says_which_two_methods_it_is_of() -> None:
    page = Page(synthetic.documents()["html"])
    compared = page.rows["comparison/method_against_method/gyroscope/bias_y"][0]
    assert compared == (
        "Turn and stop, Han & Fu 2019: M, and the bias by turns; joint fit of all manoeuvres"
    )


def test_an_upper_and_a_lower_limit_have_digits_that_tell_them_apart() -> None:
    """10.8 and 11.3 °/h; to two digits both are 11."""
    row = {"lower": np.radians(10.8 / 3600), "value": np.radians(11.3 / 3600)}
    assert characteristics.between(row, DEGREES_PER_HOUR) == "10.8 – 11.3"


def test_earlier_calibrations_and_the_archive_are_named() -> None:
    text = Page(synthetic.documents()["html"]).text
    assert "2 earlier calibrations, the latest last." in text
    assert "campaign of 2025-06-30" in text
    assert "data/history/simulated/NovAtel+SPAN-CPT/SIM-001/2026-11-02-made-up.parquet" in text


def test_ideal_readings_stand_in_both_frames() -> None:
    """At 30.5278°: 15.0411 °/h times cosine and sine; S0 has g = 9.7936174 m/s² there."""
    html = synthetic.section_on(synthetic.campaign(()), basis.IDEAL)
    cells = (re.findall(r"<td[^>]*>([^<]*)</td>", line) for line in html.split("<tr"))
    ned, enu = ([number(cell) for cell in own[1:]] for own in cells if own[:1] == [AT_REST])
    assert ned == pytest.approx([12.9561, 0, -7.6402, 0, 0, -9.793617], abs=6e-5)
    assert enu == pytest.approx([0, 12.9561, 7.6402, 0, 0, 9.793617], abs=6e-5)


def test_the_gain_by_rotation_stands_with_its_sigma() -> None:
    """65 s at 6 °/s: half the angle in radians, 3.40."""
    text = Page(synthetic.documents()["html"]).text
    assert "21.7 arcmin at rest and by 6.37 arcmin under rotation, 3.40 ± 0.15 times less" in text
    assert "A turn does: the bias turns with the case" in text


@pytest.mark.slow
def test_texts_from_outside_are_harmless() -> None:
    tables = synthetic.brief("x-up.asc")
    for table in ("campaign", "known", "inputs", "manoeuvres", "accounts", "refused", "performed"):
        for column in tables[table].columns:
            if isinstance(tables[table][column].dtype, pd.StringDtype):
                tables[table][column] = HOSTILE
    for table in ("traces", "segments", "clocks", "quality_findings"):
        tables[table]["log"] = HOSTILE
        if "manoeuvre" in tables[table]:
            tables[table]["manoeuvre"] = HOSTILE
    whole = synthetic.campaign(logs=("x-up.asc",))
    tables["noise"] = whole["noise"].assign(manoeuvre=HOSTILE)
    tables["fidelity"] = whole["fidelity"].assign(manoeuvre=HOSTILE, profile=HOSTILE)
    tables["simulated"] = Held(whole["simulated"].frame.assign(manoeuvre=HOSTILE))
    tables["compensated_traces"] = whole["compensated_traces"].assign(log=HOSTILE)
    tables["scores"][["cause", "sentence"]] = HOSTILE
    tables["effects"]["meaning"] = HOSTILE
    tables["lines"]["manoeuvre"] = HOSTILE
    tables["gain_effects"]["effect"] = HOSTILE
    tables["detection_limits"][["sentence", "explanation", "remark", "parameter"]] = HOSTILE
    tables["verdict"][["reason", "sentence"]] = HOSTILE
    tables["causes"][["sentence", "log", "manoeuvre", "gain", "condition", "done"]] = HOSTILE
    tables["causes"][["consequence", "action"]] = HOSTILE
    tables["cause_members"]["member"] = HOSTILE
    tables["result"][["meaning", "frame"]] = HOSTILE
    tables["structures"][["kind", "sensor", "axis"]] = HOSTILE
    tables["members"]["effect"] = HOSTILE
    told = ["sentence", "consequence", "action", "manoeuvre"]
    tables["criticism_findings"][[*told, "split_manoeuvre"]] = HOSTILE
    tables["differences"][["kind", "sentence"]] = HOSTILE
    tables["checks"]["manoeuvre"] = HOSTILE
    tables["archived"]["file"] = HOSTILE
    tables["earlier"] = whole["earlier"].assign(campaign=HOSTILE, file=HOSTILE, date=HOSTILE)
    html = synthetic.report_on(tables)["html"]
    page = Page(html)
    assert page.tags.count("script") == 2  # the origins of the numbers, and what shows them
    assert HOSTILE not in html
    assert "img" not in page.tags
    assert not [name for name, _ in page.attributes if name.startswith("on")]
    assert HOSTILE in page.text


def test_nothing_is_loaded_from_elsewhere() -> None:
    html = synthetic.documents()["html"]
    page = Page(html)
    assert not {"link", "img", "iframe", "object"} & set(page.tags)
    targets = [value or "" for name, value in page.attributes if name.endswith(("href", "src"))]
    assert all(target.startswith("#") for target in targets)
    assert html.count("url(") == html.count("url(#") + html.count('url("data:font/woff2;base64,')
    assert str(Path.cwd()) not in html
    assert len(html.encode()) < 4_000_000


def test_identifiers_are_unique() -> None:
    identifiers = [v for name, v in Page(synthetic.documents()["html"]).attributes if name == "id"]
    assert len(identifiers) == len(set(identifiers))


@pytest.mark.parametrize("faulty", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_every_link_leads_somewhere(faulty: bool) -> None:
    made = synthetic.report_on(synthetic_faults.faulty()) if faulty else synthetic.documents()
    targets = re.findall(r'<a href="#([^"]+)"', made["html"])
    assert targets
    assert not {target for target in targets if f'id="{target}"' not in made["html"]}


@pytest.mark.slow
def test_the_same_tables_give_the_same_bytes() -> None:
    first, second = (synthetic.report_on(synthetic.brief("z-backward.asc")) for _ in range(2))
    assert first == second


def test_a_campaign_that_gave_nothing_says_so_in_words() -> None:
    documents = synthetic.report_on(synthetic.poor())
    page = Page(documents["html"])
    headings = [heading.partition(" ")[2] for heading in page.headings]
    # Where no parameter depends on the temperature nothing is said of it; so of figures.
    silent = ("Temperature", "Sensor characteristics")
    silent += ("What shows each effect", "Checks of the compensated readings")
    silent += ("Navigation performance", "Alignment and rotation modulation", "Uncertainty budget")
    silent += ("Repeatability and drift", "Ideal readings at the site")
    assert headings == [title for title in TITLES if title not in silent]
    assert "Verdict: not usable" in documents["txt"]
    assert "Nothing was estimated of any sensor." in page.text
    assert "None: no method estimated a parameter." in page.text
    assert "None: no log gave samples that could be drawn." in page.text
    assert "No effect was tested" in page.text
    assert "No whole turn was simulated." in page.text
    assert "None: no parameter was estimated in two ways" in page.text
    assert "None: no compensated reading could be checked." in page.text
    assert "None: the archive holds no earlier calibration" in page.text
    assert "no static positions of known attitude and no turns that could be studied" in page.text


@pytest.mark.slow
def test_one_sensor_without_time_stamps_or_turns() -> None:
    tables = synthetic.brief("x-up.asc", "y-up.asc")
    for axis in "xyz":
        tables["traces"][[f"least_gyro_{axis}", f"most_gyro_{axis}"]] = np.nan
    for table in ("traces", "segments", "clocks", "quality_findings", "segment_findings"):
        tables[table][["from_s", "to_s"]] = np.nan
    noise = synthetic.campaign(logs=())["noise"]
    tables["noise"] = noise.query("channel.str.startswith('accel')")
    tables["manoeuvres"] = tables["manoeuvres"].query("do == 'rest'")
    for table in ("parameters", "fit", "averaging"):
        tables[f"gyroscope_{table}"] = tables[f"gyroscope_{table}"].iloc[:0]
    tables["result"] = tables["result"].query("sensor == 'accel'")
    tables["campaign"]["serial"] = "unknown"
    documents = synthetic.report_on(tables)
    values = synthetic.section_on(tables, certificate.SECTION)
    gyros = re.findall(r'data-label="Gyro value">([^<]*)</td>', values)
    assert gyros == ["—"] * 12
    assert "without time stamps" in documents["html"]
    assert "not recorded" in documents["html"]


@pytest.mark.slow
def test_a_hundred_manoeuvres_in_one_log() -> None:
    tables = synthetic.brief("x-up.asc")
    names = [f"tumble-{number:03d}" for number in range(102)]
    for table in ("manoeuvres", "performed"):
        rows = tables[table].iloc[[0] * len(names)].reset_index(drop=True)
        tables[table] = rows.assign(manoeuvre=names)
    segments = tables["segments"].iloc[[0] * len(names)].reset_index(drop=True)
    start = np.arange(len(names)) * 2.9
    tables["segments"] = segments.assign(manoeuvre=names, from_s=start, to_s=start + 2)
    noise = synthetic.campaign(logs=())["noise"].query("manoeuvre == 'x-up'")
    tables["noise"] = pd.concat([noise.assign(manoeuvre=name) for name in names])
    page = Page(synthetic.report_on(tables)["html"])
    assert "tumble-101" in page.text
    assert "and 96 more" in page.text


def test_the_command_writes_page_and_verdict(tmp_path: Path) -> None:
    write(synthetic.brief("x-up.asc"), tmp_path / "derived")
    STAGE.command_line([str(tmp_path / "derived"), "--documents", str(tmp_path / "reports/a")])
    page, verdict = tmp_path / "reports/a.html", tmp_path / "reports/a.txt"
    word = "Verdict: usable, with departures from the ideal\n"
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    assert word in verdict.read_text(encoding="utf-8")
    assert sorted(path.name for path in page.parent.iterdir()) == ["a.html", "a.txt"]


def test_a_table_of_another_version_is_refused(tmp_path: Path) -> None:
    write(synthetic.brief("x-up.asc"), tmp_path)
    path = STAGE.paths(tmp_path)["noise"]
    table = pq.read_table(path)
    pq.write_table(table.replace_schema_metadata({"table": "noise", "version": "0"}), path)
    with pytest.raises(SystemExit) as refused:
        STAGE.command_line([str(tmp_path), "--documents", "a"])
    assert str(refused.value) == (
        f"report: {path}\n"
        "  found:    noise table of version 0\n"
        "  expected: noise table of version 2\n"
        "  cure:     delete the file and run the campaign again"
    )


def write(tables: dict[str, Any], derived: Path) -> None:
    """The tables as stages leave them."""
    for name, path in STAGE.paths(derived).items():
        given = tables[name]
        rows = given.frame if name in STAGE.declared.streams else given
        arrow: pa.Table = STAGE.reads[name].arrow(rows)
        made_by = {"made_by": json.dumps(tables["provenance"][name])}
        path.parent.mkdir(parents=True, exist_ok=True)
        pq.write_table(arrow.replace_schema_metadata({**arrow.schema.metadata, **made_by}), path)


@pytest.mark.slow
def test_a_section_reads_no_table_but_those_it_declares() -> None:
    made = synthetic.campaign(logs=("z-backward.asc",))
    read = {name for section in (*EVIDENCE, *ANNEXES) for name in section.reads}
    assert read | set(results.READS) == set(STAGE.reads)
    for section in (*EVIDENCE, *ANNEXES):
        own = {name: made[name] for name in (*section.reads, "provenance")}
        assert list(section.parts(synthetic.tables_of(own))), section.key


def test_a_bandwidth_says_what_it_is_of() -> None:
    text = Page(synthetic.section_on(synthetic.campaign(), characteristics.SECTION)).text
    assert "gyro: ramps, by the encoder of the table: response to rates" in text
    assert "53.05" in text
    assert "accelerometer, bandwidth: not determined, for nothing changes fast." in text

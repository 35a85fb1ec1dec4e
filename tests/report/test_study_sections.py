"""The page of studies: what it says in numbers, and what of it is left where there is little."""

import re
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from inertial import tables
from stages.report.outline import Figure, Paragraph, Part, Section, Sentences, Table
from stages.report.sections import (
    averaging,
    basis,
    characteristics,
    comparisons,
    residuals,
    studies,
)
from stages.studies.declared import DECLARED
from tests.report import synthetic
from tests.report.synthetic_studies import studies as synthetic_studies
from tests.report.synthetic_values import rows_as

STAGES = ("accelerometer", "gyroscope")


@pytest.fixture
def made() -> dict[str, pd.DataFrame]:
    rows = synthetic_studies(np.random.default_rng(1))
    made = {name: rows_as(DECLARED.writes[name], rows[name]) for name in DECLARED.writes}
    return made | {"levels": tables.LEVELS.empty()}


def built(section: Section, made: dict[str, pd.DataFrame]) -> list[Part]:
    return list(section.parts(synthetic.tables_of(made)))


def of(section: list[Part], kind: type) -> list:
    return [part for part in section if isinstance(part, kind)]


def number(cell: str) -> float:
    return float(cell.replace("−", "-"))


def text(section: list[Part]) -> str:
    return " ".join(part.text for part in of(section, Paragraph))


def test_every_study_has_its_figure_and_a_sentence_with_numbers(made):
    section = built(studies.SECTION, made)
    # Two sensors by epochs, their scatter, windows, growing angle, time and angle.
    assert len(of(section, Figure)) == 6
    said = text(section)
    assert "scatter 1.10 to 1.10 times as much as white noise" in said
    assert "x gyro, x-forward and x-backward: with the start of the 180° the scale" in said
    assert "± 3.0 ppm at 180°" in said
    assert "deviated from its set rate by 2.0 to 2.0 ppm" in said
    assert "common scale factor and the table's speed are one unknown" in said
    (left,) = of(section, Sentences)
    assert left.items == ("z-backward: 240.38° of 360° recorded",)


@pytest.mark.slow
def test_the_middle_of_the_turns_is_held_against_the_whole(made):
    section = built(studies.SECTION, made)
    *_, middle = of(section, Table)
    by = {(row.cells[0][0], row.cells[1]): row.cells for row in middle.rows}
    assert len(by) == 8
    whole = by["x", "the whole turn"]
    assert whole[2:] == ("615.1", "3.0", "—", "—")
    by_time = by["x", "180° by time, at the set rate"]
    assert by_time[3] == "100" and by_time[5] == "4.2"
    # The scale has the decimals of its difference from the whole turn, whatever its own σ.
    assert number(by_time[2]) - number(whole[2]) == pytest.approx(number(by_time[4]), abs=0.11)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*DECLARED.writes, "all"])
def test_without_a_table_the_rest_of_the_page_is_there(made, name):
    empty = DECLARED.writes if name == "all" else {name: DECLARED.writes[name]}
    section = built(studies.SECTION, made | {one: table.empty() for one, table in empty.items()})
    drawn = len(of(section, Figure))
    assert drawn == 0 if name == "all" else drawn >= 4
    assert bool(of(section, Sentences)) == (name not in ("not_studied", "all"))


@pytest.mark.slow
def test_chance_holds_what_the_noise_level_is_uncertain_by(made):
    """A level known to 3 % beside epochs whose own scatter is known better."""
    rows = [
        {"channel": f"{sensor}_{axis}", "white_noise": 1e-6, "sigma": 3e-8}
        | {"source": "common", "degrees": 500.0}
        for sensor in ("gyro", "accel")
        for axis in "xyz"
    ]
    exact = text(built(studies.SECTION, made))
    said = text(built(studies.SECTION, made | {"levels": rows_as(tables.LEVELS, rows)}))
    chance = [[float(c) for c in re.findall(r"give 1 ± (0\.\d+)", own)] for own in (exact, said)]
    for alone, both in zip(*chance, strict=True):
        assert both == pytest.approx(np.hypot(alone, 0.03), abs=0.01)
    assert chance[0] != chance[1]


def test_where_nothing_could_be_studied_one_sentence_says_so():
    """By hand: no use and limits of the table's speed where nothing turned."""
    some = synthetic.campaign(())

    def without(section, *names):
        return built(section, some | {name: some[name].iloc[:0] for name in names})

    (said,) = without(studies.SECTION, *studies.STUDIES, "not_studied")
    assert said.text.startswith("None: there are no static positions of known attitude")
    followed = [f"{stage}_{name}" for stage in STAGES for name in ("averaging", "wanted")]
    (said,) = without(averaging.SECTION, *followed)
    assert said.text == "None: the parameters were not followed over the averaging time."
    assert not without(basis.IDEAL, "ideal_readings")


def test_what_is_missing_for_one_reason_is_one_sentence():
    row = {"sensor": "gyro", "value": None, "lower": None, "reason": "no attitude is known"}
    rows = [
        row | {"axis": axis, "quantity": quantity}
        for quantity in ("threshold", "resolution")
        for axis in "xyz"
    ]
    made = SimpleNamespace(rows=lambda name: rows if name == "characteristics" else [])
    said, *_others = characteristics.parts(made)
    assert said.items == (
        "x, y, z gyro, threshold and resolution: not determined, for no attitude is known.",
    )


def test_rests_of_unknown_attitude_have_no_residual_of_a_simulation():
    """They are named after their manoeuvre, whose attitude the plan does not state."""
    some = synthetic.campaign()
    rests = some["fidelity"].iloc[:6].assign(manoeuvre="positions-01", profile=residuals.AT_REST)
    (said,) = built(residuals.SECTION, some | {"fidelity": rests})
    assert said.text == "None: no attitude is known to simulate readings by."


def test_a_fencepost_stands_on_top_of_the_published_values():
    named = {
        "kind": "fencepost",
        "sensor": "gyro",
        "quantity": "scale",
        "unit": "1",
        "first": "ours",
    }
    named |= {"id": "comparison/fencepost/gyroscope/scale", "second": "others"}
    named |= {"sentence": "scale factors of the gyros: fencepost."}
    other = named | {"id": "comparison/published/gyroscope/scale_x", "kind": "published"}
    other |= {"quantity": "scale_x", "first_value": 1e-3, "second_value": 1.5e-3}
    other |= {"difference": -5e-4, "sigma": 1e-5, "in_sigmas": -50.0, "p_value": 0.0}
    other |= {
        "significant": True,
        "sentence": "scale factor of the x gyro: they differ: more than chance.",
    }
    section = built(
        comparisons.COMPARISONS,
        synthetic.campaign()
        | {
            "differences": tables.DIFFERENCES.empty(),
            "published_differences": rows_as(tables.DIFFERENCES, [other, named]),
        },
    )
    assert "1 of 1 pair of values differs by more than chance." in text(section)
    assert "Scale factors of the gyros: fencepost." in text(section)
    (table,) = of(section, Table)
    assert table.rows[0].anchor == named["id"] and table.rows[0].tone == "fair"


def test_the_encoder_stands_with_its_delay_and_eccentricity():
    """50.3 µrad are 10.38 arcsec; 1/(2π 3 ms) is 53.05 Hz."""
    rows = synthetic.campaign(())["encoder"]
    section = built(studies.SECTION, synthetic.campaign(()))
    common, _turns = [
        part
        for part in of(section, Table)
        if "encoder" in part.caption or "Turn by" in part.caption
    ]
    cells = {row.cells[1]: row.cells[2:5] for row in common.rows}
    assert cells["delay of the gyro less that of the encoder"] == ("3.0000", "0.0030", "ms")
    sine = cells["error of the encoder, sine of 1 times its angle"]
    assert sine == ("10.38", "0.29", "arcsec")
    assert len(rows) == len(common.rows) + len(_turns.rows)
    assert "rest on the encoder's" in text(section)

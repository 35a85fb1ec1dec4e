"""The section on temperature: curves with their range, from tables alone; absent without them."""

from __future__ import annotations

from typing import Any

from inertial import tables
from stages.report.outline import Figure, Sentences, Table
from stages.report.sections import temperature
from tests.report import synthetic
from tests.report.synthetic import curve, rows_as


def made(**changed: Any) -> list[Any]:
    return list(
        temperature.SECTION.parts(synthetic.tables_of(synthetic.campaign(logs=()) | changed))
    )


def test_nothing_where_nothing_depends_on_the_temperature() -> None:
    assert not made(temperature_curves=tables.TEMPERATURE_CURVES.empty())


def test_a_figure_a_table_with_range_and_knot_and_the_warm_up() -> None:
    curves = curve("bias_x", probability=0.834) + curve(
        "bias_z", order=1, knot=297.95, relative_to=306.15, not_separated="or a tilt"
    )
    warm = {"mount": "", "sensor": "accel", "axis": "x", "band": 1e-4, "unit": "m/s²"}
    warm |= {"seconds": 3521.0, "sigma": 18.0, "sentence": "It settles after 3521 s."}
    figure, table, sentences = made(
        temperature_curves=rows_as(tables.TEMPERATURE_CURVES, curves),
        warm_up=rows_as(tables.WARM_UP, [warm]),
    )
    assert isinstance(figure, Figure) and "Temperature, °C" in figure.drawn
    assert isinstance(table, Table)
    x, z = (row.cells for row in table.rows)
    assert x[:5] == ("b_x", "parabola", "1.4", "65.5", "")
    assert x[-1].startswith("of this shape with a probability of 0.83;")
    assert z[1] == "two straight lines" and z[4] == "24.8"
    assert "change from 33.0 °C" in z[-1] and "or a tilt" in z[-1]
    assert isinstance(sentences, Sentences) and "3521 s" in sentences.items[0]


def test_a_change_has_its_sign_where_the_curve_does_not_turn() -> None:
    assert temperature._change([0.0, -200.0, -754.3]) == "−754"
    assert temperature._change([10.0, 2000.0, 5350.0]) == "+5340"
    assert temperature._change([1.0, 4.0, 2.0]) == "3.00"  # up, and down again

"""How numbers are written, against what a metrologist would write by hand."""

import pytest

from inertial.text import numbers
from inertial.text.numbers import FIGURE_SPACE, POINT_SPACE
from inertial.text.units import quantity


@pytest.mark.parametrize(
    ("sigma", "decimals"),
    [
        (0.43, 2),
        (1.0, 1),
        (12.4, 0),
        (250.0, -1),
        (4406.0, -2),
        (64843.0, -3),
        (99.7, -1),
        (0.0996, 2),
        (4.2e-7, 8),
        (None, None),
        (0.0, None),
    ],
)
def test_a_sigma_is_shown_to_two_digits(sigma: float | None, decimals: int | None) -> None:
    assert numbers.decimals_of(sigma) == decimals


def test_the_surest_of_a_column_says_how_many_decimals_it_has() -> None:
    assert numbers.common_decimals([1.2, 0.9]) == 2
    assert numbers.common_decimals([None, None]) is None
    assert numbers.common_decimals([64843.0, 4406.0]) == -2


@pytest.mark.parametrize(
    ("value", "sigma", "decimals", "written"),
    [  # GUM, 7.2.6: two digits of the uncertainty, and the value to the same place
        (-127641.0, 4406.0, -2, ("−127600", "4400")),
        (191789.0, 65161.0, 1, ("192000", "65000")),  # beside another of ± 5.4
        (615.13, 15.2, 0, ("615", "15")),
        (615.13, 5.42, 1, ("615.1", "5.4")),
        (0.553, 22.31, 2, ("1", "22")),  # beside another of ± 0.15
        (-13.0, 640.0, 0, ("−10", "640")),
        (3.0, 640.0, 0, ("0", "640")),
        (15586.0, None, None, ("15586", "—")),
    ],
)
def test_a_value_has_no_digits_that_its_sigma_lacks(
    value: float, sigma: float | None, decimals: int | None, written: tuple[str, str]
) -> None:
    assert numbers.with_sigma(value, sigma, decimals) == written


def test_decimal_points_stand_below_each_other() -> None:
    assert numbers.aligned(["−539.25", "5.1", "12", "—"]) == [
        "−539.25",
        f"5.1{FIGURE_SPACE}",
        f"12{POINT_SPACE}{FIGURE_SPACE * 2}",
        "—",
    ]


@pytest.mark.parametrize(
    ("value", "text"),
    [(9.79361744, "9.794"), (-1.3e-6, "−1.300 × 10⁻⁶"), (0.0, "0"), (9999.6, "10000"), (None, "—")],
)
def test_significant_digits(value: float | None, text: str) -> None:
    assert numbers.significant(value) == text


@pytest.mark.parametrize(
    ("value", "text"), [(15586.0, "16000"), (-996.0, "−1000"), (0.0996, "0.10"), (42.4, "42")]
)
def test_a_limit_has_two_digits_before_the_point_too(value: float, text: str) -> None:
    assert numbers.significant(value, 2) == text


def test_no_negative_zero() -> None:
    assert numbers.fixed(-0.004, 2) == "0.00"


@pytest.mark.parametrize(
    ("p_value", "text"),
    [(0.41, "p = 0.41"), (9.6e-5, "p = 1 × 10⁻⁴"), (2.4e-9, "p = 2 × 10⁻⁹"), (0.0, "p < 10⁻¹²")],
)
def test_p_values(p_value: float, text: str) -> None:
    assert numbers.p_is(p_value) == text


def test_control_characters_become_visible_and_long_texts_end() -> None:
    assert numbers.shortened("a\x00b\u202ec", 10) == "a�b�c"
    assert numbers.shortened("x" * 50, 10) == "x" * 9 + "…"


@pytest.mark.parametrize(
    ("parameter", "unit", "value", "written", "name"),
    [
        ("bias_x", "m/s²", 9.80665e-3, 1000.0, "µg"),  # a µg by the standard g of 1901
        ("bias_x", "rad/s", 7.292115e-5, 15.04107, "°/h"),  # the earth's rate, 15.041 °/h
        ("scale_x", "1", 1e-6, 1.0, "ppm"),
        ("cross_xy", "1", 1e-3, 206.26481, "arcsec"),
        ("mounting_z", "rad", 1e-3, 206.26481, "arcsec"),
        ("symmetric_xx", "1", 1e-6, 1.0, "ppm"),
        ("r_x", "m", 0.05, 50.0, "mm"),
        # by the definitions of °/h, µg and g
        ("g_xy", "(rad/s)/(m/s²)", 4.94372371e-07, 1.0, "°/h/g"),
        ("c_x", "rad/s²", 1.34670467e-09, 1.0, "°/h/h"),
        ("k2_x", "(m/s²)/(m/s²)²", 1.0197162e-6, 10.0, "µg/g²"),
        ("c_x", "m/s³", 2.72406944e-09, 1.0, "µg/h"),
        ("north", "rad", 4.8481368e-6, 1.0, "arcsec"),
        ("amplitude", "rad/s", 0.01, 0.5729577951308232, "°/s"),
        ("frequency", "Hz", 20.0, 20.0, "Hz"),
        ("unheard_of", "furlong", 0.05, 0.05, "furlong"),
    ],
)
def test_units_of_the_laboratory(
    parameter: str, unit: str, value: float, written: float, name: str
) -> None:
    laboratory = quantity(parameter, unit).laboratory
    assert laboratory.of(value) == pytest.approx(written, rel=1e-6)
    assert laboratory.name == name

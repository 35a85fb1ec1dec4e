"""Gyros that feel products and squares of the rates, and a vibration at one rate of the table."""

from typing import Any

import chain
import numpy as np
import pytest

DEGREE_PER_HOUR, G = np.radians(1 / 3600), 9.80665
OBLIQUE = {"xy": [1, 1, 0], "yz": [0, 1, 1], "zx": [1, 0, 1]}
MARKS = {"xy": "+z", "yz": "+x", "zx": "+y"}


def at_two_rates(oblique: bool = False, **effects: Any) -> dict[str, Any]:
    """The short plan with turns at 30 and at 80 °/s; about oblique axes, too."""
    document = chain.short(effects=effects, seed=8)
    plan = document["campaign"]["plan"][:6]
    ups: dict[str, Any] = {axis: f"+{axis}" for axis in "xyz"} | (OBLIQUE if oblique else {})
    for name, up in ups.items():
        at = {"up": up} | ({"mark": MARKS[name]} if name in MARKS else {})
        for rate in (30, 80):
            for way, degrees in (("forward", 360), ("backward", -360)):
                one = {"id": f"{name}-{way}-{rate}", "do": "turn", "degrees": degrees}
                plan.append(at | one | {"rate_deg_s": rate, "accel_deg_s2": 60})
                plan[-1]["log"] = f"{plan[-1]['id']}.asc"
    document["campaign"]["plan"] = plan
    return document


def found_alone(results: chain.Tables, name: str, stem: str, hidden: dict[str, float]) -> None:
    """The only cause, its sizes within 4 sigma, and the gyros of use."""
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert (cause["cause"], cause["verdict"]) == (name, "found")
    sizes = results["criticism/effects"].set_index(["effect", "parameter"]).loc[name]
    for index, size in hidden.items():
        own = sizes.loc[f"{stem}_{index}"]
        assert own["value"] == pytest.approx(size, abs=4 * own["sigma"])
        assert own["sigma"] < 0.3 * max(abs(each) for each in hidden.values())
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["gyro"].startswith("usable")


@pytest.mark.slow
def test_squares_of_rates_across_the_axis_are_named() -> None:
    """They were a relaxation, an asymmetry, a jump and an angle that is off, all at once."""
    squares = {"matrix_us": [[0, 50, 50], [50, 0, 50], [50, 50, 0]]}
    document = at_two_rates(gyro_cross_axis_squares=squares)
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    hidden = {f"{i}{j}": 50e-6 for i in "xyz" for j in "xyz" if i != j}
    found_alone(results, "gyro_cross_axis_squares", "k", hidden)


@pytest.mark.slow
def test_products_of_rates_show_in_turns_about_oblique_axes() -> None:
    products = {"matrix_us": [[200, 0, 0], [0, 200, 0], [0, 0, 200]]}  # yz, zx, xy
    document = at_two_rates(oblique=True, gyro_rate_products=products)
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    hidden = {"x_yz": 200e-6, "y_zx": 200e-6, "z_xy": 200e-6, "x_xy": 0.0}
    found_alone(results, "gyro_rate_products", "k", hidden)

"""Gyros that feel products and squares of the rates, and a vibration at one rate of the table."""

from typing import Any

import chain
import numpy as np
import pytest

import laboratory

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


@pytest.mark.slow
def test_a_table_that_shakes_at_one_rate_moves_the_biases_of_the_gyros_there() -> None:
    """0.1 g in the turns at 80 °/s, which come between others at 30 °/s."""
    document = at_two_rates()
    plan = document["campaign"]["plan"]
    fast = [m for m in plan if m.get("rate_deg_s") == 80]
    slow = [m for m in plan if m not in fast]
    document["campaign"]["plan"] = slow[:-3] + fast + slow[-3:]
    truth = laboratory.perform(laboratory.specify(document)).truth
    first, last = (truth[m["log"]].time for m in (fast[0], fast[-1]))
    shake = {"vibration_g": 0.1, "from_s": float(first[0]) - 1, "to_s": float(last[-1]) + 1}
    hidden = np.array([300.0, -200.0, 400.0])  # °/h/g²
    shake["k_deg_h_g2"] = hidden.tolist()
    document["effects"] = {"gyro_vibration_rectification": shake}
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    sizes = dict(zip("xyz", hidden * DEGREE_PER_HOUR / G**2, strict=True))
    found_alone(results, "gyro_vibration_rectification", "k", sizes)

"""Two laws of the rate of a gyro, by turns at three rates or at four."""

import chain
import pytest


def turned(rates: list[float], effects: dict[str, object]) -> chain.Tables:
    """Turns about each axis in both senses at these rates, °/s, to the end of extension."""
    document = chain.short(effects=effects, seed=4)
    plan = document["campaign"]["plan"]
    turns = [one for one in plan if one["do"] == "turn"]
    document["campaign"]["plan"] = [one for one in plan if one["do"] != "turn"] + [
        one
        | {"id": f"{one['id']}-{rate}", "log": f"{one['id']}-{rate}.asc"}
        | {"rate_deg_s": rate, "accel_deg_s2": 60}
        for one in turns
        for rate in rates  # so that no jump of the scale factor does what they do
    ]
    return chain.in_memory_of(document, "extension")


LAWS = {
    "gyro_scale_quadratic": {"k2_ppm_per_deg_s": [0, 30, 0]},
    "gyro_scale_cubic": {"k3_ppm_per_deg_s_2": [0, -0.5, 0]},
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rates", "is_open"),
    [([20, 40, 60], True), ([20, 30, 45, 60], False)],
)
def test_as_many_terms_as_rates_confirm_no_form(rates: list[float], is_open: bool) -> None:
    """A scale factor 129 sigma off was "usable": at rate 0 the laws go where nothing was read."""
    results = turned(rates, LAWS)
    both = results["extension/candidate_effects"].query("sensor == 'gyro'")["effect"]
    assert set(both) == set(LAWS)
    candidates = results["extension/candidates"].query("sensor == 'gyro' and method != 'joint'")
    assert set(candidates["open_form"]) == {is_open}
    assert not results["extension/candidates"].query("method == 'joint'")["open_form"].any()

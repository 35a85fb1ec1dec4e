"""Turns about a level axis in the laboratory: clean, one or all too far, a sensor late."""

from typing import Any

import chain
import pytest

FURTHER = 200.0  # arc seconds
SCALE = 1e-3


def document(**effects: Any) -> dict[str, Any]:
    """The demo with two turns more, about y with z up."""
    made = chain.demo(seed=5, effects=effects)
    plan = made["campaign"]["plan"]
    turn = next(m for m in plan if m["do"] == "turn")
    for way, degrees in (("forward", 360), ("backward", -360)):
        name = f"level-{way}"
        own = {"id": name, "log": f"{name}.asc", "position": name}
        plan.append(turn | own | {"up": "+z", "about": "+y", "degrees": degrees})
    return made


@pytest.mark.slow
def test_nothing_is_named_in_clean_turns():
    """A position that was off by 2.5″, by the table's own sigma of its angle."""
    results = chain.in_memory_of(document(), "diagnosis", chain.BESIDE)
    assert results["diagnosis/causes"].empty
    assert set(results["diagnosis/verdict"]["verdict"]) == {"usable"}


@pytest.mark.slow
def test_one_that_goes_too_far_is_named_alone_and_takes_no_result():
    """The accelerometers, which stood 200″ off behind it, had a shift of the mounting and jumps."""
    error = {"turn": "level-forward", "further_arcsec": FURTHER}
    results = chain.in_memory_of(document(turn_angle_error=error), "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert (cause["cause"], cause["manoeuvre"]) == ("turn_angle_error", "level-forward")
    effects = results["criticism/effects"].query("effect == 'turn_angle_error'")
    (delta,) = effects[effects["parameter"] == "delta"].to_dict("records")
    further = FURTHER * 4.84814e-6
    assert abs(delta["value"] - further) < 4 * delta["sigma"] < further / 10
    assert not results["diagnosis/verdict"]["verdict"].eq("not_usable").any()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "lag", "behind"),
    [("accel_latency", 1.0, 1e-3), ("accel_latency", 12.0, 12e-3), ("gyro_latency", 3.0, -3e-3)],
)
def test_a_sensor_that_is_late_against_the_other_is_named_alone(effect, lag, behind):
    """Gravity comes into an axis so much later, or earlier, than the gyros tell: 10 °/s · τ."""
    results = chain.in_memory_of(document(**{effect: {"lag_ms": lag}}), "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "accel_latency"
    effects = results["criticism/effects"].query("effect == 'accel_latency'")
    (tau,) = effects[effects["parameter"] == "tau"].to_dict("records")
    assert abs(tau["value"] - behind) < 4 * tau["sigma"] < 2e-4
    assert not results["diagnosis/verdict"]["verdict"].eq("not_usable").any()


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.0, -SCALE])
def test_a_table_whose_turns_all_go_too_far_is_named_alone_and_the_gyros_are_rid_of_it(speed):
    """The level turns tell; by those about the vertical the scale factors were 1000 ppm off.

    Where the rate is right it looked as if the samples were taken at another one.
    """
    effects = {"table_angle_scale": {"scale_ppm": SCALE * 1e6}}
    if speed:
        effects["table_speed_error"] = {"rate_ppm": speed * 1e6, "ramp_ppm": 0.0}
    made = document(**effects)
    results = chain.in_memory_of(made, "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "table_angle_scale"
    assert abs(cause["size"] - SCALE) < 4 * cause["sigma"] < SCALE / 50
    assert not results["diagnosis/verdict"]["verdict"].eq("not_usable").any()
    result = results["diagnosis/result"].set_index(["sensor", "parameter"]).loc["gyro"]
    for i, axis in enumerate("xyz"):
        own = result.loc[f"scale_{axis}"]
        assert abs(own["value"] - (made["truth"]["gyro"]["matrix"][i][i] - 1)) < 4 * own["sigma"]

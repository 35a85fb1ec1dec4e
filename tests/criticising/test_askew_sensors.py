"""Sensors askew by 2 %, as data sheets of MEMS allow: what is not linear in them has one cause.

It goes with what each sensor senses along its own axis. Taken along the axes of the case it left
squares of the other rates beside an asymmetry of the gyros, and products of forces beside a
quadratic term of the accelerometers, at 10 sigma.
"""

import chain
import hidden_plans
import numpy as np
import pytest

pytestmark = pytest.mark.slow

CASES = {
    "gyro_scale_asymmetry": ("asymmetry_ppm", [300.0, -200.0, 150.0], "a", 1e-6),
    "accel_quadratic": ("k2_micro_g_g2", [1000.0, -600.0, 500.0], "k2", 1e-6 / 9.80665),
}


@pytest.mark.parametrize("name", CASES)
def test_it_is_named_alone_with_its_size(name):
    key, hidden, letter, unit = CASES[name]
    document = hidden_plans.rates(seed=1, effects={name: {key: hidden}})
    document["truth"] = hidden_plans.sensors(np.random.default_rng(1))
    askew = np.random.default_rng(101).normal(0, 0.02, (2, 3, 3)) * (1 - np.eye(3))
    for sensor, cross in zip(("gyro", "accelerometer"), askew, strict=True):
        document["truth"][sensor]["matrix"] = (cross + document["truth"][sensor]["matrix"]).tolist()
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert (cause["cause"], cause["verdict"]) == (name, "found")
    result = results["diagnosis/result"].set_index("parameter")
    for axis, size in zip("xyz", hidden, strict=True):
        own = result.loc[f"{name}.{letter}_{axis}"]
        assert abs(own["value"] - size * unit) < 4 * own["sigma"] < abs(size * unit) / 30

"""A dividing head off its axis: tumbles show it to the accelerometers, and no turn is there."""

from typing import Any

import chain
import hidden_plans
import numpy as np
import pytest
from campaigns import diagnosed
from judge import parameters_of

from inertial.text.units import ARC_SECOND

pytestmark = pytest.mark.slow

SINE, COSINE = 83.0, -70.0  # arcsec


def head(axes: str, seed: int, **effects: Any) -> dict[str, Any]:
    """Tumbles of 30° about these axes, there and back, without a mark."""
    document = hidden_plans.rates(seed=seed, effects=effects)
    del document["temperature"]
    document["campaign"]["plan"] = [
        {"id": f"about-{axis}", "do": "tumble", "about": f"+{axis}", "up": f"+{up}"}
        | {"step_degrees": 30, "steps": 13, "and_back": True, "seconds": 40}
        for axis, up in zip("xyz", "zxy", strict=True)
        if axis in axes
    ]
    document["truth"] = hidden_plans.sensors(np.random.default_rng(seed))
    return document


@pytest.mark.parametrize("axes", ["x", "xyz"])
def test_it_is_named_alone_with_its_size(axes):
    """It was two terms of the accelerometers, k2 and y·z, 14 sigma off."""
    hidden = {"sin_arcsec": SINE, "cos_arcsec": COSINE}
    document = head(axes, 2, table_eccentricity=hidden)
    tables = diagnosed(document)
    (cause,) = tables["causes"].to_dict("records")
    assert (cause["cause"], cause["verdict"]) == ("tumble_eccentricity", "found")
    result = tables["result"][tables["result"]["sensor"] == "accel"].set_index("parameter")
    for name, true in (("a", SINE), ("b", COSINE)):
        own = result.loc[f"tumble_eccentricity.{name}"]
        assert abs(own["value"] / ARC_SECOND - true) < 4 * own["sigma"] / ARC_SECOND < 4
    true = parameters_of(document)["accel"]
    for name in ("bias_y", "bias_z", "scale_y", "scale_z", "cross_yz", "cross_zy"):
        own = result.loc[name]
        assert abs(own["value"] - true[name]) < 4 * own["sigma"]


@pytest.mark.parametrize(
    ("seed", "effects", "named"),
    [
        (1, {}, []),
        (4, {"accel_quadratic": {"k2_micro_g_g2": [0, 300, -200]}}, ["accel_quadratic"]),
        (5, {"accel_cross_products": {"matrix_micro_g_g2": [[0] * 3, [300, 0, 0], [0] * 3]}},
         ["accel_cross_products"]),
    ],
)  # fmt: skip
def test_terms_of_the_sensor_are_not_taken_for_it(seed, effects, named):
    results = chain.in_memory_of(head("x", seed, **effects), "diagnosis", chain.BESIDE)
    assert list(results["diagnosis/causes"]["cause"]) == named

"""A two-axis table whose inner axis leans towards the middle one, with turns about both."""

from itertools import product
from typing import Any

import chain
import hidden_plans
import numpy as np
import pytest

from inertial.tables import ACCEL, CHANNELS
from inertial.text.units import ARC_SECOND

INNER = ("z-up", "z-down", "x-up", "y-down")  # faces on which it turns about z


def document(seed: int, **effects: Any) -> dict[str, Any]:
    """Six faces; turns about the inner axis, z, upright and level, and about the middle axis."""
    made = hidden_plans.rates(seed=seed, effects=effects)
    faces = [rest for rest in made["campaign"]["plan"] if rest["do"] == "rest"]
    turned = [face | {"about": "+z"} for face in faces if face["id"] in INNER]
    turned += [
        {"id": f"{axis}-level{up}", "up": up, "mark": f"+{axis}", "about": f"+{axis}"}
        for axis, up in product("xy", ("+z", "-z"))
    ]
    turns = [
        {name: value for name, value in at.items() if name != "seconds"}
        | {"do": "turn", "id": f"{at['id']}-{rate}-{way}", "position": at["id"]}
        | {"rate_deg_s": rate, "accel_deg_s2": 40, "degrees": degrees}
        for at in turned
        for rate, (way, degrees) in product((20, 40), (("forward", 360), ("backward", -360)))
    ]
    made["campaign"]["plan"] = [*faces, *turns]
    return made


@pytest.mark.slow
def test_nothing_is_named_where_the_axes_are_square():
    results = chain.in_memory_of(document(5), "diagnosis", chain.BESIDE)
    assert results["diagnosis/causes"].empty
    assert set(results["diagnosis/verdict"]["verdict"]) == {"usable"}


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "lean"), [(5, 60.0), (6, -150.0)])
def test_it_is_named_alone_and_both_sensors_are_rid_of_it(seed, lean):
    """The gyros tell no lean from their cross-axis terms, which were 36 and 90 sigma off by it.

    What the accelerometers tell of it holds for the gyros on the same table.
    """
    made = document(seed, table_inner_axis={"lean_arcsec": lean})
    results = chain.in_memory_of(made, "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "table_inner_axis"
    true = lean * ARC_SECOND
    assert abs(cause["size"] - true) < 4 * cause["sigma"] < abs(true) / 10
    assert not results["diagnosis/verdict"]["verdict"].eq("not_usable").any()
    result = results["diagnosis/result"].set_index(["sensor", "parameter"]).loc["gyro"]
    for i, row in enumerate("xyz"):
        for j, column in enumerate("xyz"):
            if i != j:
                own = result.loc[f"cross_{row}{column}"]
                true = made["truth"]["gyro"]["matrix"][i][j]
                assert abs(own["value"] - true) < 4 * own["sigma"] < 5e-5


@pytest.mark.slow
def test_its_result_leaves_the_noise_over_at_rest_and_in_rotations(tmp_path):
    """Of each position by itself, and without it in rotations, 14 and 21 sigma were left."""
    raw = chain.simulate(document(7, table_inner_axis={"lean_arcsec": 45.0}), tmp_path / "raw")
    results = chain.run(raw, tmp_path / "derived", "compensation", chain.BESIDE)
    left = results["compensation/residuals"]
    in_rotation = left["phase"] == "steady"
    for channel in CHANNELS:
        square = (left[f"residual_{channel}"] / left[f"sigma_{channel}"]) ** 2
        assert 0.8 < np.sqrt(square[~in_rotation].mean()) < 1.2
        # The angle of a turn is off by 2″, which is about the white noise of one of these.
        assert channel in ACCEL or 0.8 < np.sqrt(square[in_rotation].mean()) < 1.6

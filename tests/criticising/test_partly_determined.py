"""A plan that leaves scale factors undetermined shows the effects on what it does determine."""

import chain
import pytest

OF_Y = ["cross_xy", "scale_y", "cross_zy"]
JUMP = {"accel_bias_jump": {"size_micro_g": [0, 900, 0], "at_s": 60}}


@pytest.mark.parametrize("effects", [{}, JUMP], ids=["clean", "jump"])
def test_an_effect_is_named_though_not_all_parameters_are_determined(effects):
    """Nothing was simulated of such a sensor, so nothing of it was seen."""
    document = chain.short(effects=effects, seed=6)
    plan = document["campaign"]["plan"]
    document["campaign"]["plan"] = [one for one in plan if not one["id"].startswith("y-")]
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    accelerometers = results["diagnosis/result"].set_index(["sensor", "parameter"]).loc["accel"]
    assert list(accelerometers.index[accelerometers["value"].isna()]) == OF_Y
    assert accelerometers.loc[OF_Y, "reason"].str.contains("+y up", regex=False).all()
    causes, verdict = results["diagnosis/causes"], results["diagnosis/verdict"]
    assert verdict.set_index("sensor").loc["accel", "verdict"] == "not_usable"
    if not effects:
        assert causes.empty
        return
    # y is level in all rests: there a tilt of the case would look like it.
    (cause,) = causes.itertuples()
    assert cause.sensor == "accel" and "accelerometer bias jump" in cause.sentence
    assert (
        "of 12 parameters are not determined"
        in verdict.set_index("sensor").loc["accel", "sentence"]
    )

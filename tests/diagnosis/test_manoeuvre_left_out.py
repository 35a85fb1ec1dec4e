"""A manoeuvre that alone carries a structure without a name: the result is that of all others."""

import chain
import pytest

TURN = "z-forward"


def diagnosed(**changes):
    """The chain to the verdict on two minutes of a campaign, in one turn of which gyros sway."""
    document = chain.short(seed=1801, **changes)
    return chain.in_memory_of(document, "diagnosis", chain.BESIDE), document["truth"]


def swaying(rate, log=f"{TURN}.asc"):
    sway = {"channel": "gyro_z", "frequency_hz": 1 / 6, "amplitude_rad_s": rate}
    return {"faults": [{"oscillate": {"log": log, "line": 1, **sway}}]}


def scale_z_off(rows, truth):
    """The error of the scale factor about z in a table of parameters."""
    (row,) = rows[(rows["sensor"] == "gyro") & (rows["parameter"] == "scale_z")].to_dict("records")
    return row["value"] - (truth["gyro"]["matrix"][2][2] - 1), row["sigma"]


@pytest.mark.slow
def test_a_turn_that_alone_sways_is_left_out_on_condition():
    results, truth = diagnosed(**swaying(3e-4))
    verdict = results["diagnosis/verdict"].set_index("sensor").loc["gyro"]
    assert (verdict["verdict"], verdict["method"]) == ("on_condition", "without_one")
    assert TURN in verdict["condition"]
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert (cause["cure"], cause["manoeuvre"]) == ("left_out", TURN)
    used = results["extension/fit_manoeuvres"]
    assert set(used["manoeuvre"][~used["used"]]) == {TURN}
    result = results["diagnosis/result"]
    assert result.loc[result["sensor"] == "gyro", "value"].notna().all()
    error, sigma = scale_z_off(result, truth)
    assert abs(error) < 3 * sigma < 1e-4
    joint = results["gyroscope/parameters"].query("method == 'joint'")
    assert abs(scale_z_off(joint, truth)[0]) > 2 * sigma


@pytest.mark.parametrize(
    "changes", [{}, pytest.param(swaying(3e-4, "all"), marks=pytest.mark.slow)]
)
def test_without_one_manoeuvre_that_carries_it_none_is_left_out(changes):
    results, _ = diagnosed(**changes)
    assert set(results["extension/candidates"]["method"]).isdisjoint({"without_one"})
    verdict = results["diagnosis/verdict"].set_index("sensor").loc["gyro"]
    assert verdict["verdict"] == ("not_usable" if changes else "usable")

"""Where the structure of the residuals is, and what is not named beside it."""

import chain
import pytest
from hidden import hidden_plans


def criticised(document, fault):
    document["faults"] = [fault]
    return chain.in_memory_of(document, "criticism", chain.BESIDE)


def swaying(channel, log):
    """One accelerometer by 2 cm/s², once in six seconds, in one log of twelve or in all."""
    sway = {"channel": channel, "frequency_hz": 1 / 6, "amplitude_m_s2": 0.02}
    return criticised(chain.short(seed=1801), {"oscillate": {"log": log, "line": 1, **sway}})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("channel", "manoeuvre"),
    [
        ("accel_y", "x-forward"),
        ("accel_z", "y-backward"),
    ],
)
def test_a_structure_of_one_manoeuvre_is_said_to_be_there(channel, manoeuvre):
    results = swaying(channel, f"{manoeuvre}.asc")
    finding = results["criticism/findings"].set_index("cause").loc["unknown_structure"]
    assert finding["sensor"] == "accel"
    assert f"without {manoeuvre} none of these is there" in finding["sentence"]
    (place,) = results["criticism/structure_manoeuvres"].to_dict("records")
    assert (place["finding"], place["manoeuvre"]) == (finding["id"], manoeuvre)


@pytest.mark.slow
def test_a_structure_of_all_manoeuvres_is_in_no_few_of_them():
    results = swaying("accel_x", "all")
    finding = results["criticism/findings"].set_index("cause").loc["unknown_structure"]
    assert "No small group of manoeuvres was found" in finding["sentence"]
    assert results["criticism/structure_manoeuvres"].empty


@pytest.mark.slow
@pytest.mark.parametrize(
    ("channel", "manoeuvre", "size"),
    [
        ("accel_z", "y-backward", 8e-4),
        ("accel_y", "x-forward", 8e-4),
        ("gyro_z", "z-forward", 3e-5),
    ],
)
def test_a_sway_in_one_turn_is_no_pair_of_effects(channel, manoeuvre, size):
    """Too small for the tests of structure, it was a slip and a shift back, by 20″ each."""
    unit = "amplitude_m_s2" if channel.startswith("accel") else "amplitude_rad_s"
    document = chain.short(seed=1801)
    sway = {"log": f"{manoeuvre}.asc", "line": 1, "frequency_hz": 1 / 6, "channel": channel}
    document["faults"] = [{"oscillate": sway | {unit: size}}]
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    (finding,) = results["criticism/findings"].to_dict("records")
    sensor = channel.split("_", maxsplit=1)[0]
    assert finding["sensor"] == sensor
    assert manoeuvre in finding["sentence"] and manoeuvre in finding["action"]
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["accel" if sensor == "gyro" else "gyro"] == "usable"
    # The turns of the gyros are all that show their scale factors; the accelerometers have rests.
    assert (finding["moves"] > 1) == (sensor == "gyro")
    assert verdicts[sensor] == ("not_usable" if sensor == "gyro" else "usable_within_limits")


@pytest.mark.slow
def test_what_one_turn_of_a_gyro_shows_of_no_law_names_no_table():
    """Errors of the table are seen by both sensors; here the gyros alone would show them."""
    sway = {"channel": "gyro_z", "frequency_hz": 1 / 45, "amplitude_rad_s": 3e-4}
    fault = {"oscillate": {"log": "x-forward.asc", "line": 1, **sway}}
    results = criticised(hidden_plans.positions(seed=1801), fault)
    findings = results["criticism/findings"].set_index("cause")
    assert set(findings["verdict"]) == {"unknown_structure"}
    assert set(findings["sensor"]) == {"gyro"}
    assert "With x-forward left out" in findings.loc["unknown_structure", "sentence"]


@pytest.mark.slow
def test_a_knock_near_the_end_is_a_jump_of_both_sensors():
    """Few manoeuvres are after it, and one effect of each sensor is no structure of one of them."""
    jumps = {
        "gyro_bias_jump": {"size_deg_h": [30, 0, 0], "at_s": 790},
        "accel_bias_jump": {"size_micro_g": [300, 0, 0], "at_s": 790},
    }
    results = chain.in_memory_of(chain.short(seed=1801, effects=jumps), "criticism", chain.BESIDE)
    findings = results["criticism/findings"].set_index("cause")["verdict"]
    assert findings.to_dict() == dict.fromkeys(jumps, "found")

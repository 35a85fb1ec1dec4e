"""What criticism has named for a mount, and what it warns of."""

from typing import Any

from stages.extension.named_effects import named_of

Row = dict[str, Any]


def finding(cause: str, verdict: str | None, sensor: str = "gyro", mount: str = "") -> Row:
    own = {"id": f"{cause} of {mount}", "mount": mount, "cause": cause, "sensor": sensor}
    return own | {"verdict": verdict}


def members(cause: str, *others: str, mount: str = "") -> list[Row]:
    return [{"finding": f"{cause} of {mount}", "effect": one} for one in (cause, *others)]


def test_effects_are_taken_by_mount_with_the_value_that_was_scanned():
    findings = [
        finding("gyro_bias_jump", "found", mount="lying"),
        finding("accel_quadratic", "one_of_class", "accel"),
        finding("oscillation", "found"),
    ]
    effects = [
        {"finding": "gyro_bias_jump of lying", "effect": "gyro_bias_jump"}
        | {"parameter": "t0", "value": 812.5},
        {"finding": "oscillation of ", "effect": "oscillation"}
        | {"parameter": "frequency", "value": 20.0},
    ]
    (jump,) = named_of(findings, effects, [], "lying").in_blocks
    assert (jump.name, jump.at) == ("gyro_bias_jump", 812.5)
    classes = members("accel_quadratic", "accel_scale_asymmetry") + members("oscillation")
    other = named_of(findings, effects, classes, "")
    assert [effect.name for effect in other.in_blocks] == ["accel_quadratic"]
    assert other.classes == {"accel_quadratic": ["accel_quadratic", "accel_scale_asymmetry"]}
    assert other.in_spectrum == {"oscillation": {"frequency": 20.0}}


def test_what_is_not_understood_is_an_alarm_of_its_sensor_and_a_random_walk_is_none():
    findings = [
        finding("gyro_drift", "unknown_structure"),
        finding("gyro_random_walk", "unknown_structure"),
        finding("accel_random_walk", "unknown_structure", "accel"),
        finding("accel_quadratic", "found", "accel"),
        finding("unexplained/gyro", None) | {"cause": "unexplained"},
    ]
    named = named_of(findings, [], [], "")
    assert [one.cause for one in named.alarms["gyro"]] == ["gyro_drift", "unexplained"]
    assert set(named.alarms) == {"gyro"}
    assert [effect.name for effect in named.in_blocks] == ["accel_quadratic"]

"""What criticism has named for a mount, and what it warns of."""

from typing import Any

import pytest

from stages.extension.named_effects import named_of

Row = dict[str, Any]


def finding(cause: str, verdict: str | None, sensor: str = "gyro", mount: str = "") -> Row:
    own = {"id": f"{cause} of {mount}", "mount": mount, "cause": cause, "sensor": sensor}
    return own | {"verdict": verdict, "statistic": None, "degrees": None, "threshold": None}


def members(cause: str, *others: str, mount: str = "") -> list[Row]:
    shared = {"finding": f"{cause} of {mount}", "mount": mount}
    return [
        shared | {"effect": one, "rank": rank, "probability": 0.6 if rank == 1 else 0.4}
        for rank, one in enumerate((cause, *others), 1)
    ]


def test_effects_are_taken_by_mount_with_the_value_that_was_scanned():
    findings = [
        finding("gyro_bias_jump", "found", mount="lying"),
        finding("accel_quadratic", "one_of_class", "accel"),
        finding("oscillation", "found"),
        finding("gyro_drift", "unknown_structure"),
    ]
    effects = [
        {"finding": "gyro_bias_jump of lying", "effect": "gyro_bias_jump"}
        | {"parameter": "t0", "value": 812.5},
        {"finding": "oscillation of ", "effect": "oscillation"}
        | {"parameter": "frequency", "value": 20.0},
    ]
    (alone,) = named_of(findings, effects, [], [], "lying").classes
    (jump,) = alone.members
    assert (jump.effect.name, jump.effect.at) == ("gyro_bias_jump", 812.5)
    assert jump.probability is None
    classes = members("accel_quadratic", "accel_scale_asymmetry") + members("oscillation")
    other = named_of(findings, effects, classes, [], "")
    (own,) = other.classes
    assert own.finding == "accel_quadratic of "
    assert [(one.effect.name, one.probability) for one in own.members] == [
        ("accel_quadratic", 0.6),
        ("accel_scale_asymmetry", 0.4),
    ]
    assert other.in_spectrum == {"oscillation": {"frequency": 20.0}}


def test_an_effect_that_was_named_by_its_size_has_that_allowed_for():
    named = finding("accel_quadratic", "found", "accel")
    near = named | {"statistic": 21.0, "degrees": 3, "threshold": 20.0}
    far = named | {"statistic": 200.0, "degrees": 3, "threshold": 20.0}
    factors = []
    for row in (near, far, named):
        (own,) = named_of([row], [], [], [], "").classes
        factors.append(own.selected.factor)
    assert 0.7 < factors[0] < 0.9 and factors[1:] == pytest.approx([1.0, 1.0], abs=1e-9)

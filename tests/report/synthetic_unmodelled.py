"""The synthetic campaign with other findings of criticism: a class, a structure, a walk."""

from __future__ import annotations

from typing import Any

import pandas as pd

from inertial import tables
from tests.report import synthetic, synthetic_causes
from tests.report.synthetic_diagnosis import diagnosed
from tests.report.synthetic_values import rows_as


def without_effects() -> dict[str, Any]:
    """The campaign where nothing was named and nothing extended."""
    made = synthetic.brief()
    made["scores"]["named"] = False
    made["scores"]["finding"] = None
    for name in ("gain", "extended_parameters", "extended_fit", "worth", "verdict"):
        made[name] = made[name].iloc[:0]
    made |= synthetic_causes.cause_tables([])
    return made | diagnosed(made)


def with_findings(*rows: dict[str, Any]) -> dict[str, Any]:
    """The same with these findings of criticism alone."""
    made = without_effects()
    made["effects"]["finding"] = None
    made |= synthetic_causes.cause_tables(list(rows))
    return made | diagnosed(made)


def with_parameters(made: dict[str, Any], finding: str, *numbers: tuple[Any, ...]) -> None:
    """Name, value, sigma and unit of parameters of a finding."""
    effect = finding.rpartition("/")[2]
    own = [
        {"id": f"{finding}/{name}", "mount": "", "finding": finding, "effect": effect}
        | {"parameter": name, "value": value, "sigma": sigma, "unit": unit, "meaning": name}
        for name, value, sigma, unit in numbers
    ]
    others = made["effects"][made["effects"]["effect"] != effect]
    made["effects"] = pd.concat([others, rows_as(tables.EFFECTS, own)], ignore_index=True)


def of_a_class() -> dict[str, Any]:
    """Of the accelerometers an effect that another one cannot be told from."""
    made = with_findings(
        synthetic_causes.NAMED
        | {
            "id": "criticism/accel_quadratic",
            "cause": "accel_quadratic",
            "sensor": "accel",
            "consequence": "The model without it is not the whole truth.",
            "action": "It is added to the model.",
            "sentence": "The data ask for accelerometer quadratic term, or for lever arm.",
            "verdict": "one_of_class",
            "members": ["accel_quadratic", "lever_arm"],
            "snr": 12.0,
            "split_manoeuvre": "rest also with two axes at 45° to the vertical",
            "split_snr": 24.0,
        }
    )
    number = ("k2_x", 2.0e-05, 4e-07, "(m/s²)/(m/s²)²")
    with_parameters(made, "criticism/accel_quadratic", number)
    return made


def of_no_name(*firing: str) -> dict[str, Any]:
    """A structure that no effect explains: with a jump the data are no more than consistent."""
    shared = synthetic_causes.NAMED | {"p_value": 1e-9, "verdict": "unknown_structure"}
    made = with_findings(
        {
            "id": "criticism/gyro_random_walk",
            "mount": "",
            "cause": "gyro_random_walk",
            "sensor": "gyro",
            "count": 1,
            "size": 4.3e-7,
            "unit": "rad/s/√s",
            "severity": 1,
            "consequence": "The sigmas of all parameters allow for it.",
            "action": "A shorter campaign lessens what it does.",
            "sentence": "The biases of the gyros change as by a random walk of 5.3 ± 0.3 °/h/√h.",
            "verdict": "unknown_structure",
            "members": ["gyro_random_walk"],
        },
        shared
        | {
            "id": "criticism/gyro_bias_jump",
            "cause": "gyro_bias_jump",
            "consequence": "The joint fit holds it as a random walk.",
            "action": "Look at the residuals against time.",
            "sentence": "The data are consistent with gyro bias jump, and no more is said.",
            "members": ["gyro_bias_jump"],
            "snr": 4.9,
        },
        shared
        | {
            "id": "criticism/unknown_structure/gyro",
            "cause": "unknown_structure",
            "consequence": "The joint result stands as it is.",
            "action": "Look at the picture of what is left.",
            "sentence": "What the model leaves of the gyros is not noise.",
            "members": ["gyro_bias_jump"],
            "snr": 8.3,
        },
    )
    with_parameters(made, "criticism/gyro_random_walk", ("K", 4.3e-07, 2.6e-08, "rad/s/√s"))
    jump = (("b_x", 9.7e-06, 1e-06, "rad/s"), ("t0", 316.4, 5.4, "s"))
    with_parameters(made, "criticism/gyro_bias_jump", *jump)
    tests, points = synthetic_causes.structures(*firing), synthetic_causes.points(*firing)
    return made | {
        "structures": rows_as(tables.STRUCTURES, tests),
        "structure_points": rows_as(tables.STRUCTURE_POINTS, points),
    }


def unexplained() -> dict[str, Any]:
    """Residuals that are larger than noise, and nothing that explains it."""
    return with_findings(
        synthetic_causes.NAMED
        | {
            "id": "criticism/unexplained/accel",
            "cause": "unexplained",
            "sensor": "accel",
            "p_value": 1e-30,
            "consequence": "The joint fit holds it as a scatter between manoeuvres.",
            "action": "Look at the residuals of each manoeuvre.",
            "sentence": "The residuals of the accelerometers are 3.1 times what noise would leave.",
        }
    )

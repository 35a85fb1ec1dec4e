"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "criticism_findings": From("criticism", tables.EFFECT_FINDINGS, "findings"),
        "accelerometer_parameters": From("accelerometer", tables.PARAMETERS),
        "accelerometer_covariance": From("accelerometer", tables.COVARIANCE),
        "gyroscope_parameters": From("gyroscope", tables.PARAMETERS),
        "gyroscope_covariance": From("gyroscope", tables.COVARIANCE),
        "extension_parameters": From("extension", tables.PARAMETERS),
        "extension_covariance": From("extension", tables.COVARIANCE),
        "candidates": From("extension", tables.CANDIDATES),
        "candidate_effects": From("extension", tables.CANDIDATE_EFFECTS),
    },
    writes={
        "causes": tables.CAUSES,
        "members": tables.CAUSE_MEMBERS,
        "consequences": tables.CONSEQUENCES,
        "result": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "verdict": tables.VERDICTS,
    },
)

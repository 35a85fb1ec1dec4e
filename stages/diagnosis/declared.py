"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "extension_result": From("extension", tables.PARAMETERS, "result"),
        "accelerometer_covariance": From("accelerometer", tables.COVARIANCE),
        "gyroscope_covariance": From("gyroscope", tables.COVARIANCE),
        "extension_covariance": From("extension", tables.COVARIANCE),
        "extension_parameters": From("extension", tables.PARAMETERS),
        "decision": From("extension", tables.DECISION),
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

"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From, of_stage, of_stages

DECLARED = Declared(
    reads={
        **of_stage("segment", tables.BLOCKS, tables.MANOEUVRES, tables.PERFORMED),
        "levels": From("noise", tables.LEVELS),
        "known": From("plan", tables.KNOWN),
        "accelerometer_parameters": From("accelerometer", tables.PARAMETERS),
        **of_stages(["gyroscope"], tables.PARAMETERS, tables.FIT),
    },
    writes={
        "differences": tables.DIFFERENCES,
    },
)

"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "blocks": From("segment", tables.BLOCKS),
        "manoeuvres": From("segment", tables.MANOEUVRES),
        "performed": From("segment", tables.PERFORMED),
        "levels": From("noise", tables.LEVELS),
        "known": From("plan", tables.KNOWN),
        "accelerometer_parameters": From("accelerometer", tables.PARAMETERS),
        "gyroscope_parameters": From("gyroscope", tables.PARAMETERS),
        "gyroscope_fit": From("gyroscope", tables.FIT),
    },
    writes={
        "differences": tables.DIFFERENCES,
    },
)

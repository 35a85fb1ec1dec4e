"""What the stage reads and writes, and the folder of the archive."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "campaign": From("plan", tables.CAMPAIGN),
        "inputs": From("plan", tables.INPUTS),
        **{
            f"{stage}_{table.name}": From(stage, table)
            for stage in ("accelerometer", "gyroscope", "extension")
            for table in (tables.PARAMETERS, tables.COVARIANCE)
        },
        "verdict": From("diagnosis", tables.VERDICTS, "verdict"),
    },
    writes={"archived": tables.ARCHIVED, "earlier": tables.EARLIER},
    files=("archive",),
)

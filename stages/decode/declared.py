"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From, by_name

DECLARED = Declared(
    reads={
        "logs": From("plan", tables.LOGS),
    },
    writes={
        **by_name(tables.SAMPLES, tables.REFUSED, tables.MEAN_SIGMAS, tables.ACCOUNTS),
        **by_name(tables.CLOCKS, tables.IMU_TYPES),
    },
    streams=("logs",),
    files=("raw",),
)

"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "logs": From("plan", tables.LOGS),
    },
    writes={
        "samples": tables.SAMPLES,
        "refused": tables.REFUSED,
        "mean_sigmas": tables.MEAN_SIGMAS,
        "accounts": tables.ACCOUNTS,
        "clocks": tables.CLOCKS,
        "imu_types": tables.IMU_TYPES,
    },
    streams=("logs",),
    files=("raw",),
)

"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "clocks": From("decode", tables.CLOCKS),
        "imu_types": From("decode", tables.IMU_TYPES),
        "campaign": From("plan", tables.CAMPAIGN),
        "known": From("plan", tables.KNOWN),
        "gravity_repairs": From("plan", tables.REPAIRS),
        "ranges": From("plan", tables.RANGES),
        "count_sizes": From("plan", tables.COUNT_SIZES),
    },
    writes={
        "findings": tables.FINDINGS,
        "masks": tables.MASKS,
        "gaps": tables.GAPS,
        "channel_statistics": tables.CHANNEL_STATISTICS,
        "close_ups": tables.CLOSE_UPS,
    },
    streams=("samples",),
)

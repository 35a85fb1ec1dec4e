"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "campaign": From("plan", tables.CAMPAIGN),
        "known": From("plan", tables.KNOWN),
        "gravity_repairs": From("plan", tables.REPAIRS),
        "accepted": From("plan", tables.ACCEPTED),
        "ranges": From("plan", tables.RANGES),
        "count_sizes": From("plan", tables.COUNT_SIZES),
        "manoeuvres": From("plan", tables.MANOEUVRES),
        "clocks": From("decode", tables.CLOCKS),
        "imu_types": From("decode", tables.IMU_TYPES),
        "gaps": From("quality", tables.GAPS),
        "masks": From("quality", tables.MASKS),
        "quality_findings": From("quality", tables.FINDINGS),
        "channel_statistics": From("quality", tables.CHANNEL_STATISTICS),
    },
    writes={
        "manoeuvres": tables.MANOEUVRES,
        "repairs": tables.REPAIRS,
        "channel_repairs": tables.CHANNEL_REPAIRS,
        "segments": tables.SEGMENTS,
        "performed": tables.PERFORMED,
        "blocks": tables.BLOCKS,
        "masks": tables.MASKS,
        "traces": tables.TRACES,
        "findings": tables.FINDINGS,
        "close_ups": tables.CLOSE_UPS,
    },
    streams=("samples",),
)

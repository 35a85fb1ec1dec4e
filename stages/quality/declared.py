"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From, of_stage

DECLARED = Declared(
    reads={
        **of_stage("decode", tables.SAMPLES, tables.CLOCKS, tables.IMU_TYPES),
        **of_stage("plan", tables.CAMPAIGN, tables.KNOWN, tables.RANGES, tables.COUNT_SIZES),
        "gravity_repairs": From("plan", tables.REPAIRS),
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

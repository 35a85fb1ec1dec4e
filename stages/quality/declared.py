"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From, by_name, of_stage

DECLARED = Declared(
    reads={
        **of_stage("decode", tables.SAMPLES, tables.CLOCKS, tables.IMU_TYPES),
        **of_stage("plan", tables.CAMPAIGN, tables.KNOWN, tables.RANGES, tables.COUNT_SIZES),
        "gravity_repairs": From("plan", tables.REPAIRS),
    },
    writes={
        **by_name(tables.FINDINGS, tables.MASKS, tables.GAPS, tables.CHANNEL_STATISTICS),
        "close_ups": tables.CLOSE_UPS,
    },
    streams=("samples",),
)

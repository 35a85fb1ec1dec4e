"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From, by_name, of_stage

DECLARED = Declared(
    reads={
        **of_stage("decode", tables.SAMPLES, tables.CLOCKS, tables.IMU_TYPES),
        **of_stage("plan", tables.CAMPAIGN, tables.KNOWN, tables.ACCEPTED, tables.RANGES),
        **of_stage("plan", tables.COUNT_SIZES, tables.MANOEUVRES),
        "gravity_repairs": From("plan", tables.REPAIRS),
        **of_stage("quality", tables.GAPS, tables.MASKS, tables.CHANNEL_STATISTICS),
        "quality_findings": From("quality", tables.FINDINGS),
    },
    writes={
        **by_name(tables.MANOEUVRES, tables.REPAIRS, tables.CHANNEL_REPAIRS, tables.SEGMENTS),
        **by_name(tables.PERFORMED, tables.BLOCKS, tables.MASKS, tables.TRACES, tables.FINDINGS),
        "close_ups": tables.CLOSE_UPS,
    },
    streams=("samples",),
)

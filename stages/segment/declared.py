"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From, of_stage

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

"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import RECORDED, Declared, From, of_stage

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "purposes": From("plan", tables.PURPOSES),
        **of_stage("segment", tables.CHANNEL_REPAIRS, tables.MASKS, tables.SEGMENTS),
        **RECORDED,
        "result": From("diagnosis", tables.PARAMETERS, "result"),
    },
    writes={
        "alignments": tables.ALIGNMENTS,
        "attitude_errors": tables.ATTITUDE_ERRORS,
        "modulation_gains": tables.MODULATION_GAINS,
    },
    streams=("samples",),
)

"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import RECORDED, Declared, From, by_name, of_stage

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "purposes": From("plan", tables.PURPOSES),
        **of_stage("segment", tables.CHANNEL_REPAIRS, tables.MASKS, tables.SEGMENTS),
        **RECORDED,
        "result": From("diagnosis", tables.PARAMETERS, "result"),
    },
    writes=by_name(tables.ALIGNMENTS, tables.ATTITUDE_ERRORS, tables.MODULATION_GAINS),
    streams=("samples",),
)

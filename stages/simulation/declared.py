"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import ESTIMATED, RECORDED, Declared, From, by_name, of_stage

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        **of_stage("segment", tables.CHANNEL_REPAIRS, tables.SEGMENTS),
        **RECORDED,
        **ESTIMATED,
    },
    writes=by_name(tables.SIMULATED, tables.FIDELITY),
    streams=("samples",),
)

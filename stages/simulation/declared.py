"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import ESTIMATED, RECORDED, Declared, From, of_stage

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        **of_stage("segment", tables.CHANNEL_REPAIRS, tables.SEGMENTS),
        **RECORDED,
        **ESTIMATED,
    },
    writes={
        "simulated": tables.SIMULATED,
        "fidelity": tables.FIDELITY,
    },
    streams=("samples",),
)

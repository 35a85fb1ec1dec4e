"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.campaign_inputs import ESTIMATED, RECORDED
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        **RECORDED,
        "segments": From("segment", tables.SEGMENTS),
        **ESTIMATED,
    },
    writes={
        "simulated": tables.SIMULATED,
        "fidelity": tables.FIDELITY,
    },
    streams=("samples",),
)

"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import RECORDED, Declared, From, by_name, of_stage, of_stages

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        **of_stage("segment", tables.CHANNEL_REPAIRS, tables.MASKS, tables.SEGMENTS),
        **RECORDED,
        "spectra": From("noise", tables.SPECTRA),
        **of_stages(["gyroscope"], tables.PARAMETERS, tables.FIT),
    },
    writes={
        **by_name(tables.EPOCHS, tables.SPREADS, tables.WINDOWS),
        "growing": tables.WINDOWS,
        "middles": tables.WINDOWS,
        **by_name(tables.TIME_ANGLE, tables.MOTIONS, tables.ENCODER, tables.BANDWIDTHS),
        "not_studied": tables.NOT_STUDIED,
    },
    streams=("samples",),
)

"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import RECORDED, Declared, From, of_stage, of_stages

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        **of_stage("segment", tables.CHANNEL_REPAIRS, tables.MASKS, tables.SEGMENTS),
        **RECORDED,
        "spectra": From("noise", tables.SPECTRA),
        **of_stages(["gyroscope"], tables.PARAMETERS, tables.FIT),
    },
    writes={
        "epochs": tables.EPOCHS,
        "spreads": tables.SPREADS,
        "windows": tables.WINDOWS,
        "growing": tables.WINDOWS,
        "middles": tables.WINDOWS,
        "time_angle": tables.TIME_ANGLE,
        "motions": tables.MOTIONS,
        "encoder": tables.ENCODER,
        "bandwidths": tables.BANDWIDTHS,
        "not_studied": tables.NOT_STUDIED,
    },
    streams=("samples",),
)

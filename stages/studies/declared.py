"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.campaign_inputs import RECORDED
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "masks": From("segment", tables.MASKS),
        **RECORDED,
        "segments": From("segment", tables.SEGMENTS),
        "spectra": From("noise", tables.SPECTRA),
        "gyroscope_parameters": From("gyroscope", tables.PARAMETERS),
        "gyroscope_fit": From("gyroscope", tables.FIT),
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

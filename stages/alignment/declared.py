"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.campaign_inputs import RECORDED
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "purposes": From("plan", tables.PURPOSES),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "masks": From("segment", tables.MASKS),
        "segments": From("segment", tables.SEGMENTS),
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

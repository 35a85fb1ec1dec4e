"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "purposes": From("plan", tables.PURPOSES),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "masks": From("quality", tables.MASKS),
        "segments": From("segment", tables.SEGMENTS),
        "blocks": From("segment", tables.BLOCKS),
        "manoeuvres": From("segment", tables.MANOEUVRES),
        "performed": From("segment", tables.PERFORMED),
        "levels": From("noise", tables.LEVELS),
        "known": From("plan", tables.KNOWN),
        "clocks": From("decode", tables.CLOCKS),
        "result": From("diagnosis", tables.PARAMETERS, "result"),
    },
    writes={
        "alignments": tables.ALIGNMENTS,
        "attitude_errors": tables.ATTITUDE_ERRORS,
        "modulation_gains": tables.MODULATION_GAINS,
    },
    streams=("samples",),
)

"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "campaign": From("plan", tables.CAMPAIGN),
        "samples": From("decode", tables.SAMPLES),
        "mean_sigmas": From("decode", tables.MEAN_SIGMAS),
        "blocks": From("segment", tables.BLOCKS),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "segments": From("segment", tables.SEGMENTS),
        "manoeuvres": From("segment", tables.MANOEUVRES),
        "clocks": From("decode", tables.CLOCKS),
        "gaps": From("quality", tables.GAPS),
        "masks": From("segment", tables.MASKS),
        "sensors": From("plan", tables.SENSORS),
        "ranges": From("plan", tables.RANGES),
    },
    writes={
        "noise": tables.NOISE,
        "levels": tables.LEVELS,
        "allan": tables.ALLAN,
        "spectra": tables.SPECTRA,
        "terms": tables.NOISE_TERMS,
        "findings": tables.FINDINGS,
    },
    streams=("samples",),
)

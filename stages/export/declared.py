"""What the stage reads, and the files that it writes for other programs."""

from inertial import tables
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "campaign": From("plan", tables.CAMPAIGN),
        "known": From("plan", tables.KNOWN),
        "certificate": From("plan", tables.CERTIFICATE),
        "standards": From("plan", tables.STANDARDS),
        "inputs": From("plan", tables.INPUTS),
        "manoeuvres": From("segment", tables.MANOEUVRES),
        "clocks": From("decode", tables.CLOCKS),
        "samples": From("decode", tables.SAMPLES),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "masks": From("segment", tables.MASKS),
        "blocks": From("segment", tables.BLOCKS),
        "noise": From("noise", tables.NOISE),
        "terms": From("noise", tables.NOISE_TERMS, "terms"),
        **{
            f"{stage}_{table.name}": From(stage, table)
            for stage in ("accelerometer", "gyroscope", "extension")
            for table in (tables.FIT, tables.FIT_MANOEUVRES)
        },
        "result": From("diagnosis", tables.PARAMETERS, "result"),
        "covariance": From("diagnosis", tables.COVARIANCE),
        "verdict": From("diagnosis", tables.VERDICTS, "verdict"),
        "conformity": From("diagnosis", tables.CONFORMITY),
    },
    streams=("samples",),
    documents=(
        "calibration.json",
        "calibration.yaml",
        "calibration.h",
        "dcc.xml",
        "kalibr.yaml",
        "ros.yaml",
        "px4.params",
        "ardupilot.param",
    ),
)

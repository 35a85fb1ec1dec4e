"""What the stage reads, and the files that it writes for other programs."""

from inertial import tables
from inertial.tables.declared import ESTIMATING, Declared, From, of_stage, of_stages

DECLARED = Declared(
    reads={
        **of_stage("plan", tables.CAMPAIGN, tables.KNOWN, tables.CERTIFICATE, tables.STANDARDS),
        **of_stage("plan", tables.INPUTS),
        **of_stage("segment", tables.MANOEUVRES, tables.CHANNEL_REPAIRS, tables.MASKS),
        **of_stage("segment", tables.BLOCKS),
        **of_stage("decode", tables.CLOCKS, tables.SAMPLES),
        "noise": From("noise", tables.NOISE),
        "terms": From("noise", tables.NOISE_TERMS, "terms"),
        **of_stages((*ESTIMATING, "extension"), tables.FIT, tables.FIT_MANOEUVRES),
        "result": From("diagnosis", tables.PARAMETERS, "result"),
        **of_stage("diagnosis", tables.COVARIANCE, tables.CONFORMITY),
        "verdict": From("diagnosis", tables.VERDICTS, "verdict"),
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

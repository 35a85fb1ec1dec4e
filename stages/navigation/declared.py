"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import ESTIMATING, RECORDED, Declared, From, of_stage, of_stages

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "compensated": From("compensation", tables.COMPENSATED),
        **of_stage("plan", tables.CAMPAIGN, tables.PUBLISHED),
        **of_stage("segment", tables.CHANNEL_REPAIRS, tables.SEGMENTS),
        **RECORDED,
        "result": From("diagnosis", tables.PARAMETERS, "result"),
        "covariance": From("diagnosis", tables.COVARIANCE),
        **of_stages(ESTIMATING, tables.FIT),
    },
    writes={
        "navigation_errors": tables.NAVIGATION_ERRORS,
        "navigation_courses": tables.NAVIGATION_COURSES,
        "navigation_shares": tables.NAVIGATION_SHARES,
    },
    streams=("samples", "compensated"),
)

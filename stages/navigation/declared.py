"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.declared import (
    ESTIMATING,
    RECORDED,
    Declared,
    From,
    by_name,
    of_stage,
    of_stages,
)

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
    writes=by_name(tables.NAVIGATION_ERRORS, tables.NAVIGATION_COURSES, tables.NAVIGATION_SHARES),
    streams=("samples", "compensated"),
)

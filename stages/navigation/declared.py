"""What the stage reads and writes."""

from inertial import tables
from inertial.tables.campaign_inputs import RECORDED
from inertial.tables.declared import Declared, From

DECLARED = Declared(
    reads={
        "samples": From("decode", tables.SAMPLES),
        "compensated": From("compensation", tables.COMPENSATED),
        "campaign": From("plan", tables.CAMPAIGN),
        "channel_repairs": From("segment", tables.CHANNEL_REPAIRS),
        "segments": From("segment", tables.SEGMENTS),
        **RECORDED,
        "published": From("plan", tables.PUBLISHED),
        "result": From("diagnosis", tables.PARAMETERS, "result"),
        "covariance": From("diagnosis", tables.COVARIANCE),
        "accelerometer_fit": From("accelerometer", tables.FIT),
        "gyroscope_fit": From("gyroscope", tables.FIT),
    },
    writes={
        "navigation_errors": tables.NAVIGATION_ERRORS,
        "navigation_courses": tables.NAVIGATION_COURSES,
        "navigation_shares": tables.NAVIGATION_SHARES,
    },
    streams=("samples", "compensated"),
)

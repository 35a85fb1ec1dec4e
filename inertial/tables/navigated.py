"""Free inertial navigation with the readings before and after calibration."""

from inertial.tables.shared import MOUNT
from inertial.tables.table import DOUBLE, SENTENCE, TEXT, Column, Table

MOTION = Column("motion", TEXT, "", "rest, or turn: a whole one, from rest to rest")
SECONDS = Column("seconds", DOUBLE, "s", "of free inertial navigation, from the end of alignment")
QUANTITY = Column(
    "quantity",
    TEXT,
    "",
    "attitude: what it drifts by since the start; velocity; position",
)
UNIT = Column("unit", TEXT, "", "unit of the errors, SI")
BEFORE = (
    Column("nominal", DOUBLE, "as unit", "with the readings as decoded", nullable=True),
    Column(
        "published",
        DOUBLE,
        "as unit",
        "with M and bias as published; none where they are not",
        nullable=True,
    ),
    Column("calibrated", DOUBLE, "as unit", "with the result that counts", nullable=True),
)
PREDICTED = Column(
    "predicted",
    DOUBLE,
    "as unit",
    "rms of the error with the result, by its covariance and the noise",
    nullable=True,
)

NAVIGATION_ERRORS = Table(
    "navigation_errors",
    1,
    (
        Column("id", TEXT, "", "stable identifier: navigation/quantity/manoeuvre/seconds"),
        MOUNT,
        Column("manoeuvre", TEXT, "", "as in manoeuvres, with the rest of a turn in brackets"),
        MOTION,
        SECONDS,
        QUANTITY,
        UNIT,
        *BEFORE,
        PREDICTED,
        Column(
            "by_parameters",
            DOUBLE,
            "as unit",
            "the same by the covariance of the result alone",
            nullable=True,
        ),
        Column(
            "normalised",
            DOUBLE,
            "1",
            "squared error with the result by its predicted covariance, over the 3 axes",
            nullable=True,
        ),
        Column(
            "azimuth",
            TEXT,
            "",
            "plan: known; gyros: aligned by the earth's rate; unknown: the level earth rate stays"
            " in the rates",
        ),
        Column("reason", SENTENCE, "", "why nothing was navigated for so long, or predicted"),
    ),
)
NAVIGATION_COURSES = Table(
    "navigation_courses",
    1,
    (
        MOUNT,
        Column("manoeuvre", TEXT, "", "the one that was navigated longest, as in errors"),
        SECONDS,
        QUANTITY,
        UNIT,
        *BEFORE,
        PREDICTED,
    ),
)
NAVIGATION_SHARES = Table(
    "navigation_shares",
    1,
    (
        MOUNT,
        MOTION,
        Column("seconds", DOUBLE, "s", "as in errors; none: each turn its own", nullable=True),
        QUANTITY,
        Column(
            "family",
            TEXT,
            "",
            "accel or gyro with bias, scale, cross or the name of an effect; noise; table;"
            " earth_rate",
        ),
        Column("source", TEXT, "", "parameter, or white_noise, drift, azimuth, angle"),
        Column(
            "share",
            DOUBLE,
            "1",
            "of the predicted variance, mean over the manoeuvres; what two parameters share counts"
            " by half for each, so one may be negative, and all add up to 1",
        ),
    ),
)

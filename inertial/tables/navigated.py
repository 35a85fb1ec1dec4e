"""Free inertial navigation with the readings before and after calibration; alignment at rest."""

from inertial.tables.table import DOUBLE, MOUNT, SENTENCE, TEXT, TRUTH, Column, Table, optional

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
    optional("nominal", DOUBLE, "as unit", "with the readings as decoded"),
    optional(
        "published", DOUBLE, "as unit", "with M and bias as published; none where they are not"
    ),
    optional("calibrated", DOUBLE, "as unit", "with the result that counts"),
)
PREDICTED = optional(
    "predicted",
    DOUBLE,
    "as unit",
    "rms of the error with the result, by its covariance and the noise",
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
        optional(
            "by_parameters", DOUBLE, "as unit", "the same by the covariance of the result alone"
        ),
        optional(
            "normalised",
            DOUBLE,
            "1",
            "squared error with the result by its predicted covariance, over the 3 axes",
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
        optional("seconds", DOUBLE, "s", "as in errors; none: each turn its own"),
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


# ---- Alignment at rest, and the error of the attitude with and without rotation

_READINGS = Column("readings", TEXT, "", "recorded; or compensated, by the result that counts")
_ALIGNMENT = Column("alignment", TEXT, "", "manoeuvre by which the IMU was aligned")
_LEVEL = "east, north, up"

ALIGNMENTS = Table(
    "alignments",
    1,
    (
        MOUNT,
        _ALIGNMENT,
        _READINGS,
        Column(
            "method", TEXT, "", "static: by means at rest; rotation: by the turn that follows it"
        ),
        Column(
            "quantity",
            TEXT,
            "",
            "tilt_x, tilt_y, tilt_z: rotation about a body axis from the planned up to the one"
            " found, static of the case, by rotation of the axis of the turn; azimuth of"
            " `direction`; level_rate: horizontal part of the earth's rate",
        ),
        optional("direction", TEXT, "", "body direction of an azimuth: mark, x, y, z"),
        Column("value", DOUBLE, "as unit", "its value"),
        Column("sigma", DOUBLE, "as unit", "by noise, and by the calibration where compensated"),
        optional(
            "per_bias",
            DOUBLE,
            "s",
            "of an azimuth: by how much a bias of the gyros to the east, 1 rad/s, turns it; 0 where"
            " the rotation separates the two",
        ),
        optional("known", DOUBLE, "as unit", "what the campaign states, if known"),
        Column("unit", TEXT, "", "rad or rad/s"),
    ),
)
ATTITUDE_ERRORS = Table(
    "attitude_errors",
    1,
    (
        MOUNT,
        _ALIGNMENT,
        Column("manoeuvre", TEXT, "", "over which the rate that remains is integrated"),
        Column("modulated", TRUTH, "", "the table turns the IMU about the vertical"),
        _READINGS,
        Column("seconds", DOUBLE, "s", "since its start"),
        Column("east", DOUBLE, "rad", "error of the attitude about east", _LEVEL),
        Column("north", DOUBLE, "rad", "about north", _LEVEL),
        Column("up", DOUBLE, "rad", "about up", _LEVEL),
        Column("sigma", DOUBLE, "rad", "of each of them by white noise"),
        Column(
            "predicted_east",
            DOUBLE,
            "rad",
            "at rest by the rate that remains in the alignment; under rotation by what is fixed in"
            " the case, carried round by the table",
            _LEVEL,
        ),
        Column("predicted_north", DOUBLE, "rad", "likewise", _LEVEL),
        Column("predicted_up", DOUBLE, "rad", "likewise", _LEVEL),
        Column(
            "predicted_sigma", DOUBLE, "rad", "of the level ones, by the noise of what is fixed"
        ),
    ),
)
MODULATION_GAINS = Table(
    "modulation_gains",
    1,
    (
        MOUNT,
        _ALIGNMENT,
        _READINGS,
        Column("modulated", TEXT, "", "manoeuvre with rotation"),
        Column("still", TEXT, "", "manoeuvre without"),
        Column("seconds", DOUBLE, "s", "time from the start of either that is compared"),
        Column("still_error", DOUBLE, "rad", "largest error of the levels without rotation"),
        Column("still_sigma", DOUBLE, "rad", "its sigma by white noise"),
        Column("modulated_error", DOUBLE, "rad", "with rotation"),
        Column("modulated_sigma", DOUBLE, "rad", "its sigma by white noise"),
        Column("factor", DOUBLE, "1", "error without rotation over error with it"),
        Column("factor_sigma", DOUBLE, "1", "its sigma"),
        Column("predicted_factor", DOUBLE, "1", "likewise, by what is fixed in the case"),
    ),
)

"""Free inertial navigation with the readings before and after calibration; alignment at rest."""

from inertial.tables.table import (
    MOUNT,
    number,
    optional_number,
    optional_text,
    sentence,
    table,
    text,
    truth,
)

MOTION = text("motion", "rest, or turn: a whole one, from rest to rest")
SECONDS = number("seconds", "s", "of free inertial navigation, from the end of alignment")
QUANTITY = text("quantity", "attitude: what it drifts by since the start; velocity; position")
UNIT = text("unit", "unit of the errors, SI")
BEFORE = (
    optional_number("nominal", "as unit", "with the readings as decoded"),
    optional_number(
        "published", "as unit", "with M and bias as published; none where they are not"
    ),
    optional_number("calibrated", "as unit", "with the result that counts"),
)
PREDICTED = optional_number(
    "predicted", "as unit", "rms of the error with the result, by its covariance and the noise"
)

NAVIGATION_ERRORS = table(
    "navigation_errors",
    1,
    text("id", "stable identifier: navigation/quantity/manoeuvre/seconds"),
    MOUNT,
    text("manoeuvre", "as in manoeuvres, with the rest of a turn in brackets"),
    MOTION,
    SECONDS,
    QUANTITY,
    UNIT,
    *BEFORE,
    PREDICTED,
    optional_number("by_parameters", "as unit", "the same by the covariance of the result alone"),
    optional_number(
        "normalised",
        "1",
        "squared error with the result by its predicted covariance, over the 3 axes",
    ),
    text(
        "azimuth",
        "plan: known; gyros: aligned by the earth's rate; unknown: the level earth rate stays"
        " in the rates",
    ),
    sentence("reason", "why nothing was navigated for so long, or predicted"),
)
NAVIGATION_COURSES = table(
    "navigation_courses",
    1,
    MOUNT,
    text("manoeuvre", "the one that was navigated longest, as in errors"),
    SECONDS,
    QUANTITY,
    UNIT,
    *BEFORE,
    PREDICTED,
)
NAVIGATION_SHARES = table(
    "navigation_shares",
    1,
    MOUNT,
    MOTION,
    optional_number("seconds", "s", "as in errors; none: each turn its own"),
    QUANTITY,
    text(
        "family",
        "accel or gyro with bias, scale, cross or the name of an effect; noise; table; earth_rate",
    ),
    text("source", "parameter, or white_noise, drift, azimuth, angle"),
    number(
        "share",
        "1",
        "of the predicted variance, mean over the manoeuvres; what two parameters share counts"
        " by half for each, so one may be negative, and all add up to 1",
    ),
)


# ---- Alignment at rest, and the error of the attitude with and without rotation

_READINGS = text("readings", "recorded; or compensated, by the result that counts")
_ALIGNMENT = text("alignment", "manoeuvre by which the IMU was aligned")
_LEVEL = "east, north, up"

ALIGNMENTS = table(
    "alignments",
    1,
    MOUNT,
    _ALIGNMENT,
    _READINGS,
    text("method", "static: by means at rest; rotation: by the turn that follows it"),
    text(
        "quantity",
        "tilt_x, tilt_y, tilt_z: rotation about a body axis from the planned up to the one"
        " found, static of the case, by rotation of the axis of the turn; azimuth of"
        " `direction`; level_rate: horizontal part of the earth's rate",
    ),
    optional_text("direction", "body direction of an azimuth: mark, x, y, z"),
    number("value", "as unit", "its value"),
    number("sigma", "as unit", "by noise, and by the calibration where compensated"),
    optional_number(
        "per_bias",
        "s",
        "of an azimuth: by how much a bias of the gyros to the east, 1 rad/s, turns it; 0 where"
        " the rotation separates the two",
    ),
    optional_number("known", "as unit", "what the campaign states, if known"),
    text("unit", "rad or rad/s"),
)
ATTITUDE_ERRORS = table(
    "attitude_errors",
    1,
    MOUNT,
    _ALIGNMENT,
    text("manoeuvre", "over which the rate that remains is integrated"),
    truth("modulated", "the table turns the IMU about the vertical"),
    _READINGS,
    number("seconds", "s", "since its start"),
    number("east", "rad", "error of the attitude about east", _LEVEL),
    number("north", "rad", "about north", _LEVEL),
    number("up", "rad", "about up", _LEVEL),
    number("sigma", "rad", "of each of them by white noise"),
    number(
        "predicted_east",
        "rad",
        "at rest by the rate that remains in the alignment; under rotation by what is fixed in"
        " the case, carried round by the table",
        _LEVEL,
    ),
    number("predicted_north", "rad", "likewise", _LEVEL),
    number("predicted_up", "rad", "likewise", _LEVEL),
    number("predicted_sigma", "rad", "of the level ones, by the noise of what is fixed"),
)
MODULATION_GAINS = table(
    "modulation_gains",
    1,
    MOUNT,
    _ALIGNMENT,
    _READINGS,
    text("modulated", "manoeuvre with rotation"),
    text("still", "manoeuvre without"),
    number("seconds", "s", "time from the start of either that is compared"),
    number("still_error", "rad", "largest error of the levels without rotation"),
    number("still_sigma", "rad", "its sigma by white noise"),
    number("modulated_error", "rad", "with rotation"),
    number("modulated_sigma", "rad", "its sigma by white noise"),
    number("factor", "1", "error without rotation over error with it"),
    number("factor_sigma", "1", "its sigma"),
    number("predicted_factor", "1", "likewise, by what is fixed in the case"),
)

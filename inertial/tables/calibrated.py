"""Compensated samples, their checks, and the archive of calibrations."""

from inertial.tables.table import (
    AXIS,
    DOUBLE,
    INTEGER,
    LABEL,
    MOUNT,
    PHASES,
    QUANTITY,
    SENSOR,
    TEXT,
    TEXTS,
    Column,
    channels,
    integer,
    number,
    optional,
    optional_number,
    optional_sentence,
    optional_text,
    sentence,
    table,
    text,
    truth,
)

# ---- Samples with the errors taken out, and the checks of them.

COMPENSATED = table(
    "compensated",
    1,
    Column("log", LABEL, "", "as in logs"),
    integer("record", "as in samples"),
    optional_number("time", "s", "as in samples"),
    *channels("specific force, angular rate, with the errors taken out"),
)
CHECKS = table(
    "checks",
    4,
    text("id", "stable identifier: compensation/quantity/manoeuvre"),
    MOUNT,
    optional_text("manoeuvre", "as in manoeuvres, with the rest of a turn in brackets"),
    text(
        "quantity",
        "gravity: |f|; force_up: f along up; rate_up: rate along up; angle: of a turn about its"
        " axis, the earth's rate taken out; accelerometer, gyro: why one is not compensated;"
        " effect: one of the result that stays in the readings, and why; temperature: the range"
        " beyond which samples are not compensated",
    ),
    text("unit", "unit of the values, SI"),
    optional_number("expected", "as unit", "what is known of it"),
    optional_number("expected_sigma", "as unit", "its standard deviation"),
    optional_number("before", "as unit", "by the readings"),
    optional_number("after", "as unit", "by the compensated readings"),
    optional_number(
        "after_sigma",
        "as unit",
        "of after less expected, by noise, angle, position and earth rate; without what all"
        " manoeuvres share and the parameters have taken up, as the sigma of gravity",
    ),
    optional_number("in_sigmas_after", "1", "after less expected, in sigmas"),
    sentence("sentence", "the check in words"),
)

RESIDUALS = table(
    "residuals",
    1,
    MOUNT,
    text("manoeuvre", "as in manoeuvres; a rest in blocks, a turn in seconds"),
    text("phase", PHASES),
    optional_number("time", "s", "middle of the mean"),
    number("seconds", "s", "recorded in it"),
    *channels("read less predicted by the result that counts", prefix="residual_"),
    *channels("of white noise alone in such a mean", prefix="sigma_"),
)

CHARACTERISTICS = table(
    "characteristics",
    3,
    text("id", "stable identifier: compensation/sensor/quantity_axis"),
    MOUNT,
    SENSOR,
    AXIS,
    text(
        "quantity",
        "as IEEE Std 528 names it: composite_error: largest difference of the compensated"
        " output from the input; linearity_error: largest deviation of the output from a"
        " least-squares line; asymmetry: scale factor of positive less that of negative input,"
        " over both; threshold: least input that gave at least half of the expected output;"
        " resolution: least change of an input that did, on one side of zero;"
        " acceleration_insensitive_drift: bias of a gyro, whatever force adds",
    ),
    optional_number(
        "value",
        "as unit",
        "errors: over the largest input; threshold and resolution: an upper limit, 95 %",
    ),
    optional_number("sigma", "as unit", "its standard deviation; null for limits"),
    optional_number(
        "lower",
        "as unit",
        "of threshold and resolution a lower limit: the largest input that gave less than half"
        " of its output, 95 %, or what counts without carry and noise let through",
    ),
    optional_number(
        "by_noise",
        "as unit",
        "of a largest error: what noise, table and site alone do not exceed in 95 % of the cases",
    ),
    text("unit", "unit of the values, SI"),
    optional_number("largest_input", "as input_unit", "largest that was applied"),
    text("input_unit", "its unit, SI"),
    integer("points", "inputs that were applied, or static positions"),
    sentence("reason", "why there is no value"),
)


UNCERTAINTY_BUDGET = table(
    "uncertainty_budget",
    1,
    MOUNT,
    SENSOR,
    QUANTITY,
    text(
        "source",
        "noise: white noise; drift: bias instability and random walk by the noise, or by the"
        " data sheet; switch_on: bias from switch-on to switch-on; scatter, random_walk:"
        " between manoeuvres, by the fit; position, angle, rate: of the table; table_rate: by"
        " which all its rates are off alike; interpolation: of gaps; clock: its rate by stamps"
        " of arrival; azimuth: unknown direction of north; gravity; latitude",
    ),
    number("sigma", "as unit", "its part of the standard deviation, root of variance"),
    text("unit", "unit of sigma, SI"),
    number("share", "1", "of the variance; all sources together 1"),
)


# ---- The archive of calibrations.


def _rows(*fields: tuple[str, str, str]) -> tuple[Column, ...]:
    """The columns of the rows that each value of a column holds: name, type and meaning."""
    return tuple(optional(name, kind, "", meaning) for name, kind, meaning in fields)


# An archive outlives the other tables, so it borrows no columns of theirs. Whoever counts its
# version up writes how the older files are read.
CALIBRATION = table(
    "calibration",
    5,
    text("campaign", "name of the campaign's folder"),
    truth("simulated", "recorded by the simulated laboratory"),
    truth("compensated", "the errors were taken out of its logs already"),
    text("instrument", "name of the IMU's type"),
    text("serial", "serial number, or unknown"),
    text("date", "date as the campaign states it, or unknown"),
    optional_text("laboratory", "where"),
    optional_text("operator", "by whom"),
    optional_text("notes", "remarks of the laboratory"),
    optional_text("mounting", "as in campaign; none in older calibrations"),
    optional_text("switch_on", "as in campaign; none in older ones"),
    text("table", "name of the table"),
    Column(
        "parameters",
        _rows(
            ("id", TEXT, "stable identifier; no code reads anything from it"),
            ("stage", TEXT, "stage whose row it is; diagnosis: of the result that counts"),
            ("mount", TEXT, "of the plan; empty where the campaign has a single one"),
            ("sensor", TEXT, "accel or gyro"),
            ("method", TEXT, "method of estimation"),
            ("effect", TEXT, "effect in the model that it is a parameter of; none: of M, b"),
            ("parameter", TEXT, "name within the method"),
            ("value", DOUBLE, "estimate in this unit; none where it is not determined"),
            ("sigma", DOUBLE, "its standard deviation"),
            ("unit", TEXT, "unit of value and sigma"),
            ("frame", TEXT, "frame it is expressed in"),
            ("meaning", TEXT, "what it is, in words"),
            ("reason", TEXT, "why it is not determined"),
        ),
        "as unit",
        "the parameters of every method, and of the result that counts",
    ),
    Column(
        "covariance",
        _rows(
            ("first", TEXT, "id of a parameter"),
            ("second", TEXT, "id of a parameter"),
            ("covariance", DOUBLE, "of the two estimates"),
        ),
        "product of the units",
        "of the result that counts",
    ),
    Column(
        "references",
        _rows(
            ("mount", TEXT, "as in parameters"),
            ("sensor", TEXT, "accel or gyro"),
            ("parameter", TEXT, "of the result that counts"),
            ("reference", TEXT, "its name, the same wherever its error is in both alike"),
            ("sigma", DOUBLE, "what of the parameter's sigma is its error"),
        ),
        "as unit",
        "what of the sigmas other calibrations may contain alike; none in older ones",
    ),
    Column(
        "verdicts",
        _rows(
            ("mount", TEXT, "as in parameters"),
            ("sensor", TEXT, "accel or gyro"),
            ("verdict", TEXT, "usable, usable_within_limits, on_condition, or not_usable"),
            ("sentence", TEXT, "the verdict in words"),
            ("method", TEXT, "method of the result that counts"),
            ("condition", TEXT, "on which the result is valid, in words"),
            ("reason", TEXT, "why this method, in words"),
        ),
        "",
        "one for each sensor and mount; none in older calibrations",
    ),
    Column(
        "inputs",
        _rows(
            ("file", TEXT, "file name"),
            ("size", INTEGER, "size of the file, byte"),
            ("sha256", TEXT, "SHA-256 of the file"),
        ),
        "",
        "campaign file and logs",
    ),
    Column(
        "made_by",
        _rows(
            ("stage", TEXT, "name of the stage"),
            ("settings", TEXT, "its settings, as JSON"),
            ("code", TEXT, "SHA-256 of its code"),
            ("inputs", TEXT, "SHA-256 of each file that it read, as JSON"),
        ),
        "",
        "the stages that made these tables",
    ),
    text("content", "SHA-256 of what makes it another calibration"),
    Column("supersedes", TEXTS, "", "files of the archive that it replaces"),
)
ARCHIVED = table(
    "archived",
    1,
    text("file", "the archive's file that holds this calibration"),
    text("sha256", "SHA-256 of that file"),
    text("content", "SHA-256 of what makes it another calibration"),
    text("supersedes", "files that it replaces, with spaces between; or none"),
)
EARLIER = table(
    "earlier",
    5,
    text("campaign", "campaign of another calibration of the same IMU"),
    text("date", "its date, not later than this campaign's, or unknown"),
    text("table", "name of its table"),
    text("file", "the archive's file that holds it"),
    text("id", "identifier of the parameter in its calibration"),
    MOUNT,
    SENSOR,
    QUANTITY,
    number("value", "as unit", "its estimate then, by the result that counted"),
    number("sigma", "as unit", "standard deviation of the estimate"),
    text("unit", "unit of value and sigma"),
    optional_text("verdict", "of its sensor, as in verdict; older: none"),
    optional_sentence("condition", "on which it is valid, in words"),
)

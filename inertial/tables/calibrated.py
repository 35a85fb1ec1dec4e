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
    SENTENCE,
    TEXT,
    TEXTS,
    TRUTH,
    Column,
    Table,
    channels,
    optional,
)

# ---- Samples with the errors taken out, and the checks of them.

COMPENSATED = Table(
    "compensated",
    1,
    (
        Column("log", LABEL, "", "as in logs"),
        Column("record", INTEGER, "1", "as in samples"),
        optional("time", DOUBLE, "s", "as in samples"),
        *channels("specific force, angular rate, with the errors taken out"),
    ),
)
CHECKS = Table(
    "checks",
    4,
    (
        Column("id", TEXT, "", "stable identifier: compensation/quantity/manoeuvre"),
        MOUNT,
        optional("manoeuvre", TEXT, "", "as in manoeuvres, with the rest of a turn in brackets"),
        Column(
            "quantity",
            TEXT,
            "",
            "gravity: |f|; force_up: f along up; rate_up: rate along up; angle: of a turn about its"
            " axis, the earth's rate taken out; accelerometer, gyro: why one is not compensated;"
            " effect: one of the result that stays in the readings, and why; temperature: the range"
            " beyond which samples are not compensated",
        ),
        Column("unit", TEXT, "", "unit of the values, SI"),
        optional("expected", DOUBLE, "as unit", "what is known of it"),
        optional("expected_sigma", DOUBLE, "as unit", "its standard deviation"),
        optional("before", DOUBLE, "as unit", "by the readings"),
        optional("after", DOUBLE, "as unit", "by the compensated readings"),
        optional(
            "after_sigma",
            DOUBLE,
            "as unit",
            "of after less expected, by noise, angle, position and earth rate; without what all"
            " manoeuvres share and the parameters have taken up, as the sigma of gravity",
        ),
        optional("in_sigmas_after", DOUBLE, "1", "after less expected, in sigmas"),
        Column("sentence", SENTENCE, "", "the check in words"),
    ),
)

RESIDUALS = Table(
    "residuals",
    1,
    (
        MOUNT,
        Column("manoeuvre", TEXT, "", "as in manoeuvres; a rest in blocks, a turn in seconds"),
        Column("phase", TEXT, "", PHASES),
        optional("time", DOUBLE, "s", "middle of the mean"),
        Column("seconds", DOUBLE, "s", "recorded in it"),
        *channels("read less predicted by the result that counts", prefix="residual_"),
        *channels("of white noise alone in such a mean", prefix="sigma_"),
    ),
)

CHARACTERISTICS = Table(
    "characteristics",
    3,
    (
        Column("id", TEXT, "", "stable identifier: compensation/sensor/quantity_axis"),
        MOUNT,
        SENSOR,
        AXIS,
        Column(
            "quantity",
            TEXT,
            "",
            "as IEEE Std 528 names it: composite_error: largest difference of the compensated"
            " output from the input; linearity_error: largest deviation of the output from a"
            " least-squares line; asymmetry: scale factor of positive less that of negative input,"
            " over both; threshold: least input that gave at least half of the expected output;"
            " resolution: least change of an input that did, on one side of zero;"
            " acceleration_insensitive_drift: bias of a gyro, whatever force adds",
        ),
        optional(
            "value",
            DOUBLE,
            "as unit",
            "errors: over the largest input; threshold and resolution: an upper limit, 95 %",
        ),
        optional("sigma", DOUBLE, "as unit", "its standard deviation; null for limits"),
        optional(
            "lower",
            DOUBLE,
            "as unit",
            "of threshold and resolution a lower limit: the largest input that gave less than half"
            " of its output, 95 %, or what counts without carry and noise let through",
        ),
        optional(
            "by_noise",
            DOUBLE,
            "as unit",
            "of a largest error: what noise, table and site alone do not exceed in 95 % of the"
            " cases",
        ),
        Column("unit", TEXT, "", "unit of the values, SI"),
        optional("largest_input", DOUBLE, "as input_unit", "largest that was applied"),
        Column("input_unit", TEXT, "", "its unit, SI"),
        Column("points", INTEGER, "1", "inputs that were applied, or static positions"),
        Column("reason", SENTENCE, "", "why there is no value"),
    ),
)


UNCERTAINTY_BUDGET = Table(
    "uncertainty_budget",
    1,
    (
        MOUNT,
        SENSOR,
        QUANTITY,
        Column(
            "source",
            TEXT,
            "",
            "noise: white noise; drift: bias instability and random walk by the noise, or by the"
            " data sheet; switch_on: bias from switch-on to switch-on; scatter, random_walk:"
            " between manoeuvres, by the fit; position, angle, rate: of the table; table_rate: by"
            " which all its rates are off alike; interpolation: of gaps; clock: its rate by stamps"
            " of arrival; azimuth: unknown direction of north; gravity; latitude",
        ),
        Column("sigma", DOUBLE, "as unit", "its part of the standard deviation, root of variance"),
        Column("unit", TEXT, "", "unit of sigma, SI"),
        Column("share", DOUBLE, "1", "of the variance; all sources together 1"),
    ),
)


# ---- The archive of calibrations.


def _rows(*fields: tuple[str, str, str]) -> tuple[Column, ...]:
    """The columns of the rows that each value of a column holds: name, type and meaning."""
    return tuple(optional(name, kind, "", meaning) for name, kind, meaning in fields)


# An archive outlives the other tables, so it borrows no columns of theirs. Whoever counts its
# version up writes how the older files are read.
CALIBRATION = Table(
    "calibration",
    5,
    (
        Column("campaign", TEXT, "", "name of the campaign's folder"),
        Column("simulated", TRUTH, "", "recorded by the simulated laboratory"),
        Column("compensated", TRUTH, "", "the errors were taken out of its logs already"),
        Column("instrument", TEXT, "", "name of the IMU's type"),
        Column("serial", TEXT, "", "serial number, or unknown"),
        Column("date", TEXT, "", "date as the campaign states it, or unknown"),
        optional("laboratory", TEXT, "", "where"),
        optional("operator", TEXT, "", "by whom"),
        optional("notes", TEXT, "", "remarks of the laboratory"),
        optional("mounting", TEXT, "", "as in campaign; none in older calibrations"),
        optional("switch_on", TEXT, "", "as in campaign; none in older ones"),
        Column("table", TEXT, "", "name of the table"),
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
        Column("content", TEXT, "", "SHA-256 of what makes it another calibration"),
        Column("supersedes", TEXTS, "", "files of the archive that it replaces"),
    ),
)
ARCHIVED = Table(
    "archived",
    1,
    (
        Column("file", TEXT, "", "the archive's file that holds this calibration"),
        Column("sha256", TEXT, "", "SHA-256 of that file"),
        Column("content", TEXT, "", "SHA-256 of what makes it another calibration"),
        Column("supersedes", TEXT, "", "files that it replaces, with spaces between; or none"),
    ),
)
EARLIER = Table(
    "earlier",
    4,
    (
        Column("campaign", TEXT, "", "campaign of another calibration of the same IMU"),
        Column("date", TEXT, "", "its date, not later than this campaign's, or unknown"),
        Column("file", TEXT, "", "the archive's file that holds it"),
        Column("id", TEXT, "", "identifier of the parameter in its calibration"),
        MOUNT,
        SENSOR,
        QUANTITY,
        Column("value", DOUBLE, "as unit", "its estimate then, by the result that counted"),
        Column("sigma", DOUBLE, "as unit", "standard deviation of the estimate"),
        Column("unit", TEXT, "", "unit of value and sigma"),
        optional("verdict", TEXT, "", "of its sensor, as in verdict; older: none"),
        optional("condition", SENTENCE, "", "on which it is valid, in words"),
    ),
)

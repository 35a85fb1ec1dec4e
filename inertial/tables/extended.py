"""The extended model: its gain, and the change of the parameters."""

from inertial.tables.table import BODY, DOUBLE, INTEGER, MOUNT, TEXT, TRUTH, Column, Table, optional

_MODEL = Column(
    "model",
    TEXT,
    "",
    "the effects that are fitted together: blocks, all that are fitted to the means of blocks; or"
    " the name of an effect that is fitted to the full-rate residuals",
)

GAIN = Table(
    "gain",
    3,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        optional("axis", TEXT, "", "of a single channel; none: of all three", BODY),
        _MODEL,
        Column(
            "scope", TEXT, "", "fitted: all manoeuvres; held-out: each by the fit to the others"
        ),
        Column("rows", INTEGER, "1", "degrees of freedom without the effects; or samples"),
        Column("before", DOUBLE, "unit²", "chi-squared without the effects; or mean square"),
        Column("after", DOUBLE, "unit²", "the same with them"),
        Column("drop", DOUBLE, "unit²", "before − after"),
        optional(
            "snr_squared",
            DOUBLE,
            "1",
            "of the effects, without the part of noise; held-out: what the counted folds hold of"
            " it, so the reduction if the effects were known exactly",
        ),
        optional(
            "random_walk_drop",
            DOUBLE,
            "1",
            "part of the reduction that a random walk of the biases achieves as well, where the"
            " joint fit has one that the effects replace; else 0",
        ),
        optional("folds", INTEGER, "1", "groups of manoeuvres, each predicted"),
        optional(
            "counted",
            INTEGER,
            "1",
            "folds whose training keeps half of the signal: only these are in the numbers",
        ),
        optional("rms_before", DOUBLE, "as unit", "of the residuals without"),
        optional("rms_after", DOUBLE, "as unit", "and with the effects"),
        Column("unit", TEXT, "", "sigma, or the unit of the channel"),
    ),
)
GAIN_EFFECTS = Table(
    "gain_effects",
    1,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        _MODEL,
        Column("effect", TEXT, "", "an effect of the model that the sensor shows"),
    ),
)
HELD_OUT = Table(
    "held_out",
    1,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        _MODEL,
        Column("fold", INTEGER, "1", "number of the group of manoeuvres, from 1"),
        Column("manoeuvre", TEXT, "", "as in manoeuvres: predicted by the fit to the other groups"),
        Column(
            "counted",
            TRUTH,
            "",
            "whether the other groups keep half of the signal; if not, the fold is in no number",
        ),
    ),
)
MOVED = Table(
    "moved",
    2,
    (
        Column("id", TEXT, "", "of the parameter by the extended fit"),
        Column("joint_id", TEXT, "", "of the same by the joint fit"),
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        Column("parameter", TEXT, "", "its name"),
        Column("unit", TEXT, "", "unit of the values"),
        optional("joint", DOUBLE, "as unit", "value of the joint fit"),
        optional("joint_sigma", DOUBLE, "as unit", "its standard deviation"),
        optional("extended", DOUBLE, "as unit", "value with the effects in the model"),
        optional("extended_sigma", DOUBLE, "as unit", "its standard deviation"),
        optional("difference", DOUBLE, "as unit", "extended − joint"),
        optional(
            "difference_sigma",
            DOUBLE,
            "as unit",
            "root of the difference of the variances; none where the joint fit has a scatter of"
            " the manoeuvres",
        ),
        optional("in_sigmas", DOUBLE, "1", "difference in sigmas of the joint fit"),
    ),
)
WORTH = Table(
    "worth",
    1,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        MOUNT,
        Column("motion", TEXT, "", "rest or turn"),
        Column("rate", DOUBLE, "rad/s", "of the table, mean magnitude"),
        Column("seconds", DOUBLE, "s", "of free inertial navigation with the motion continued"),
        Column("attitude_joint", DOUBLE, "rad", "error with the joint result"),
        Column("attitude_joint_sigma", DOUBLE, "rad", "its standard deviation"),
        Column("attitude_extended", DOUBLE, "rad", "uncertainty of the extended result, rms"),
        Column("velocity_joint", DOUBLE, "m/s", "error with the joint result"),
        Column("velocity_joint_sigma", DOUBLE, "m/s", "its standard deviation"),
        Column("velocity_extended", DOUBLE, "m/s", "uncertainty of the extended result, rms"),
    ),
)

"""The tables of the extension: what it gains, what it moves, what it is worth, and what counts."""

from stages.contracts.parquet import Column, Table
from stages.contracts.tables.shared import DOUBLE, INTEGER, TEXT

_MOUNT = Column("mount", TEXT, "", "the mount, where there are several; else empty")

GAIN = Table(
    "gain",
    2,
    (
        Column("sensor", TEXT, "", "gyro or accel; with an axis: that channel by itself"),
        _MOUNT,
        Column("effects", TEXT, "", "the effects that were added, by name in the catalogue"),
        Column(
            "scope", TEXT, "", "fitted: all manoeuvres; held-out: each by the fit to the others"
        ),
        Column("rows", INTEGER, "1", "degrees of freedom without the effects; or samples"),
        Column("before", DOUBLE, "unit²", "chi-squared without the effects; or mean square"),
        Column("after", DOUBLE, "unit²", "the same with them"),
        Column("drop", DOUBLE, "unit²", "before less after"),
        Column(
            "snr_squared",
            DOUBLE,
            "1",
            "of the effects, noise taken off; held-out: the part that the counted folds took away,"
            " so the drop if the effects were known exactly",
            nullable=True,
        ),
        Column(
            "walked",
            DOUBLE,
            "1",
            "how much of the drop a walk of the biases brings too, where the joint fit has found"
            " one and the effects stand for it; else 0",
            nullable=True,
        ),
        Column("folds", INTEGER, "1", "groups of manoeuvres, each foretold", nullable=True),
        Column(
            "counted",
            INTEGER,
            "1",
            "those whose training keeps half of the signal: only these are in the numbers",
            nullable=True,
        ),
        Column("taken_away", TEXT, "", "the manoeuvres that were foretold", nullable=True),
        Column("left_out", TEXT, "", "those that alone show the effects", nullable=True),
        Column("rms_before", DOUBLE, "as unit", "of the residuals without", nullable=True),
        Column("rms_after", DOUBLE, "as unit", "and with the effects", nullable=True),
        Column("unit", TEXT, "", "sigma, or the unit of the channel"),
    ),
)
MOVED = Table(
    "moved",
    1,
    (
        Column("id", TEXT, "", "of the parameter by the extended fit"),
        Column("joint_id", TEXT, "", "of the same by the joint fit"),
        Column("parameter", TEXT, "", "its name"),
        Column("unit", TEXT, "", "unit of the values"),
        Column("joint", DOUBLE, "as unit", "value of the joint fit", nullable=True),
        Column("joint_sigma", DOUBLE, "as unit", "its standard deviation", nullable=True),
        Column("extended", DOUBLE, "as unit", "value with the effects in the model", nullable=True),
        Column("extended_sigma", DOUBLE, "as unit", "its standard deviation", nullable=True),
        Column("difference", DOUBLE, "as unit", "extended less joint", nullable=True),
        Column(
            "difference_sigma",
            DOUBLE,
            "as unit",
            "root of the difference of the variances; none where the joint fit allows for more",
            nullable=True,
        ),
        Column("in_sigmas", DOUBLE, "1", "difference in sigmas of the joint fit", nullable=True),
    ),
)
WORTH = Table(
    "worth",
    1,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        _MOUNT,
        Column("motion", TEXT, "", "rest or turn"),
        Column("rate", DOUBLE, "rad/s", "of the table, mean magnitude"),
        Column("seconds", DOUBLE, "s", "of free inertial navigation, as if it went on so long"),
        Column("attitude_joint", DOUBLE, "rad", "error with the joint result"),
        Column("attitude_joint_sigma", DOUBLE, "rad", "its standard deviation"),
        Column("attitude_extended", DOUBLE, "rad", "what the extended one leaves uncertain, rms"),
        Column("velocity_joint", DOUBLE, "m/s", "error with the joint result"),
        Column("velocity_joint_sigma", DOUBLE, "m/s", "its standard deviation"),
        Column("velocity_extended", DOUBLE, "m/s", "what the extended one leaves uncertain, rms"),
    ),
)
DECISION = Table(
    "decision",
    1,
    (
        Column("sensor", TEXT, "", "gyro or accel"),
        _MOUNT,
        Column("result", TEXT, "", "joint or extended: which counts from now on"),
        Column("effects", TEXT, "", "the effects that this sensor shows, of those named"),
        Column("drop", DOUBLE, "1", "held-out, as in gain, less walked", nullable=True),
        Column("snr_squared", DOUBLE, "1", "held-out, as in gain", nullable=True),
        Column("folds", INTEGER, "1", "as in gain", nullable=True),
        Column("counted", INTEGER, "1", "as in gain", nullable=True),
        Column("alarms", TEXT, "", "causes of findings that say that something else is wrong"),
        Column("sentence", TEXT, "", "the reason in words"),
    ),
)

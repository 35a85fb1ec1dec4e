"""The tables of the extension: what it gains, what it moves, what it is worth, and what counts."""

import pyarrow as pa

from stages.contracts.parquet import Column, Table

_double, _text, _integer = pa.float64(), pa.string(), pa.int64()
_MOUNT = Column("mount", _text, "", "the mount, where there are several; else empty")

GAIN = Table(
    "gain",
    2,
    (
        Column("sensor", _text, "", "gyro or accel; with an axis: that channel by itself"),
        _MOUNT,
        Column("effects", _text, "", "the effects that were added, by name in the catalogue"),
        Column(
            "scope", _text, "", "fitted: all manoeuvres; held-out: each by the fit to the others"
        ),
        Column("rows", _integer, "1", "degrees of freedom without the effects; or samples"),
        Column("before", _double, "unit²", "chi-squared without the effects; or mean square"),
        Column("after", _double, "unit²", "the same with them"),
        Column("drop", _double, "unit²", "before less after"),
        Column(
            "snr_squared",
            _double,
            "1",
            "of the effects, noise taken off; held-out: the part that the counted folds took away,"
            " so the drop if the effects were known exactly",
            nullable=True,
        ),
        Column(
            "walked",
            _double,
            "1",
            "how much of the drop a walk of the biases brings too, where the joint fit has found"
            " one and the effects stand for it; else 0",
            nullable=True,
        ),
        Column("folds", _integer, "1", "groups of manoeuvres, each foretold", nullable=True),
        Column(
            "counted",
            _integer,
            "1",
            "those whose training keeps half of the signal: only these are in the numbers",
            nullable=True,
        ),
        Column("taken_away", _text, "", "the manoeuvres that were foretold", nullable=True),
        Column("left_out", _text, "", "those that alone show the effects", nullable=True),
        Column("rms_before", _double, "as unit", "of the residuals without", nullable=True),
        Column("rms_after", _double, "as unit", "and with the effects", nullable=True),
        Column("unit", _text, "", "sigma, or the unit of the channel"),
    ),
)
MOVED = Table(
    "moved",
    1,
    (
        Column("id", _text, "", "of the parameter by the extended fit"),
        Column("joint_id", _text, "", "of the same by the joint fit"),
        Column("parameter", _text, "", "its name"),
        Column("unit", _text, "", "unit of the values"),
        Column("joint", _double, "as unit", "value of the joint fit", nullable=True),
        Column("joint_sigma", _double, "as unit", "its standard deviation", nullable=True),
        Column(
            "extended", _double, "as unit", "value with the effects in the model", nullable=True
        ),
        Column("extended_sigma", _double, "as unit", "its standard deviation", nullable=True),
        Column("difference", _double, "as unit", "extended less joint", nullable=True),
        Column(
            "difference_sigma",
            _double,
            "as unit",
            "root of the difference of the variances; none where the joint fit allows for more",
            nullable=True,
        ),
        Column("in_sigmas", _double, "1", "difference in sigmas of the joint fit", nullable=True),
    ),
)
WORTH = Table(
    "worth",
    1,
    (
        Column("manoeuvre", _text, "", "as in manoeuvres"),
        _MOUNT,
        Column("motion", _text, "", "rest or turn"),
        Column("rate", _double, "rad/s", "of the table, mean magnitude"),
        Column("seconds", _double, "s", "of free inertial navigation, as if it went on so long"),
        Column("attitude_joint", _double, "rad", "error with the joint result"),
        Column("attitude_joint_sigma", _double, "rad", "its standard deviation"),
        Column("attitude_extended", _double, "rad", "what the extended one leaves uncertain, rms"),
        Column("velocity_joint", _double, "m/s", "error with the joint result"),
        Column("velocity_joint_sigma", _double, "m/s", "its standard deviation"),
        Column("velocity_extended", _double, "m/s", "what the extended one leaves uncertain, rms"),
    ),
)
DECISION = Table(
    "decision",
    1,
    (
        Column("sensor", _text, "", "gyro or accel"),
        _MOUNT,
        Column("result", _text, "", "joint or extended: which counts from now on"),
        Column("effects", _text, "", "the effects that this sensor shows, of those named"),
        Column("drop", _double, "1", "held-out, as in gain, less walked", nullable=True),
        Column("snr_squared", _double, "1", "held-out, as in gain", nullable=True),
        Column("folds", _integer, "1", "as in gain", nullable=True),
        Column("counted", _integer, "1", "as in gain", nullable=True),
        Column("alarms", _text, "", "causes of findings that say that something else is wrong"),
        Column("sentence", _text, "", "the reason in words"),
    ),
)

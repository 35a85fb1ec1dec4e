"""The extended model: its gain, and the change of the parameters."""

from inertial.tables.table import (
    BODY,
    MOUNT,
    integer,
    number,
    optional_integer,
    optional_number,
    optional_text,
    table,
    text,
    truth,
)

_MODEL = text(
    "model",
    "the effects that are fitted together: blocks, all that are fitted to the means of blocks; or"
    " the name of an effect that is fitted to the full-rate residuals",
)

GAIN = table(
    "gain",
    3,
    MOUNT,
    text("sensor", "gyro or accel"),
    optional_text("axis", "of a single channel; none: of all three", BODY),
    _MODEL,
    text("scope", "fitted: all manoeuvres; held-out: each by the fit to the others"),
    integer("rows", "degrees of freedom without the effects; or samples"),
    number("before", "unit²", "chi-squared without the effects; or mean square"),
    number("after", "unit²", "the same with them"),
    number("drop", "unit²", "before − after"),
    optional_number(
        "snr_squared",
        "1",
        "of the effects, without the part of noise; held-out: what the counted folds hold of"
        " it, so the reduction if the effects were known exactly",
    ),
    optional_number(
        "random_walk_drop",
        "1",
        "part of the reduction that a random walk of the biases achieves as well, where the"
        " joint fit has one that the effects replace; else 0",
    ),
    optional_integer("folds", "groups of manoeuvres, each predicted"),
    optional_integer(
        "counted", "folds whose training keeps half of the signal: only these are in the numbers"
    ),
    optional_number("rms_before", "as unit", "of the residuals without"),
    optional_number("rms_after", "as unit", "and with the effects"),
    text("unit", "sigma, or the unit of the channel"),
)
GAIN_EFFECTS = table(
    "gain_effects",
    1,
    MOUNT,
    text("sensor", "gyro or accel"),
    _MODEL,
    text("effect", "an effect of the model that the sensor shows"),
)
HELD_OUT = table(
    "held_out",
    1,
    MOUNT,
    text("sensor", "gyro or accel"),
    _MODEL,
    integer("fold", "number of the group of manoeuvres, from 1"),
    text("manoeuvre", "as in manoeuvres: predicted by the fit to the other groups"),
    truth(
        "counted",
        "whether the other groups keep half of the signal; if not, the fold is in no number",
    ),
)
MOVED = table(
    "moved",
    2,
    text("id", "of the parameter by the extended fit"),
    text("joint_id", "of the same by the joint fit"),
    MOUNT,
    text("sensor", "gyro or accel"),
    text("parameter", "its name"),
    text("unit", "unit of the values"),
    optional_number("joint", "as unit", "value of the joint fit"),
    optional_number("joint_sigma", "as unit", "its standard deviation"),
    optional_number("extended", "as unit", "value with the effects in the model"),
    optional_number("extended_sigma", "as unit", "its standard deviation"),
    optional_number("difference", "as unit", "extended − joint"),
    optional_number(
        "difference_sigma",
        "as unit",
        "root of the difference of the variances; none where the joint fit has a scatter of"
        " the manoeuvres",
    ),
    optional_number("in_sigmas", "1", "difference in sigmas of the joint fit"),
)
WORTH = table(
    "worth",
    1,
    text("manoeuvre", "as in manoeuvres"),
    MOUNT,
    text("motion", "rest or turn"),
    number("rate", "rad/s", "of the table, mean magnitude"),
    number("seconds", "s", "of free inertial navigation with the motion continued"),
    number("attitude_joint", "rad", "error with the joint result"),
    number("attitude_joint_sigma", "rad", "its standard deviation"),
    number("attitude_extended", "rad", "uncertainty of the extended result, rms"),
    number("velocity_joint", "m/s", "error with the joint result"),
    number("velocity_joint_sigma", "m/s", "its standard deviation"),
    number("velocity_extended", "m/s", "uncertainty of the extended result, rms"),
)

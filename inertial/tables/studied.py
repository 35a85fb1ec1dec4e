"""Parameters by epochs, windows and angles, and the motion of the table."""

from inertial.tables.table import (
    AXIS,
    BODY,
    METHOD,
    MOUNT,
    QUANTITY,
    SENSOR,
    integer,
    number,
    optional_number,
    optional_text,
    sentence,
    table,
    text,
)

EPOCHS = table(
    "epochs",
    2,
    MOUNT,
    SENSOR,
    METHOD,
    QUANTITY,
    text("unit", "unit of the parameter, SI"),
    number("seconds", "s", "end of the epoch, from the start of every rest"),
    optional_number("single", "as unit", "by this epoch alone"),
    number("single_sigma", "as unit", "its sigma by white noise"),
    optional_number("running_mean", "as unit", "by all epochs up to this one"),
    number("running_mean_sigma", "as unit", "its sigma by white noise"),
)
SPREADS = table(
    "spreads",
    2,
    MOUNT,
    SENSOR,
    METHOD,
    QUANTITY,
    text("unit", "unit of the parameter, SI"),
    number("seconds", "s", "length of an epoch"),
    integer("epochs", "how many there are"),
    number("single_variance", "unit²", "variance of the values by single epochs"),
    number("running_variance", "unit²", "variance of the values by running means"),
    number("white_variance", "unit²", "of single epochs, by white noise alone"),
)
WINDOWS = table(
    "windows",
    2,
    MOUNT,
    text("axis", "gyro, and axis of both turns", BODY),
    text("forward", "manoeuvre of the turn forward"),
    text("backward", "manoeuvre of the turn backward"),
    text(
        "by",
        "how the angle of the window is known: whole turn; set rate: by time; own angle: by the"
        " time and angle of the same two turns; encoder: by that of the table; other turns: by"
        " the speed of turns about other axes",
    ),
    number("from_s", "s", "start of the window, from the start of the steady part"),
    integer("samples", "intervals of the window"),
    number("angle", "rad", "half of what lies between the two angles of the table"),
    number("scale", "1", "scale factor error"),
    number("scale_sigma", "1", "its sigma"),
    number("cut_sigma", "1", "the part of it that differs from window to window"),
    number("bias", "rad/s", "bias"),
    number("bias_sigma", "rad/s", "its sigma"),
)
TIME_ANGLE = table(
    "time_angle",
    1,
    text("manoeuvre", "a turn that was recorded whole"),
    number("seconds", "s", "since the stretch with its motion began"),
    number("angle", "rad", "turned so far, mean over some samples about this time"),
    number("swing", "rad", "half the range within them, what bends slowly left out"),
    number("sigma", "rad", "of the angle; at the end that of the whole angle"),
    optional_number("set_angle", "rad", "of the trapezoid that was set"),
)
MOTIONS = table(
    "motions",
    1,
    text("manoeuvre", "a turn that was recorded whole"),
    text(
        "quantity",
        "speed; spin-up or spin-down and start, seconds, acceleration: as if it were constant",
    ),
    number("value", "as unit", "by time and angle"),
    number("sigma", "as unit", "its sigma"),
    optional_number("set_value", "as unit", "what was set"),
    text("unit", "unit of these"),
)
ENCODER = table(
    "encoder",
    3,
    MOUNT,
    optional_text("manoeuvre", "a turn with the angle of the encoder; none: all"),
    text(
        "quantity",
        "scale: scale factor's error of the gyro less that of the encoder; delay of the gyro"
        " less that of the encoder; spread: variance of that delay, 0 where both are only late;"
        " low_pass: time constant of first order with that variance, where it is certain;"
        " dead_time: delay less low_pass; sine, cosine: error of the encoder with its angle"
        " times order; ripple: amplitude in the course of the encoder at the steady rate",
    ),
    optional_number("order", "1", "periods in a turn; none: not periodic"),
    number("value", "as unit", "its value"),
    number("sigma", "as unit", "its sigma, enlarged where the residuals exceed noise"),
    text("unit", "unit of value and sigma"),
    optional_number(
        "p_value", "1", "of a ripple, without one; of all turns, that they have the value in common"
    ),
)
BANDWIDTHS = table(
    "bandwidths",
    1,
    text("id", "stable identifier: studies/sensor/bandwidth_axis/by"),
    MOUNT,
    SENSOR,
    AXIS,
    text(
        "by",
        "encoder: ramps of the rate against the encoder of the table, the response of the gyro"
        " to rates; ramps: as the gyro alone reads them, response of gyro and drive together;"
        " noise: at rest, bandwidth of its white noise and not the response to an input",
    ),
    optional_number("value", "Hz", "of a first-order low pass, where it is certain"),
    optional_number("sigma", "Hz", "its standard deviation"),
    optional_number("lower", "Hz", "lower limit, one-sided 95 %; by ramps that of the gyro alone"),
    integer("turns", "turns, each with two ramps; 0 by noise"),
    sentence("reason", "why there is neither a value nor a limit"),
)
NOT_STUDIED = table(
    "not_studied",
    2,
    text("study", "rests, or turns"),
    MOUNT,
    sentence("subject", "manoeuvres or parameters, in words"),
    sentence("reason", "why there is nothing of it"),
)

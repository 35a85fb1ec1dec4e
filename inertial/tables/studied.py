"""Parameters by epochs, windows and angles, and the motion of the table."""

from inertial.tables.table import (
    AXIS,
    BODY,
    DOUBLE,
    INTEGER,
    METHOD,
    MOUNT,
    QUANTITY,
    SENSOR,
    SENTENCE,
    TEXT,
    Column,
    Table,
    optional,
)

EPOCHS = Table(
    "epochs",
    2,
    (
        MOUNT,
        SENSOR,
        METHOD,
        QUANTITY,
        Column("unit", TEXT, "", "unit of the parameter, SI"),
        Column("seconds", DOUBLE, "s", "end of the epoch, from the start of every rest"),
        optional("single", DOUBLE, "as unit", "by this epoch alone"),
        Column("single_sigma", DOUBLE, "as unit", "its sigma by white noise"),
        optional("running_mean", DOUBLE, "as unit", "by all epochs up to this one"),
        Column("running_mean_sigma", DOUBLE, "as unit", "its sigma by white noise"),
    ),
)
SPREADS = Table(
    "spreads",
    2,
    (
        MOUNT,
        SENSOR,
        METHOD,
        QUANTITY,
        Column("unit", TEXT, "", "unit of the parameter, SI"),
        Column("seconds", DOUBLE, "s", "length of an epoch"),
        Column("epochs", INTEGER, "1", "how many there are"),
        Column("single_variance", DOUBLE, "unit²", "variance of the values by single epochs"),
        Column("running_variance", DOUBLE, "unit²", "variance of the values by running means"),
        Column("white_variance", DOUBLE, "unit²", "of single epochs, by white noise alone"),
    ),
)
WINDOWS = Table(
    "windows",
    2,
    (
        MOUNT,
        Column("axis", TEXT, "", "gyro, and axis of both turns", BODY),
        Column("forward", TEXT, "", "manoeuvre of the turn forward"),
        Column("backward", TEXT, "", "manoeuvre of the turn backward"),
        Column(
            "by",
            TEXT,
            "",
            "how the angle of the window is known: whole turn; set rate: by time; own angle: by the"
            " time and angle of the same two turns; encoder: by that of the table; other turns: by"
            " the speed of turns about other axes",
        ),
        Column("from_s", DOUBLE, "s", "start of the window, from the start of the steady part"),
        Column("samples", INTEGER, "1", "intervals of the window"),
        Column("angle", DOUBLE, "rad", "half of what lies between the two angles of the table"),
        Column("scale", DOUBLE, "1", "scale factor error"),
        Column("scale_sigma", DOUBLE, "1", "its sigma"),
        Column("cut_sigma", DOUBLE, "1", "the part of it that differs from window to window"),
        Column("bias", DOUBLE, "rad/s", "bias"),
        Column("bias_sigma", DOUBLE, "rad/s", "its sigma"),
    ),
)
TIME_ANGLE = Table(
    "time_angle",
    1,
    (
        Column("manoeuvre", TEXT, "", "a turn that was recorded whole"),
        Column("seconds", DOUBLE, "s", "since the stretch with its motion began"),
        Column("angle", DOUBLE, "rad", "turned so far, mean over some samples about this time"),
        Column("swing", DOUBLE, "rad", "half the range within them, what bends slowly left out"),
        Column("sigma", DOUBLE, "rad", "of the angle; at the end that of the whole angle"),
        optional("set_angle", DOUBLE, "rad", "of the trapezoid that was set"),
    ),
)
MOTIONS = Table(
    "motions",
    1,
    (
        Column("manoeuvre", TEXT, "", "a turn that was recorded whole"),
        Column(
            "quantity",
            TEXT,
            "",
            "speed; spin-up or spin-down and start, seconds, acceleration: as if it were constant",
        ),
        Column("value", DOUBLE, "as unit", "by time and angle"),
        Column("sigma", DOUBLE, "as unit", "its sigma"),
        optional("set_value", DOUBLE, "as unit", "what was set"),
        Column("unit", TEXT, "", "unit of these"),
    ),
)
ENCODER = Table(
    "encoder",
    3,
    (
        MOUNT,
        optional("manoeuvre", TEXT, "", "a turn with the angle of the encoder; none: all"),
        Column(
            "quantity",
            TEXT,
            "",
            "scale: scale factor's error of the gyro less that of the encoder; delay of the gyro"
            " less that of the encoder; spread: variance of that delay, 0 where both are only late;"
            " low_pass: time constant of first order with that variance, where it is certain;"
            " dead_time: delay less low_pass; sine, cosine: error of the encoder with its angle"
            " times order; ripple: amplitude in the course of the encoder at the steady rate",
        ),
        optional("order", DOUBLE, "1", "periods in a turn; none: not periodic"),
        Column("value", DOUBLE, "as unit", "its value"),
        Column("sigma", DOUBLE, "as unit", "its sigma, enlarged where the residuals exceed noise"),
        Column("unit", TEXT, "", "unit of value and sigma"),
        optional(
            "p_value",
            DOUBLE,
            "1",
            "of a ripple, without one; of all turns, that they have the value in common",
        ),
    ),
)
BANDWIDTHS = Table(
    "bandwidths",
    1,
    (
        Column("id", TEXT, "", "stable identifier: studies/sensor/bandwidth_axis/by"),
        MOUNT,
        SENSOR,
        AXIS,
        Column(
            "by",
            TEXT,
            "",
            "encoder: ramps of the rate against the encoder of the table, the response of the gyro"
            " to rates; ramps: as the gyro alone reads them, response of gyro and drive together;"
            " noise: at rest, bandwidth of its white noise and not the response to an input",
        ),
        optional("value", DOUBLE, "Hz", "of a first-order low pass, where it is certain"),
        optional("sigma", DOUBLE, "Hz", "its standard deviation"),
        optional(
            "lower", DOUBLE, "Hz", "lower limit, one-sided 95 %; by ramps that of the gyro alone"
        ),
        Column("turns", INTEGER, "1", "turns, each with two ramps; 0 by noise"),
        Column("reason", SENTENCE, "", "why there is neither a value nor a limit"),
    ),
)
NOT_STUDIED = Table(
    "not_studied",
    2,
    (
        Column("study", TEXT, "", "rests, or turns"),
        MOUNT,
        Column("subject", SENTENCE, "", "manoeuvres or parameters, in words"),
        Column("reason", SENTENCE, "", "why there is nothing of it"),
    ),
)

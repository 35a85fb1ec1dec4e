"""Parameters by epochs, windows and angles."""

from stages.contracts.parquet import Column, Table
from stages.contracts.tables.shared import BODY, DOUBLE, INTEGER, TEXT

EPOCHS = Table(
    "epochs",
    1,
    (
        Column("parameter", TEXT, "", "stage, rests and parameter: gyroscope/rests/bias_x"),
        Column("unit", TEXT, "", "unit of the parameter, SI"),
        Column("seconds", DOUBLE, "s", "end of the epoch, from the start of every rest"),
        Column("single", DOUBLE, "as unit", "by this epoch alone", nullable=True),
        Column("single_sigma", DOUBLE, "as unit", "its sigma by white noise"),
        Column("running", DOUBLE, "as unit", "by all epochs up to this one", nullable=True),
        Column("running_sigma", DOUBLE, "as unit", "its sigma by white noise"),
    ),
)
SPREADS = Table(
    "spreads",
    1,
    (
        Column("parameter", TEXT, "", "as in epochs"),
        Column("unit", TEXT, "", "unit of the parameter, SI"),
        Column("seconds", DOUBLE, "s", "length of an epoch"),
        Column("epochs", INTEGER, "1", "how many there are"),
        Column("single", DOUBLE, "unit²", "variance of the values by single epochs"),
        Column("running", DOUBLE, "unit²", "variance of the values by running means"),
        Column("white", DOUBLE, "unit²", "variance by single epochs that white noise would give"),
    ),
)
WINDOWS = Table(
    "windows",
    1,
    (
        Column("axis", TEXT, "", "gyro, and axis of both turns", BODY),
        Column("forward", TEXT, "", "manoeuvre of the turn forward"),
        Column("backward", TEXT, "", "manoeuvre of the turn backward"),
        Column(
            "by",
            TEXT,
            "",
            "how the angle of the window is known: whole turn; set rate: by time; own angle: by the"
            " time and angle of the same two turns; other turns: by the speed of turns about other"
            " axes",
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
        Column("set_angle", DOUBLE, "rad", "of the trapezoid that was set", nullable=True),
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
        Column("set_value", DOUBLE, "as unit", "what was set", nullable=True),
        Column("unit", TEXT, "", "unit of these"),
    ),
)
NOT_STUDIED = Table(
    "not_studied",
    1,
    (
        Column("study", TEXT, "", "rests, or turns"),
        Column("subject", TEXT, "", "manoeuvres or parameters, in words"),
        Column("reason", TEXT, "", "why there is nothing of it"),
    ),
)

"""The plan: campaign, what is known, manoeuvres, what others published."""

from inertial.tables.table import (
    AS_CHANNEL,
    AXIS,
    BODY,
    DOUBLE,
    INTEGER,
    LOG,
    QUANTITY,
    SENSOR,
    SENTENCE,
    TEXT,
    TRUTH,
    Column,
    Table,
    optional,
    vector,
)

CAMPAIGN = Table(
    "campaign",
    3,
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
        optional("mounting", TEXT, "", "label of campaigns between which it stayed"),
        optional("switch_on", TEXT, "", "label of campaigns between which it ran on"),
        Column("table", TEXT, "", "name of the table"),
        optional("rate", DOUBLE, "Hz", "stated sample rate"),
        Column("latitude", DOUBLE, "rad", "geodetic latitude", "earth", True),
        Column("height", DOUBLE, "m", "height above the ellipsoid", "earth", True),
        Column("must_be_set", INTEGER, "", "bits that are set in the status of a valid record"),
        Column("must_be_clear", INTEGER, "", "bits that are clear in the status of a valid record"),
    ),
)
KNOWN = Table(
    "known",
    2,
    (
        Column("quantity", TEXT, "", "name of what is taken as known"),
        optional("value", DOUBLE, "as unit", "its value; none where it is not known"),
        optional("sigma", DOUBLE, "as unit", "standard deviation of the value"),
        Column("unit", TEXT, "", "unit of value and sigma"),
        Column(
            "origin", SENTENCE, "", "stated in the campaign, computed, or assumed, and from what"
        ),
        Column("assumed", TRUTH, "", "the campaign states nothing that it could be computed from"),
    ),
)
IDEAL_READINGS = Table(
    "ideal_readings",
    1,
    (
        Column(
            "situation",
            TEXT,
            "",
            "at_rest, in_free_fall, at_equator, at_pole, under_way_north or under_way_east",
        ),
        Column("latitude", DOUBLE, "rad", "geodetic latitude", "earth"),
        Column("height", DOUBLE, "m", "height above the ellipsoid", "earth"),
        Column("speed", DOUBLE, "m/s", "steady speed to the north or to the east"),
        SENSOR,
        Column("north", DOUBLE, "rad/s, m/s²", "ideal reading, north component", "NED"),
        Column("east", DOUBLE, "rad/s, m/s²", "ideal reading, east component", "NED"),
        Column("down", DOUBLE, "rad/s, m/s²", "ideal reading, downward component", "NED"),
    ),
)
SENSORS = Table(
    "sensors",
    3,
    (
        SENSOR,
        AXIS,
        optional("count_size", DOUBLE, "rad, m/s", "increment of one count"),
        optional("full_scale", DOUBLE, "rad/s, m/s²", "largest input"),
        optional("white_noise", DOUBLE, "rad/√s, m/s/√s", "random walk of the data sheet"),
        optional(
            "bias_instability",
            DOUBLE,
            "rad/s, m/s²",
            "coefficient B of the data sheet: its lowest Allan deviation ÷ 0.664",
        ),
        optional(
            "random_walk", DOUBLE, "rad/s/√s, m/s²/√s", "random walk of the bias by the data sheet"
        ),
        optional("source", TEXT, "", "where these figures are from"),
    ),
)
LOGS = Table(
    "logs",
    1,
    (
        LOG,
        Column("file", TEXT, "", "file name inside the campaign's folder"),
        Column("layout", TEXT, "", "how its bytes are read, as JSON"),
    ),
)
RANGES = Table(
    "ranges",
    3,
    (
        LOG,
        SENSOR,
        AXIS,
        optional("count", DOUBLE, AS_CHANNEL, "what one count is, if stated"),
        Column("increments", TRUTH, "", "a count is an increment: its unit is times s"),
        optional("limit", DOUBLE, AS_CHANNEL, "largest input, if stated"),
        optional(
            "sigma",
            DOUBLE,
            AS_CHANNEL,
            "where rows are means: standard deviation of one of their samples, or of the row; 0: in"
            " the log, or by the residuals; none: not known, or not of means",
        ),
    ),
)
COUNT_SIZES = Table(
    "count_sizes",
    1,
    (
        Column("instrument", TEXT, "", "entry of the list of instruments"),
        Column("sensor", TEXT, "", "accel or gyro"),
        Column("count_size", DOUBLE, "rad, m/s", "increment of one count"),
    ),
)
PURPOSES = Table(
    "purposes",
    1,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres; those without a purpose have no row"),
        Column("purpose", TEXT, "", "alignment, a rest; or modulation, a turn about the vertical"),
    ),
)
INPUTS = Table(
    "inputs",
    1,
    (
        Column("file", TEXT, "", "file name"),
        Column("size", INTEGER, "byte", "size of the file"),
        Column("sha256", TEXT, "", "SHA-256 of the file"),
    ),
)
MANOEUVRES = Table(
    "manoeuvres",
    6,
    (
        Column("manoeuvre", TEXT, "", "identifier, unique in the campaign"),
        Column("do", TEXT, "", "rest, turn or positions"),
        LOG,
        Column("position", TEXT, "", "manoeuvres of one position share its error"),
        Column("mount", TEXT, "", "how the IMU sits on the table"),
        Column("switch_on", INTEGER, "1", "how often the IMU was switched off and on before"),
        *vector("up", "1", "unit vector that points up at the start"),
        *vector("mark", "1", "unit vector to the table's zero mark at the start"),
        *vector("about", "1", "unit vector of the axis of the turn"),
        optional("tumble", TEXT, "", "the tumble that a rest is one of"),
        *vector("tumble_axis", "1", "unit vector of the axis of that tumble"),
        *vector("tumbled", "rad", "angle since the start of the tumble, about its axis"),
        Column(
            "angle", DOUBLE, "rad", "angle of the turn about `about`, right-hand rule", BODY, True
        ),
        optional("angle_sigma", DOUBLE, "rad", "standard deviation of the angle"),
        Column("rate", DOUBLE, "rad/s", "signed rate of the turn about `about`", BODY, True),
        optional(
            "rate_sigma",
            DOUBLE,
            "rad/s",
            "standard deviation of the rate by the encoder; none: by the table's stated one",
        ),
        optional("acceleration", DOUBLE, "rad/s²", "of the table at start and stop"),
        optional("seconds", DOUBLE, "s", "planned duration"),
        optional("temperature", DOUBLE, "K", "stated temperature of the instrument"),
        optional("temperature_sigma", DOUBLE, "K", "its standard deviation, if stated"),
        Column("recorded", TEXT, "", "whole: rest on both sides is in the log; steady: it is not"),
        optional("from_s", DOUBLE, "s", "start of the stated span, in the log's own time"),
        optional("to_s", DOUBLE, "s", "end of the stated span"),
        optional("from_row", INTEGER, "1", "first data row of the stated rows"),
        optional("to_row", INTEGER, "1", "data row after the last"),
        optional("label", TEXT, "", "the records with this label"),
    ),
)
GUESSES = Table(
    "guesses",
    1,
    (Column("part", TEXT, "", "part of the campaign file that is guessed and not confirmed"),),
)
ACCEPTED = Table(
    "accepted",
    1,
    (
        Column("repair", TEXT, "", "id of a repair that the campaign file confirms"),
        Column("place", TEXT, "", "line and key in the campaign file"),
    ),
)
PUBLISHED = Table(
    "published",
    3,
    (
        SENSOR,
        QUANTITY,
        Column("value", DOUBLE, "as unit", "what others found for it"),
        optional("sigma", DOUBLE, "as unit", "its standard deviation, if stated"),
        Column("unit", TEXT, "", "unit of value and sigma, SI"),
        Column("source", TEXT, "", "where it is published"),
        optional("window", DOUBLE, "rad", "angle of the window it is from, if stated"),
        optional("samples", DOUBLE, "1", "intervals of that window, if stated"),
    ),
)

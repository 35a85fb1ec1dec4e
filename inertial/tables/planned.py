"""The plan: campaign, what is known, manoeuvres, what others published."""

from inertial.tables.table import (
    AS_CHANNEL,
    AXIS,
    BODY,
    INTEGER,
    LOG,
    QUANTITY,
    SENSOR,
    Column,
    integer,
    number,
    optional_integer,
    optional_number,
    optional_text,
    sentence,
    table,
    text,
    truth,
    vector,
)

CAMPAIGN = table(
    "campaign",
    3,
    text("campaign", "name of the campaign's folder"),
    truth("simulated", "recorded by the simulated laboratory"),
    truth("compensated", "the errors were taken out of its logs already"),
    text("instrument", "name of the IMU's type"),
    text("serial", "serial number, or unknown"),
    text("date", "date as the campaign states it, or unknown"),
    optional_text("laboratory", "where"),
    optional_text("operator", "by whom"),
    optional_text("notes", "remarks of the laboratory"),
    optional_text("mounting", "label of campaigns between which it stayed"),
    optional_text("switch_on", "label of campaigns between which it ran on"),
    text("table", "name of the table"),
    optional_number("rate", "Hz", "stated sample rate"),
    optional_number("latitude", "rad", "geodetic latitude", "earth"),
    optional_number("height", "m", "height above the ellipsoid", "earth"),
    Column("must_be_set", INTEGER, "", "bits that are set in the status of a valid record"),
    Column("must_be_clear", INTEGER, "", "bits that are clear in the status of a valid record"),
)
KNOWN = table(
    "known",
    2,
    text("quantity", "name of what is taken as known"),
    optional_number("value", "as unit", "its value; none where it is not known"),
    optional_number("sigma", "as unit", "standard deviation of the value"),
    text("unit", "unit of value and sigma"),
    sentence("origin", "stated in the campaign, computed, or assumed, and from what"),
    truth("assumed", "the campaign states nothing that it could be computed from"),
)
IDEAL_READINGS = table(
    "ideal_readings",
    1,
    text(
        "situation", "at_rest, in_free_fall, at_equator, at_pole, under_way_north or under_way_east"
    ),
    number("latitude", "rad", "geodetic latitude", "earth"),
    number("height", "m", "height above the ellipsoid", "earth"),
    number("speed", "m/s", "steady speed to the north or to the east"),
    SENSOR,
    number("north", "rad/s, m/s²", "ideal reading, north component", "NED"),
    number("east", "rad/s, m/s²", "ideal reading, east component", "NED"),
    number("down", "rad/s, m/s²", "ideal reading, downward component", "NED"),
)
SENSORS = table(
    "sensors",
    3,
    SENSOR,
    AXIS,
    optional_number("count_size", "rad, m/s", "increment of one count"),
    optional_number("full_scale", "rad/s, m/s²", "largest input"),
    optional_number("white_noise", "rad/√s, m/s/√s", "random walk of the data sheet"),
    optional_number(
        "bias_instability",
        "rad/s, m/s²",
        "coefficient B of the data sheet: its lowest Allan deviation ÷ 0.664",
    ),
    optional_number(
        "random_walk", "rad/s/√s, m/s²/√s", "random walk of the bias by the data sheet"
    ),
    optional_text("source", "where these figures are from"),
)
LOGS = table(
    "logs",
    1,
    LOG,
    text("file", "file name inside the campaign's folder"),
    text("layout", "how its bytes are read, as JSON"),
)
RANGES = table(
    "ranges",
    3,
    LOG,
    SENSOR,
    AXIS,
    optional_number("count", AS_CHANNEL, "what one count is, if stated"),
    truth("increments", "a count is an increment: its unit is times s"),
    optional_number("limit", AS_CHANNEL, "largest input, if stated"),
    optional_number(
        "sigma",
        AS_CHANNEL,
        "where rows are means: standard deviation of one of their samples, or of the row; 0: in"
        " the log, or by the residuals; none: not known, or not of means",
    ),
)
COUNT_SIZES = table(
    "count_sizes",
    1,
    text("instrument", "entry of the list of instruments"),
    text("sensor", "accel or gyro"),
    number("count_size", "rad, m/s", "increment of one count"),
)
PURPOSES = table(
    "purposes",
    1,
    text("manoeuvre", "as in manoeuvres; those without a purpose have no row"),
    text("purpose", "alignment, a rest; or modulation, a turn about the vertical"),
)
INPUTS = table(
    "inputs",
    1,
    text("file", "file name"),
    Column("size", INTEGER, "byte", "size of the file"),
    text("sha256", "SHA-256 of the file"),
)
MANOEUVRES = table(
    "manoeuvres",
    7,
    text("manoeuvre", "identifier, unique in the campaign"),
    text("do", "rest, turn or positions"),
    LOG,
    text("position", "manoeuvres of one position share its error"),
    text("mount", "how the IMU sits on the table"),
    integer("switch_on", "how often the IMU was switched off and on before"),
    *vector("up", "1", "unit vector that points up at the start"),
    *vector("mark", "1", "unit vector to the table's zero mark at the start"),
    *vector("about", "1", "unit vector of the axis of the turn"),
    number(
        "turned_on",
        "rad",
        "by which it begins further about the vertical than the first manoeuvre of its position",
    ),
    optional_text("tumble", "the tumble that a rest is one of"),
    *vector("tumble_axis", "1", "unit vector of the axis of that tumble"),
    *vector("tumbled", "rad", "angle since the start of the tumble, about its axis"),
    optional_number("angle", "rad", "angle of the turn about `about`, right-hand rule", BODY),
    optional_number("angle_sigma", "rad", "standard deviation of the angle"),
    optional_number("rate", "rad/s", "signed rate of the turn about `about`", BODY),
    optional_number(
        "rate_sigma",
        "rad/s",
        "standard deviation of the rate by the encoder; none: by the table's stated one",
    ),
    optional_number("acceleration", "rad/s²", "of the table at start and stop"),
    optional_number("seconds", "s", "planned duration"),
    optional_number("temperature", "K", "stated temperature of the instrument"),
    optional_number("temperature_sigma", "K", "its standard deviation, if stated"),
    text("recorded", "whole: rest on both sides is in the log; steady: it is not"),
    optional_number("from_s", "s", "start of the stated span, in the log's own time"),
    optional_number("to_s", "s", "end of the stated span"),
    optional_integer("from_row", "first data row of the stated rows"),
    optional_integer("to_row", "data row after the last"),
    optional_text("label", "the records with this label"),
)
GUESSES = table(
    "guesses",
    1,
    text("part", "part of the campaign file that is guessed and not confirmed"),
)
ACCEPTED = table(
    "accepted",
    1,
    text("repair", "id of a repair that the campaign file confirms"),
    text("place", "line and key in the campaign file"),
)
PUBLISHED = table(
    "published",
    3,
    SENSOR,
    QUANTITY,
    number("value", "as unit", "what others found for it"),
    optional_number("sigma", "as unit", "its standard deviation, if stated"),
    text("unit", "unit of value and sigma, SI"),
    text("source", "where it is published"),
    optional_number("window", "rad", "angle of the window it is from, if stated"),
    optional_number("samples", "1", "intervals of that window, if stated"),
)

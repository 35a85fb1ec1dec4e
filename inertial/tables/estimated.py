"""Noise, parameters, covariance, fits, studies and comparisons."""

from inertial.tables.shared import AXES, AXIS, BODY, METHOD, MOUNT, QUANTITY, SENSOR
from inertial.tables.table import DOUBLE, INTEGER, SENTENCE, TEXT, TRUTH, Column, Table

# --- Noise, parameters, covariance, fits and positions ---

NOISE = Table(
    "noise",
    1,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("phase", TEXT, "", "rest or steady"),
        Column("channel", TEXT, "", "one of the six channels"),
        Column("white_noise", DOUBLE, "rad/√s, m/s/√s", "random walk: root of the power density"),
        Column("sigma", DOUBLE, "rad/√s, m/s/√s", "standard deviation of white_noise"),
        Column("per_sample", DOUBLE, "rad/s, m/s²", "standard deviation of the samples"),
        Column("samples", INTEGER, "1", "number of samples"),
        Column("data_sheet", DOUBLE, "rad/√s, m/s/√s", "the data sheet's figure", nullable=True),
    ),
)
ALLAN = Table(
    "allan",
    1,
    (
        Column("channel", TEXT, "", "one of the six channels"),
        Column("tau", DOUBLE, "s", "averaging time"),
        Column("deviation", DOUBLE, "rad/s, m/s²", "overlapping Allan deviation, stretches pooled"),
        Column("lower", DOUBLE, "rad/s, m/s²", "lower end of its 1-sigma confidence interval"),
        Column("upper", DOUBLE, "rad/s, m/s²", "upper end of it"),
        Column("degrees", DOUBLE, "1", "equivalent degrees of freedom of deviation²"),
        Column(
            "model", DOUBLE, "rad/s, m/s²", "deviation by the terms of the noise", nullable=True
        ),
        Column("stretches", INTEGER, "1", "number of static stretches that are pooled"),
    ),
)
SPECTRA = Table(
    "spectra",
    1,
    (
        Column("channel", TEXT, "", "one of the six channels"),
        Column("frequency", DOUBLE, "Hz", "middle of the bin"),
        Column(
            "density",
            DOUBLE,
            "rad²/s, m²/s³",
            "power density of both sides, as N² of a white noise N",
        ),
        Column("degrees", DOUBLE, "1", "equivalent degrees of freedom of density"),
        Column(
            "model", DOUBLE, "rad²/s, m²/s³", "density by the terms of the noise", nullable=True
        ),
        Column("line", TRUTH, "", "whether an oscillation is there, so that the bin is not fitted"),
    ),
)
NOISE_TERMS = Table(
    "noise_terms",
    1,
    (
        Column("channel", TEXT, "", "one of the six channels"),
        Column(
            "term",
            TEXT,
            "",
            "quantisation, white_noise, bias_instability, random_walk or ramp (IEEE Std 952)",
        ),
        Column(
            "detected", TRUTH, "", "whether the data ask for the term; otherwise upper is given"
        ),
        Column("value", DOUBLE, "as unit", "coefficient", nullable=True),
        Column("sigma", DOUBLE, "as unit", "its standard deviation", nullable=True),
        Column("upper", DOUBLE, "as unit", "upper limit, one-sided 95 %", nullable=True),
        Column("unit", TEXT, "", "unit of value, sigma and upper"),
        Column("p_value", DOUBLE, "1", "probability of the data without the term", nullable=True),
        Column("data_sheet", DOUBLE, "as unit", "the data sheet's figure", nullable=True),
        Column("seconds", DOUBLE, "s", "longest stretch without a gap"),
    ),
)
LEVELS = Table(
    "levels",
    4,
    (
        Column("manoeuvre", TEXT, "", "as in noise; none: all that have no row", nullable=True),
        Column("phase", TEXT, "", "rest or steady; none as manoeuvre", nullable=True),
        Column("channel", TEXT, "", "one of the six channels"),
        Column("white_noise", DOUBLE, "rad/√s, m/s/√s", "effective: what every sigma rests on"),
        Column("sigma", DOUBLE, "rad/√s, m/s/√s", "standard deviation of white_noise"),
        Column(
            "source",
            TEXT,
            "",
            "common: of the campaign; own: it differs by over 3 sigma; of means without time, of"
            " which a sample counts as 1 s: stated; residuals: next to 0, for a scatter shows it",
        ),
        Column("degrees", DOUBLE, "1", "degrees of freedom of white_noise"),
        Column(
            "rounding",
            DOUBLE,
            "rad/√s, m/s/√s",
            "beside white_noise: what makes a mean of all of it as uncertain as coarse counts do",
            nullable=True,
        ),
        Column("measured", DOUBLE, "rad/√s, m/s/√s", "as in noise", nullable=True),
        Column("per_sample", DOUBLE, "rad/s, m/s²", "as in noise", nullable=True),
        Column(
            "bias_instability",
            DOUBLE,
            "rad/s, m/s²",
            "B of the common level's channel by terms, or the likeliest; none: does not enter",
            nullable=True,
        ),
        Column(
            "random_walk",
            DOUBLE,
            "rad/s/√s, m/s²/√s",
            "K of its bias by terms, or the likeliest; none: does not enter",
            nullable=True,
        ),
    ),
)
PARAMETERS = Table(
    "parameters",
    3,
    (
        Column("id", TEXT, "", "stable identifier; no code reads anything from it"),
        Column("stage", TEXT, "", "stage that estimated it"),
        MOUNT,
        SENSOR,
        METHOD,
        Column(
            "effect",
            TEXT,
            "",
            "effect in the model that it is a parameter of; none: of the sensor",
            nullable=True,
        ),
        Column("parameter", TEXT, "", "name within the method"),
        Column(
            "value", DOUBLE, "as unit", "estimate; none where it is not determined", nullable=True
        ),
        Column("sigma", DOUBLE, "as unit", "its standard deviation", nullable=True),
        Column("unit", TEXT, "", "unit of value and sigma"),
        Column("frame", TEXT, "", "frame it is expressed in"),
        Column("meaning", SENTENCE, "", "what it is, in words"),
        Column(
            "reason", SENTENCE, "", "why it is not determined, and the manoeuvre that would help"
        ),
    ),
)
COVARIANCE = Table(
    "covariance",
    1,
    (
        Column("first", TEXT, "", "id of a parameter"),
        Column("second", TEXT, "", "id of a parameter"),
        Column("covariance", DOUBLE, "product of the units", "of the two estimates"),
    ),
)
FIT = Table(
    "fit",
    6,
    (
        MOUNT,
        SENSOR,
        METHOD,
        Column(
            "chi_squared",
            DOUBLE,
            "1",
            "weighted sum of squared residuals, the scatter allowed for",
        ),
        Column("degrees", INTEGER, "1", "degrees of freedom"),
        Column("p_value", DOUBLE, "1", "chance of residuals this large by noise alone"),
        Column(
            "scatter", DOUBLE, "as unit", "what manoeuvres differ by beyond noise; 0 where p ≥ 1 %"
        ),
        Column("unit", TEXT, "", "unit of the scatter"),
        Column(
            "random_walk",
            DOUBLE,
            "unit/√s",
            "of the bias, which is that of the middle, beyond that of levels; 0: none",
        ),
        Column("random_walk_sigma", DOUBLE, "unit/√s", "its standard deviation", nullable=True),
        Column(
            "switch_ons", INTEGER, "1", "between which biases may differ: parts of the campaign"
        ),
        *(
            Column(f"switch_on_{axis}{of}", DOUBLE, "as unit", meaning, nullable=True)
            for axis in AXES
            for of, meaning in (
                ("", "standard deviation of the bias between them, beside the noise; none for one"),
                ("_sigma", "its standard deviation; none where 0 is the likeliest value"),
                ("_upper", "its upper limit, one-sided 95 %"),
            )
        ),
    ),
)
FIT_MANOEUVRES = Table(
    "fit_manoeuvres",
    1,
    (
        MOUNT,
        SENSOR,
        METHOD,
        Column("manoeuvre", TEXT, "", "as in manoeuvres, or as in blocks where it was found"),
        Column("phase", TEXT, "", "as in blocks; none: all that the method uses", nullable=True),
        Column("used", TRUTH, "", "in the fit"),
        Column("reason", SENTENCE, "", "why it is not", nullable=True),
    ),
)
POSITIONS = Table(
    "positions",
    2,
    (
        MOUNT,
        SENSOR,
        METHOD,
        Column("position", TEXT, "", "set position"),
        Column("quantity", TEXT, "", "tilt, or horizontal: the component of the earth's rate"),
        Column("component", INTEGER, "", "0 or 1, of the two horizontal axes of the position"),
        Column("value", DOUBLE, "as unit", "estimate, about or along this axis", BODY),
        Column("sigma", DOUBLE, "as unit", "its standard deviation"),
        Column("unit", TEXT, "", "unit of value and sigma"),
    ),
)
SWITCH_ONS = Table(
    "switch_ons",
    1,
    (
        MOUNT,
        SENSOR,
        METHOD,
        Column("switch_on", INTEGER, "1", "as in manoeuvres"),
        Column("axis", TEXT, "", "x, y or z"),
        Column("value", DOUBLE, "as unit", "bias after it, less that of the campaign", BODY),
        Column("sigma", DOUBLE, "as unit", "its standard deviation"),
        Column("unit", TEXT, "", "unit of value and sigma"),
    ),
)
AVERAGING = Table(
    "averaging",
    2,
    (
        MOUNT,
        SENSOR,
        METHOD,
        QUANTITY,
        Column("seconds", DOUBLE, "s", "length of each rest that was used, from its start"),
        Column("value", DOUBLE, "as the parameter", "estimate from these"),
        Column("sigma", DOUBLE, "as the parameter", "its standard deviation"),
    ),
)
WANTED = Table(
    "wanted",
    2,
    (
        MOUNT,
        SENSOR,
        METHOD,
        QUANTITY,
        Column("seconds", DOUBLE, "s", "length of each rest that was recorded"),
        Column("sigma", DOUBLE, "as the parameter", "standard deviation of the bias by these"),
        Column("floor", DOUBLE, "as the parameter", "what of it no time averages out"),
        Column("random_walk", DOUBLE, "parameter·√s", "white noise of the bias, √s of a rest"),
        Column("wanted", DOUBLE, "as the parameter", "sigma that is wanted"),
        Column(
            "wanted_seconds",
            DOUBLE,
            "s",
            "for it; none where the floor is above it",
            nullable=True,
        ),
    ),
)


# ---- Parameters by epochs, windows and angles.

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
        Column("single", DOUBLE, "as unit", "by this epoch alone", nullable=True),
        Column("single_sigma", DOUBLE, "as unit", "its sigma by white noise"),
        Column("running_mean", DOUBLE, "as unit", "by all epochs up to this one", nullable=True),
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
ENCODER = Table(
    "encoder",
    3,
    (
        MOUNT,
        Column(
            "manoeuvre", TEXT, "", "a turn with the angle of the encoder; none: all", nullable=True
        ),
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
        Column("order", DOUBLE, "1", "periods in a turn; none: not periodic", nullable=True),
        Column("value", DOUBLE, "as unit", "its value"),
        Column("sigma", DOUBLE, "as unit", "its sigma, enlarged where the residuals exceed noise"),
        Column("unit", TEXT, "", "unit of value and sigma"),
        Column(
            "p_value",
            DOUBLE,
            "1",
            "of a ripple, without one; of all turns, that they have the value in common",
            nullable=True,
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
        Column(
            "value", DOUBLE, "Hz", "of a first-order low pass, where it is certain", nullable=True
        ),
        Column("sigma", DOUBLE, "Hz", "its standard deviation", nullable=True),
        Column(
            "lower",
            DOUBLE,
            "Hz",
            "lower limit, one-sided 95 %; by ramps that of the gyro alone",
            nullable=True,
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


# ---- Results held against each other.

DIFFERENCES = Table(
    "differences",
    3,
    (
        Column("id", TEXT, "", "stable identifier: comparison/kind/parameter, and which turns"),
        MOUNT,
        SENSOR,
        Column("quantity", TEXT, "", "parameter, or what is common to all gyros"),
        Column(
            "kind",
            TEXT,
            "",
            "static_against_turns, forward_against_backward, method_against_method, published,"
            " fencepost, straight_line",
        ),
        Column("unit", TEXT, "", "unit of the values, SI"),
        Column("first", SENTENCE, "", "what is compared: id of a parameter, or in words"),
        Column("second", SENTENCE, "", "with what: id of a parameter, or in words"),
        Column("first_value", DOUBLE, "as unit", "none where not determined", nullable=True),
        Column("second_value", DOUBLE, "as unit", "none where not determined", nullable=True),
        Column("difference", DOUBLE, "as unit", "first less second", nullable=True),
        Column("sigma", DOUBLE, "as unit", "its sigma; none where not known", nullable=True),
        Column("in_sigmas", DOUBLE, "1", "difference in units of its sigma", nullable=True),
        Column("p_value", DOUBLE, "1", "chance of one so large, either way", nullable=True),
        Column(
            "significant",
            TRUTH,
            "",
            "more than chance among all comparisons; none where there is no p_value",
            nullable=True,
        ),
        Column("sentence", SENTENCE, "", "the difference and the verdict in words"),
    ),
)

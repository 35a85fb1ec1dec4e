"""Noise, parameters, covariance, fits and comparisons."""

from inertial.tables.table import (
    BODY,
    DOUBLE,
    INTEGER,
    METHOD,
    MOUNT,
    QUANTITY,
    SENSOR,
    SENTENCE,
    TEXT,
    TRUTH,
    Column,
    Table,
    optional,
)
from inertial.text.parameters import AXES

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
        optional("data_sheet", DOUBLE, "rad/√s, m/s/√s", "the data sheet's figure"),
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
        optional("model", DOUBLE, "rad/s, m/s²", "deviation by the terms of the noise"),
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
        optional("model", DOUBLE, "rad²/s, m²/s³", "density by the terms of the noise"),
        Column("line", TRUTH, "", "whether an oscillation is there, so that the bin is not fitted"),
    ),
)
NOISE_TERMS = Table(
    "noise_terms",
    3,
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
        Column(
            "stepped",
            TRUTH,
            "",
            "whether one manoeuvre alone changes by a step at rest: no drift of the channel",
        ),
        Column(
            "tilted",
            TRUTH,
            "",
            "whether, by hand, it drifts where it is level and not upright: the support tilts",
        ),
        optional("value", DOUBLE, "as unit", "coefficient"),
        optional("sigma", DOUBLE, "as unit", "its standard deviation"),
        optional("upper", DOUBLE, "as unit", "upper limit, one-sided 95 %"),
        Column("unit", TEXT, "", "unit of value, sigma and upper"),
        optional("p_value", DOUBLE, "1", "probability of the data without the term"),
        optional("data_sheet", DOUBLE, "as unit", "the data sheet's figure"),
        Column("seconds", DOUBLE, "s", "longest stretch without a gap"),
    ),
)
LEVELS = Table(
    "levels",
    7,
    (
        optional("manoeuvre", TEXT, "", "as in noise; none: all that have no row"),
        optional("phase", TEXT, "", "rest or steady; none as manoeuvre"),
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
        optional(
            "rounding",
            DOUBLE,
            "rad/√s, m/s/√s",
            "beside white_noise: what makes a mean of all of it as uncertain as coarse counts do",
        ),
        optional("measured", DOUBLE, "rad/√s, m/s/√s", "as in noise"),
        optional("per_sample", DOUBLE, "rad/s, m/s²", "as in noise"),
        optional(
            "bias_instability",
            DOUBLE,
            "rad/s, m/s²",
            "B of the common level's channel by terms, or the likeliest, or the data sheet's; none:"
            " does not enter",
        ),
        optional(
            "random_walk",
            DOUBLE,
            "rad/s/√s, m/s²/√s",
            "K of its bias by terms, or the likeliest; none: does not enter",
        ),
        optional(
            "delay",
            DOUBLE,
            "s",
            "of slow changes, by the slow low pass behind which the noise at rest of a common"
            " level's channel is; none: none is seen",
        ),
        optional("data_sheet", DOUBLE, "rad/s, m/s²", "B of the data sheet, of a common level"),
        optional(
            "quantisation",
            DOUBLE,
            "rad, m/s",
            "Q of the common level's channel, of which white_noise is free; none: not significant",
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
        optional(
            "effect", TEXT, "", "effect in the model that it is a parameter of; none: of the sensor"
        ),
        Column("parameter", TEXT, "", "name within the method"),
        optional("value", DOUBLE, "as unit", "estimate; none where it is not determined"),
        optional("sigma", DOUBLE, "as unit", "its standard deviation"),
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
    8,
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
        optional(
            "scatter_seconds",
            DOUBLE,
            "s",
            "length of a rest with this scatter, which is in inverse proportion to it: the hand "
            "sways; none: the same in all",
        ),
        Column(
            "random_walk",
            DOUBLE,
            "unit/√s",
            "of the bias, which is that of the middle, beyond that of levels; 0: none",
        ),
        optional("random_walk_sigma", DOUBLE, "unit/√s", "its standard deviation"),
        optional(
            "earth_rate_up",
            DOUBLE,
            "rad/s",
            "upward component of the earth's rate, of which the latitude is an observation",
            "level",
        ),
        Column(
            "switch_ons", INTEGER, "1", "between which biases may differ: parts of the campaign"
        ),
        *(
            optional(f"switch_on_{axis}{of}", DOUBLE, "as unit", meaning)
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
        optional("phase", TEXT, "", "as in blocks; none: all that the method uses"),
        Column("used", TRUTH, "", "in the fit"),
        optional("reason", SENTENCE, "", "why it is not"),
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
        optional("wanted_seconds", DOUBLE, "s", "for it; none where the floor is above it"),
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
        optional("first_value", DOUBLE, "as unit", "none where not determined"),
        optional("second_value", DOUBLE, "as unit", "none where not determined"),
        optional("difference", DOUBLE, "as unit", "first less second"),
        optional("sigma", DOUBLE, "as unit", "its sigma; none where not known"),
        optional("in_sigmas", DOUBLE, "1", "difference in units of its sigma"),
        optional("p_value", DOUBLE, "1", "chance of one so large, either way"),
        optional(
            "significant",
            TRUTH,
            "",
            "more than chance among all comparisons; none where there is no p_value",
        ),
        Column("sentence", SENTENCE, "", "the difference and the verdict in words"),
    ),
)

"""Noise, parameters, covariance, fits and comparisons."""

from inertial.tables.table import (
    BODY,
    INTEGER,
    METHOD,
    MOUNT,
    QUANTITY,
    SENSOR,
    Column,
    integer,
    number,
    optional_number,
    optional_sentence,
    optional_text,
    optional_truth,
    sentence,
    table,
    text,
    truth,
)
from inertial.text.parameters import AXES

# --- Noise, parameters, covariance, fits and positions ---

NOISE = table(
    "noise",
    2,
    text("manoeuvre", "as in manoeuvres"),
    text("phase", "rest or steady"),
    text("channel", "one of the six channels"),
    number("white_noise", "rad/√s, m/s/√s", "random walk: root of the power density"),
    number("sigma", "rad/√s, m/s/√s", "standard deviation of white_noise"),
    number("per_sample", "rad/s, m/s²", "standard deviation of the samples"),
    optional_number(
        "swing",
        "rad, m/s",
        "standard deviation of the integral of what oscillates: by its two ends every sum is as"
        " uncertain, however long it is; none: nothing oscillates",
    ),
    integer("samples", "number of samples"),
    optional_number("data_sheet", "rad/√s, m/s/√s", "the data sheet's figure"),
)
ALLAN = table(
    "allan",
    1,
    text("channel", "one of the six channels"),
    number("tau", "s", "averaging time"),
    number("deviation", "rad/s, m/s²", "overlapping Allan deviation, stretches pooled"),
    number("lower", "rad/s, m/s²", "lower end of its 1-sigma confidence interval"),
    number("upper", "rad/s, m/s²", "upper end of it"),
    number("degrees", "1", "equivalent degrees of freedom of deviation²"),
    optional_number("model", "rad/s, m/s²", "deviation by the terms of the noise"),
    integer("stretches", "number of static stretches that are pooled"),
)
SPECTRA = table(
    "spectra",
    1,
    text("channel", "one of the six channels"),
    number("frequency", "Hz", "middle of the bin"),
    number("density", "rad²/s, m²/s³", "power density of both sides, as N² of a white noise N"),
    number("degrees", "1", "equivalent degrees of freedom of density"),
    optional_number("model", "rad²/s, m²/s³", "density by the terms of the noise"),
    truth("line", "whether an oscillation is there, so that the bin is not fitted"),
)
NOISE_TERMS = table(
    "noise_terms",
    3,
    text("channel", "one of the six channels"),
    text("term", "quantisation, white_noise, bias_instability, random_walk or ramp (IEEE Std 952)"),
    truth("detected", "whether the data ask for the term; otherwise upper is given"),
    truth(
        "stepped", "whether one manoeuvre alone changes by a step at rest: no drift of the channel"
    ),
    truth(
        "tilted", "whether, by hand, it drifts where it is level and not upright: the support tilts"
    ),
    optional_number("value", "as unit", "coefficient"),
    optional_number("sigma", "as unit", "its standard deviation"),
    optional_number("upper", "as unit", "upper limit, one-sided 95 %"),
    text("unit", "unit of value, sigma and upper"),
    optional_number("p_value", "1", "probability of the data without the term"),
    optional_number("data_sheet", "as unit", "the data sheet's figure"),
    number("seconds", "s", "longest stretch without a gap"),
)
LEVELS = table(
    "levels",
    9,
    optional_text("manoeuvre", "as in noise; none: all that have no row"),
    optional_text("phase", "rest or steady; none as manoeuvre"),
    text("channel", "one of the six channels"),
    number("white_noise", "rad/√s, m/s/√s", "effective: what every sigma rests on"),
    number("sigma", "rad/√s, m/s/√s", "standard deviation of white_noise"),
    text(
        "source",
        "common: of the campaign; own: it differs by over 3 sigma; between: where levels scatter by"
        " more than chance; of means without time, of which a sample counts as 1 s: stated;"
        " residuals: next to 0, for a scatter shows it",
    ),
    number("degrees", "1", "degrees of freedom of white_noise"),
    optional_number(
        "rounding",
        "rad/√s, m/s/√s",
        "beside white_noise: what makes a mean of all of it as uncertain as coarse counts do",
    ),
    optional_number("measured", "rad/√s, m/s/√s", "as in noise"),
    optional_number("per_sample", "rad/s, m/s²", "as in noise"),
    optional_number("swing", "rad, m/s", "as in noise"),
    optional_number(
        "bias_instability",
        "rad/s, m/s²",
        "B of the common level's channel by terms, or the likeliest, or the data sheet's; none:"
        " does not enter",
    ),
    optional_number(
        "random_walk",
        "rad/s/√s, m/s²/√s",
        "K of its bias by terms, or the likeliest; none: does not enter",
    ),
    optional_number(
        "delay",
        "s",
        "of slow changes, by the slow low pass behind which the noise at rest of a common"
        " level's channel is; none: none is seen",
    ),
    optional_number("data_sheet", "rad/s, m/s²", "B of the data sheet, of a common level"),
    optional_number(
        "quantisation",
        "rad, m/s",
        "Q of the common level's channel, of which white_noise is free; none: not significant",
    ),
)
PARAMETERS = table(
    "parameters",
    3,
    text("id", "stable identifier; no code reads anything from it"),
    text("stage", "stage that estimated it"),
    MOUNT,
    SENSOR,
    METHOD,
    optional_text("effect", "effect in the model that it is a parameter of; none: of the sensor"),
    text("parameter", "name within the method"),
    optional_number("value", "as unit", "estimate; none where it is not determined"),
    optional_number("sigma", "as unit", "its standard deviation"),
    text("unit", "unit of value and sigma"),
    text("frame", "frame it is expressed in"),
    sentence("meaning", "what it is, in words"),
    sentence("reason", "why it is not determined, and the manoeuvre that would help"),
)
COVARIANCE = table(
    "covariance",
    1,
    text("first", "id of a parameter"),
    text("second", "id of a parameter"),
    number("covariance", "product of the units", "of the two estimates"),
)
FIT = table(
    "fit",
    8,
    MOUNT,
    SENSOR,
    METHOD,
    number("chi_squared", "1", "weighted sum of squared residuals, the scatter allowed for"),
    integer("degrees", "degrees of freedom"),
    number("p_value", "1", "chance of residuals this large by noise alone"),
    number("scatter", "as unit", "what manoeuvres differ by beyond noise; 0 where p ≥ 1 %"),
    text("unit", "unit of the scatter"),
    optional_number(
        "scatter_seconds",
        "s",
        "length of a rest with this scatter, which is in inverse proportion to it: the hand "
        "sways; none: the same in all",
    ),
    number(
        "random_walk",
        "unit/√s",
        "of the bias, which is that of the middle, beyond that of levels; 0: none",
    ),
    optional_number("random_walk_sigma", "unit/√s", "its standard deviation"),
    optional_number(
        "earth_rate_up",
        "rad/s",
        "upward component of the earth's rate, of which the latitude is an observation",
        "level",
    ),
    integer("switch_ons", "between which biases may differ: parts of the campaign"),
    *(
        optional_number(f"switch_on_{axis}{of}", "as unit", meaning)
        for axis in AXES
        for of, meaning in (
            ("", "standard deviation of the bias between them, beside the noise; none for one"),
            ("_sigma", "its standard deviation; none where 0 is the likeliest value"),
            ("_upper", "its upper limit, one-sided 95 %"),
        )
    ),
)
FIT_MANOEUVRES = table(
    "fit_manoeuvres",
    1,
    MOUNT,
    SENSOR,
    METHOD,
    text("manoeuvre", "as in manoeuvres, or as in blocks where it was found"),
    optional_text("phase", "as in blocks; none: all that the method uses"),
    truth("used", "in the fit"),
    optional_sentence("reason", "why it is not"),
)
POSITIONS = table(
    "positions",
    2,
    MOUNT,
    SENSOR,
    METHOD,
    text("position", "set position"),
    text("quantity", "tilt, or horizontal: the component of the earth's rate"),
    Column("component", INTEGER, "", "0 or 1, of the two horizontal axes of the position"),
    number("value", "as unit", "estimate, about or along this axis", BODY),
    number("sigma", "as unit", "its standard deviation"),
    text("unit", "unit of value and sigma"),
)
SWITCH_ONS = table(
    "switch_ons",
    1,
    MOUNT,
    SENSOR,
    METHOD,
    integer("switch_on", "as in manoeuvres"),
    text("axis", "x, y or z"),
    number("value", "as unit", "bias after it, less that of the campaign", BODY),
    number("sigma", "as unit", "its standard deviation"),
    text("unit", "unit of value and sigma"),
)
AVERAGING = table(
    "averaging",
    2,
    MOUNT,
    SENSOR,
    METHOD,
    QUANTITY,
    number("seconds", "s", "length of each rest that was used, from its start"),
    number("value", "as the parameter", "estimate from these"),
    number("sigma", "as the parameter", "its standard deviation"),
)
WANTED = table(
    "wanted",
    2,
    MOUNT,
    SENSOR,
    METHOD,
    QUANTITY,
    number("seconds", "s", "length of each rest that was recorded"),
    number("sigma", "as the parameter", "standard deviation of the bias by these"),
    number("floor", "as the parameter", "what of it no time averages out"),
    number("random_walk", "parameter·√s", "white noise of the bias, √s of a rest"),
    number("wanted", "as the parameter", "sigma that is wanted"),
    optional_number("wanted_seconds", "s", "for it; none where the floor is above it"),
)


# ---- Results held against each other.

DIFFERENCES = table(
    "differences",
    3,
    text("id", "stable identifier: comparison/kind/parameter, and which turns"),
    MOUNT,
    SENSOR,
    text("quantity", "parameter, or what is common to all gyros"),
    text(
        "kind",
        "static_against_turns, forward_against_backward, method_against_method, published,"
        " fencepost, straight_line",
    ),
    text("unit", "unit of the values, SI"),
    sentence("first", "what is compared: id of a parameter, or in words"),
    sentence("second", "with what: id of a parameter, or in words"),
    optional_number("first_value", "as unit", "none where not determined"),
    optional_number("second_value", "as unit", "none where not determined"),
    optional_number("difference", "as unit", "first less second"),
    optional_number("sigma", "as unit", "its sigma; none where not known"),
    optional_number("in_sigmas", "1", "difference in units of its sigma"),
    optional_number("p_value", "1", "chance of one so large, either way"),
    optional_truth(
        "significant", "more than chance among all comparisons; none where there is no p_value"
    ),
    sentence("sentence", "the difference and the verdict in words"),
)

"""The simulation and its unmodelled effects."""

from inertial.tables.recorded import FINDINGS
from inertial.tables.table import (
    BODY,
    LOG,
    MOUNT,
    PHASES,
    channels,
    integer,
    number,
    optional_integer,
    optional_number,
    optional_sentence,
    optional_text,
    optional_truth,
    sentence,
    table,
    text,
    truth,
)

# ---- The simulated readings and their residuals.

SIMULATED = table(
    "simulated",
    1,
    text("manoeuvre", "a whole turn, or a rest in blocks"),
    text("phase", PHASES),
    LOG,
    integer("record", "record of the log; of a block the first"),
    optional_number("time", "s", "as in samples; of a block its middle"),
    *channels("what the IMU should have read"),
    *channels("read less simulated", prefix="residual_"),
)
FIDELITY = table(
    "fidelity",
    2,
    MOUNT,
    text("manoeuvre", "as in manoeuvres"),
    text("channel", "one of the six channels"),
    text("profile", "trapezoid; as the gyros have it; or at rest"),
    number("residual_rms", "rad/s, m/s²", "root mean square of the residuals"),
    number("noise_rms", "rad/s, m/s²", "what white noise, and quantisation, would give"),
    integer("samples", "number of samples, or of blocks of a rest"),
)


# ---- Unmodelled effects: findings, scores, parameters, detection limits, and structure.

FINDING = optional_text("finding", "id of the finding that names it")

EFFECT_FINDINGS = table(
    "effect_findings",
    5,
    *FINDINGS.columns,
    optional_text("verdict", "found, one_of_class, law, unknown_structure"),
    optional_number("statistic", "1", "reduction of chi-squared by it beside the other causes"),
    optional_integer("degrees", "degrees of freedom of the statistic"),
    optional_number(
        "threshold",
        "1",
        "the statistic from which an effect is named; none where it was not selected by it",
    ),
    optional_number("snr", "1", "signal-to-noise ratio: √(statistic − degrees)"),
    optional_number(
        "moves",
        "1",
        "largest shift of a parameter by it, in sigma of that parameter, where it is known",
    ),
    optional_text(
        "split_manoeuvre", "the further manoeuvre that best distinguishes the members of its class"
    ),
    optional_number(
        "split_snr", "1", "signal-to-noise ratio with which that manoeuvre would distinguish them"
    ),
    optional_truth(
        "split_stated", "whether the action states that manoeuvre, with the ratio if there is one"
    ),
    optional_text(
        "predictor", "temperature: of means at several temperatures; none: of readings over time"
    ),
)
MEMBERS = table(
    "members",
    1,
    text("finding", "id of the finding"),
    MOUNT,
    integer("rank", "1 for the most probable effect of the class"),
    text("effect", "name in the catalogue of an effect that it may be"),
    optional_number(
        "probability",
        "1",
        "posterior probability, every effect being equally probable beforehand; none where"
        " probabilities were not compared",
    ),
    optional_number(
        "captured", "1", "share of the signal of the effect of rank 1 that this one can mimic"
    ),
)
CAUSE_POSITIONS = table(
    "cause_positions",
    1,
    text("finding", "id of a finding about an effect of a single position"),
    MOUNT,
    integer("rank", "1 for the most likely position"),
    text("position", "as in manoeuvres: a position that the effect may be at"),
    number("statistic", "1", "reduction of chi-squared by the effect at this position"),
)
STRUCTURE_MANOEUVRES = table(
    "structure_manoeuvres",
    1,
    text("finding", "id of a finding about a structure that few manoeuvres carry"),
    MOUNT,
    integer("rank", "1 for the one that contributes most"),
    text("manoeuvre", "as in manoeuvres: without all of them no test detects any"),
)
DETECTION_LIMITS = table(
    "detection_limits",
    2,
    MOUNT,
    text("effect", "name in the catalogue"),
    text("parameter", "name within the effect"),
    optional_number("limit", "as unit", "size that is detected with 5 sigma"),
    optional_number(
        "smallest",
        "as unit",
        "the limit at that value of the scanned variable at which it is smallest",
    ),
    optional_number("largest", "as unit", "and where it is largest"),
    text("unit", "unit of the limits"),
    optional_number(
        "moves",
        "1",
        "by how many sigma an effect of the size `limit`, not named, moves a parameter at most",
    ),
    optional_text("moved_sensor", "which one: its sensor, gyro or accel"),
    optional_text("moved_parameter", "and its name, such as bias_x"),
    text("reason", "visible; or why there is none: not_excited, absorbed, only_together"),
    optional_sentence("explanation", "why there is none, in words"),
    optional_sentence("remark", "what else to know of it, in words"),
    sentence("sentence", "all of this in words"),
)
SCORES = table(
    "scores",
    3,
    MOUNT,
    text("effect", "name in the catalogue"),
    sentence("cause", "its physical cause"),
    text("sought_in", "blocks, spectrum, noise or quality"),
    FINDING,
    optional_number(
        "statistic",
        "1",
        "reduction of chi-squared by it beside the named effects; none where it is not tested",
    ),
    optional_integer("degrees", "degrees of freedom of the statistic; none where it is not tested"),
    optional_number(
        "p_value",
        "1",
        "probability of such a statistic by noise alone, all searches accounted for; none"
        " where it is not tested",
    ),
    truth("named", "whether the effect is named"),
    text("verdict", "found, one_of_class, law, unknown_structure; empty: not needed"),
    optional_number("snr", "1", "signal-to-noise ratio of a named effect"),
    optional_number(
        "scan_value",
        "as scan_unit",
        "value of the scanned variable at which the statistic is largest",
    ),
    optional_text("scan_unit", "unit of the scanned variable"),
    sentence("sentence", "the verdict in words"),
)
EFFECTS = table(
    "effects",
    3,
    text("id", "stable identifier of a number; no code reads anything from it"),
    MOUNT,
    FINDING,
    text("effect", "name in the catalogue"),
    text("parameter", "name within the effect"),
    optional_number(
        "value",
        "as unit",
        "estimate, fitted with all named effects; of those less what they are on average too"
        " large for having been selected by their size",
    ),
    optional_number("sigma", "as unit", "its standard deviation"),
    optional_number(
        "least_squares",
        "as unit",
        "the estimate without that correction, where it is by least squares",
    ),
    optional_number("detection_limit", "as unit", "size that is detected with 5 sigma"),
    text("unit", "unit of value, sigma and detection limit"),
    sentence("meaning", "what it is"),
)
LINES = table(
    "lines",
    3,
    text("manoeuvre", "as in manoeuvres"),
    MOUNT,
    text("axis", "gyro axis, of the case", BODY),
    number("frequency", "Hz", "of the strongest spectral line, or an alias of it"),
    number("frequency_sigma", "Hz", "its standard deviation"),
    number("amplitude", "rad/s", "of the rate, corrected for averaging over a sample interval"),
    number("amplitude_sigma", "rad/s", "its standard deviation"),
    number("p_value", "1", "probability of such a peak by noise alone, the search accounted for"),
    optional_number("order", "1", "periods per revolution of the table"),
    FINDING,
    optional_text("effect", "effect that causes it; none: not significant"),
)
RANDOM_WALKS = table(
    "random_walks",
    1,
    MOUNT,
    text("sensor", "gyro or accel"),
    number(
        "value",
        "as unit",
        "random walk of the biases beside the named effects, beyond that by noise/terms",
    ),
    optional_number("sigma", "as unit", "its standard deviation, where it is known"),
    text("unit", "rad/s/√s or m/s²/√s"),
    text("finding", "id of the finding that reports it"),
)
DRIFTS_AT_REST = table(
    "drifts_at_rest",
    1,
    MOUNT,
    text("sensor", "gyro or accel, where noise/levels has a drift of its biases"),
    truth(
        "kept",
        "whether it is in the equations; else effects are likelier or few manoeuvres show it",
    ),
)
STRUCTURES = table(
    "structures",
    2,
    MOUNT,
    text(
        "kind",
        "what the residuals are tested against: time, angle, rate, attitude, temperature, or"
        " change in time",
    ),
    optional_text("sensor", "gyro or accel, where it is clearest"),
    optional_text("axis", "axis where it is clearest", BODY),
    optional_number(
        "scan_value",
        "as scan_unit",
        "time of a change, frequency of an oscillation, or order of a ripple",
    ),
    optional_text("scan_unit", "s, Hz, or cycles per revolution"),
    optional_number(
        "statistic",
        "1",
        "reduction of chi-squared by the functions of the test; none where it is not possible",
    ),
    optional_integer("degrees", "degrees of freedom of the statistic"),
    optional_number(
        "p_value",
        "1",
        "probability by noise alone, the search over channels and scan accounted for",
    ),
    truth("detected", "below the significance level that all tests share"),
)
STRUCTURE_POINTS = table(
    "structure_points",
    2,
    MOUNT,
    text("kind", "as in structures"),
    text("sensor", "gyro or accel"),
    text("axis", "axis of the sensor", BODY),
    number("x", "as x_unit", "mean of a bin of what the residuals are tested against"),
    text("x_unit", "unit of x"),
    number("residual", "as unit", "mean residual in the bin, all else as fitted"),
    number("sigma", "as unit", "its standard deviation"),
    number("structure", "as unit", "the same by the functions of the test, fitted"),
    text("unit", "rad/s or m/s²"),
)


# ---- What a campaign says of effects too small for it alone, for fleets of campaigns.

EFFECT_COLUMN = (
    MOUNT,
    text("effect", "name in the catalogue, of an effect without a scan"),
    text("parameter", "name within the effect"),
)
SCORE_VECTOR = table(
    "score_vector",
    1,
    *EFFECT_COLUMN,
    text("unit", "unit of the parameter, SI"),
    number(
        "score",
        "1/unit",
        "b, derivative of the log-likelihood by the parameter where all effects are zero: of"
        " all sensors, parameters and errors fitted, and named effects that are not in this"
        " table; b ~ N(F β, F) for effects of size β",
    ),
)
INFORMATION_MATRIX = table(
    "information_matrix",
    1,
    *EFFECT_COLUMN,
    text("with_effect", "of the column; rows and columns as in score_vector"),
    text("with_parameter", "of the column; the upper triangle is stored"),
    number(
        "information",
        "1/(unit of row · unit of column)",
        "entry of F, the Fisher information; those that are missing are zero",
    ),
)

"""The simulation and its unmodelled effects."""

from inertial.tables.recorded import FINDINGS
from inertial.tables.table import (
    BODY,
    DOUBLE,
    INTEGER,
    LOG,
    MOUNT,
    PHASES,
    SENTENCE,
    TEXT,
    TRUTH,
    Column,
    Table,
    channels,
    optional,
)

# ---- The simulated readings and their residuals.

SIMULATED = Table(
    "simulated",
    1,
    (
        Column("manoeuvre", TEXT, "", "a whole turn, or a rest in blocks"),
        Column("phase", TEXT, "", PHASES),
        LOG,
        Column("record", INTEGER, "1", "record of the log; of a block the first"),
        optional("time", DOUBLE, "s", "as in samples; of a block its middle"),
        *channels("what the IMU should have read"),
        *channels("read less simulated", prefix="residual_"),
    ),
)
FIDELITY = Table(
    "fidelity",
    2,
    (
        MOUNT,
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("channel", TEXT, "", "one of the six channels"),
        Column("profile", TEXT, "", "trapezoid; as the gyros have it; or at rest"),
        Column("residual_rms", DOUBLE, "rad/s, m/s²", "root mean square of the residuals"),
        Column(
            "noise_rms", DOUBLE, "rad/s, m/s²", "what white noise, and quantisation, would give"
        ),
        Column("samples", INTEGER, "1", "number of samples, or of blocks of a rest"),
    ),
)


# ---- Unmodelled effects: findings, scores, parameters, detection limits, and structure.

FINDING = optional("finding", TEXT, "", "id of the finding that names it")

EFFECT_FINDINGS = Table(
    "effect_findings",
    5,
    (
        *FINDINGS.columns,
        optional("verdict", TEXT, "", "found, one_of_class, law, unknown_structure"),
        optional(
            "statistic", DOUBLE, "1", "reduction of chi-squared by it beside the other causes"
        ),
        optional("degrees", INTEGER, "1", "degrees of freedom of the statistic"),
        optional(
            "threshold",
            DOUBLE,
            "1",
            "the statistic from which an effect is named; none where it was not selected by it",
        ),
        optional("snr", DOUBLE, "1", "signal-to-noise ratio: √(statistic − degrees)"),
        optional(
            "moves",
            DOUBLE,
            "1",
            "largest shift of a parameter by it, in sigma of that parameter, where it is known",
        ),
        optional(
            "split_manoeuvre",
            TEXT,
            "",
            "the further manoeuvre that best distinguishes the members of its class",
        ),
        optional(
            "split_snr",
            DOUBLE,
            "1",
            "signal-to-noise ratio with which that manoeuvre would distinguish them",
        ),
        optional(
            "split_stated",
            TRUTH,
            "",
            "whether the action states that manoeuvre, with the ratio if there is one",
        ),
        optional(
            "predictor",
            TEXT,
            "",
            "temperature: of means at several temperatures; none: of readings over time",
        ),
    ),
)
MEMBERS = Table(
    "members",
    1,
    (
        Column("finding", TEXT, "", "id of the finding"),
        MOUNT,
        Column("rank", INTEGER, "1", "1 for the most probable effect of the class"),
        Column("effect", TEXT, "", "name in the catalogue of an effect that it may be"),
        optional(
            "probability",
            DOUBLE,
            "1",
            "posterior probability, every effect being equally probable beforehand; none where"
            " probabilities were not compared",
        ),
        optional(
            "captured",
            DOUBLE,
            "1",
            "share of the signal of the effect of rank 1 that this one can mimic",
        ),
    ),
)
CAUSE_POSITIONS = Table(
    "cause_positions",
    1,
    (
        Column("finding", TEXT, "", "id of a finding about an effect of a single position"),
        MOUNT,
        Column("rank", INTEGER, "1", "1 for the most likely position"),
        Column("position", TEXT, "", "as in manoeuvres: a position that the effect may be at"),
        Column("statistic", DOUBLE, "1", "reduction of chi-squared by the effect at this position"),
    ),
)
STRUCTURE_MANOEUVRES = Table(
    "structure_manoeuvres",
    1,
    (
        Column("finding", TEXT, "", "id of a finding about a structure that few manoeuvres carry"),
        MOUNT,
        Column("rank", INTEGER, "1", "1 for the one that contributes most"),
        Column("manoeuvre", TEXT, "", "as in manoeuvres: without all of them no test detects any"),
    ),
)
DETECTION_LIMITS = Table(
    "detection_limits",
    2,
    (
        MOUNT,
        Column("effect", TEXT, "", "name in the catalogue"),
        Column("parameter", TEXT, "", "name within the effect"),
        optional("limit", DOUBLE, "as unit", "size that is detected with 5 sigma"),
        optional(
            "smallest",
            DOUBLE,
            "as unit",
            "the limit at that value of the scanned variable at which it is smallest",
        ),
        optional("largest", DOUBLE, "as unit", "and where it is largest"),
        Column("unit", TEXT, "", "unit of the limits"),
        optional(
            "moves",
            DOUBLE,
            "1",
            "by how many sigma an effect of the size `limit`, not named, moves a parameter at most",
        ),
        optional("moved_sensor", TEXT, "", "which one: its sensor, gyro or accel"),
        optional("moved_parameter", TEXT, "", "and its name, such as bias_x"),
        Column(
            "reason",
            TEXT,
            "",
            "visible; or why there is none: not_excited, absorbed, only_together",
        ),
        optional("explanation", SENTENCE, "", "why there is none, in words"),
        optional("remark", SENTENCE, "", "what else to know of it, in words"),
        Column("sentence", SENTENCE, "", "all of this in words"),
    ),
)
SCORES = Table(
    "scores",
    3,
    (
        MOUNT,
        Column("effect", TEXT, "", "name in the catalogue"),
        Column("cause", SENTENCE, "", "its physical cause"),
        Column("sought_in", TEXT, "", "blocks, spectrum, noise or quality"),
        FINDING,
        optional(
            "statistic",
            DOUBLE,
            "1",
            "reduction of chi-squared by it beside the named effects; none where it is not tested",
        ),
        optional(
            "degrees",
            INTEGER,
            "1",
            "degrees of freedom of the statistic; none where it is not tested",
        ),
        optional(
            "p_value",
            DOUBLE,
            "1",
            "probability of such a statistic by noise alone, all searches accounted for; none"
            " where it is not tested",
        ),
        Column("named", TRUTH, "", "whether the effect is named"),
        Column(
            "verdict", TEXT, "", "found, one_of_class, law, unknown_structure; empty: not needed"
        ),
        optional("snr", DOUBLE, "1", "signal-to-noise ratio of a named effect"),
        optional(
            "scan_value",
            DOUBLE,
            "as scan_unit",
            "value of the scanned variable at which the statistic is largest",
        ),
        optional("scan_unit", TEXT, "", "unit of the scanned variable"),
        Column("sentence", SENTENCE, "", "the verdict in words"),
    ),
)
EFFECTS = Table(
    "effects",
    3,
    (
        Column("id", TEXT, "", "stable identifier of a number; no code reads anything from it"),
        MOUNT,
        FINDING,
        Column("effect", TEXT, "", "name in the catalogue"),
        Column("parameter", TEXT, "", "name within the effect"),
        optional(
            "value",
            DOUBLE,
            "as unit",
            "estimate, fitted with all named effects; of those less what they are on average too"
            " large for having been selected by their size",
        ),
        optional("sigma", DOUBLE, "as unit", "its standard deviation"),
        optional(
            "least_squares",
            DOUBLE,
            "as unit",
            "the estimate without that correction, where it is by least squares",
        ),
        optional("detection_limit", DOUBLE, "as unit", "size that is detected with 5 sigma"),
        Column("unit", TEXT, "", "unit of value, sigma and detection limit"),
        Column("meaning", SENTENCE, "", "what it is"),
    ),
)
LINES = Table(
    "lines",
    3,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        MOUNT,
        Column("axis", TEXT, "", "gyro axis, of the case", BODY),
        Column("frequency", DOUBLE, "Hz", "of the strongest spectral line, or an alias of it"),
        Column("frequency_sigma", DOUBLE, "Hz", "its standard deviation"),
        Column(
            "amplitude",
            DOUBLE,
            "rad/s",
            "of the rate, corrected for averaging over a sample interval",
        ),
        Column("amplitude_sigma", DOUBLE, "rad/s", "its standard deviation"),
        Column(
            "p_value",
            DOUBLE,
            "1",
            "probability of such a peak by noise alone, the search accounted for",
        ),
        optional("order", DOUBLE, "1", "periods per revolution of the table"),
        FINDING,
        optional("effect", TEXT, "", "effect that causes it; none: not significant"),
    ),
)
RANDOM_WALKS = Table(
    "random_walks",
    1,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        Column(
            "value",
            DOUBLE,
            "as unit",
            "random walk of the biases beside the named effects, beyond that by noise/terms",
        ),
        optional("sigma", DOUBLE, "as unit", "its standard deviation, where it is known"),
        Column("unit", TEXT, "", "rad/s/√s or m/s²/√s"),
        Column("finding", TEXT, "", "id of the finding that reports it"),
    ),
)
DRIFTS_AT_REST = Table(
    "drifts_at_rest",
    1,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel, where noise/levels has a drift of its biases"),
        Column(
            "kept",
            TRUTH,
            "",
            "whether it is in the equations; else effects are likelier or few manoeuvres show it",
        ),
    ),
)
STRUCTURES = Table(
    "structures",
    2,
    (
        MOUNT,
        Column(
            "kind",
            TEXT,
            "",
            "what the residuals are tested against: time, angle, rate, attitude, temperature, or"
            " change in time",
        ),
        optional("sensor", TEXT, "", "gyro or accel, where it is clearest"),
        optional("axis", TEXT, "", "axis where it is clearest", BODY),
        optional(
            "scan_value",
            DOUBLE,
            "as scan_unit",
            "time of a change, frequency of an oscillation, or order of a ripple",
        ),
        optional("scan_unit", TEXT, "", "s, Hz, or cycles per revolution"),
        optional(
            "statistic",
            DOUBLE,
            "1",
            "reduction of chi-squared by the functions of the test; none where it is not possible",
        ),
        optional("degrees", INTEGER, "1", "degrees of freedom of the statistic"),
        optional(
            "p_value",
            DOUBLE,
            "1",
            "probability by noise alone, the search over channels and scan accounted for",
        ),
        Column("detected", TRUTH, "", "below the significance level that all tests share"),
    ),
)
STRUCTURE_POINTS = Table(
    "structure_points",
    2,
    (
        MOUNT,
        Column("kind", TEXT, "", "as in structures"),
        Column("sensor", TEXT, "", "gyro or accel"),
        Column("axis", TEXT, "", "axis of the sensor", BODY),
        Column("x", DOUBLE, "as x_unit", "mean of a bin of what the residuals are tested against"),
        Column("x_unit", TEXT, "", "unit of x"),
        Column("residual", DOUBLE, "as unit", "mean residual in the bin, all else as fitted"),
        Column("sigma", DOUBLE, "as unit", "its standard deviation"),
        Column("structure", DOUBLE, "as unit", "the same by the functions of the test, fitted"),
        Column("unit", TEXT, "", "rad/s or m/s²"),
    ),
)


# ---- What a campaign says of effects too small for it alone, for fleets of campaigns.

EFFECT_COLUMN = (
    MOUNT,
    Column("effect", TEXT, "", "name in the catalogue, of an effect without a scan"),
    Column("parameter", TEXT, "", "name within the effect"),
)
SCORE_VECTOR = Table(
    "score_vector",
    1,
    (
        *EFFECT_COLUMN,
        Column("unit", TEXT, "", "unit of the parameter, SI"),
        Column(
            "score",
            DOUBLE,
            "1/unit",
            "b, derivative of the log-likelihood by the parameter where all effects are zero: of"
            " all sensors, parameters and errors fitted, and named effects that are not in this"
            " table; b ~ N(F β, F) for effects of size β",
        ),
    ),
)
INFORMATION_MATRIX = Table(
    "information_matrix",
    1,
    (
        *EFFECT_COLUMN,
        Column("with_effect", TEXT, "", "of the column; rows and columns as in score_vector"),
        Column("with_parameter", TEXT, "", "of the column; the upper triangle is stored"),
        Column(
            "information",
            DOUBLE,
            "1/(unit of row · unit of column)",
            "entry of F, the Fisher information; those that are missing are zero",
        ),
    ),
)

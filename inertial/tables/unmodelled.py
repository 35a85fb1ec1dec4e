"""The simulation, the effects that it lacks, and the model extended by them."""

from inertial.tables.recorded import FINDINGS
from inertial.tables.shared import BODY, LOG, PHASES, channels
from inertial.tables.table import DOUBLE, INTEGER, TEXT, TRUTH, Column, Table

# ---- What should have been recorded.

SIMULATED = Table(
    "simulated",
    1,
    (
        Column("manoeuvre", TEXT, "", "a whole turn, or a rest in blocks"),
        Column("phase", TEXT, "", PHASES),
        LOG,
        Column("record", INTEGER, "1", "record of the log; of a block the first"),
        Column("time", DOUBLE, "s", "time of the record, or middle of the block", nullable=True),
        *channels("what the IMU should have read"),
        *channels("read less simulated", prefix="residual_"),
    ),
)
FIDELITY = Table(
    "fidelity",
    1,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("channel", TEXT, "", "one of the six channels"),
        Column("profile", TEXT, "", "trapezoid; as the gyros have it; or at rest"),
        Column("residual_rms", DOUBLE, "rad/s, m/s²", "root mean square of the residuals"),
        Column("noise_rms", DOUBLE, "rad/s, m/s²", "what white noise alone would give"),
        Column("samples", INTEGER, "1", "number of samples, or of blocks of a rest"),
    ),
)


# ---- What the model lacks: causes, scores, effects, lines, random walks and structures.

CAUSES = Table(
    "causes",
    1,
    (
        *FINDINGS.columns,
        Column("verdict", TEXT, "", "found, one_of_class, unknown_structure", nullable=True),
        Column("members", TEXT, "", "those that cannot be told apart", nullable=True),
        Column("statistic", DOUBLE, "1", "drop of chi-squared beside the others", nullable=True),
        Column("degrees", INTEGER, "1", "of freedom of the drop", nullable=True),
        Column("snr", DOUBLE, "1", "root of the drop less what noise adds", nullable=True),
        Column("parameters", TEXT, "SI", "name = value ± sigma unit, each", nullable=True),
        Column("split_manoeuvre", TEXT, "", "what would tell the members apart", nullable=True),
        Column("split_snr", DOUBLE, "1", "how clearly it would, in sigmas", nullable=True),
    ),
)
BLIND_SPOTS = Table(
    "blind_spots",
    1,
    (
        Column("effect", TEXT, "", "name in the catalogue, with @ and the mount if of several"),
        Column("parameter", TEXT, "", "name within the effect"),
        Column("visible", DOUBLE, "as unit", "5 sigma: what could have been seen", nullable=True),
        Column("best", DOUBLE, "as unit", "at the best value of what is scanned", nullable=True),
        Column("worst", DOUBLE, "as unit", "and at the worst", nullable=True),
        Column("unit", TEXT, "", "unit of these"),
        Column("reason", TEXT, "", "visible, not_excited, absorbed, or only_together"),
        Column("sentence", TEXT, "", "the same in words"),
    ),
)
SCORES = Table(
    "scores",
    2,
    (
        Column("effect", TEXT, "", "name in the catalogue"),
        Column("cause", TEXT, "", "its physical cause"),
        Column("sought_in", TEXT, "", "blocks, spectrum, noise or quality"),
        Column("statistic", DOUBLE, "1", "drop of chi-squared beyond what was named before it"),
        Column("degrees", INTEGER, "1", "of freedom: what the plan excites of the effect"),
        Column("p_value", DOUBLE, "1", "chance of such a statistic, or peak, by noise alone"),
        Column("named", TRUTH, "", "below the family-wise level"),
        Column("verdict", TEXT, "", "found, one_of_class, unknown_structure; empty: not needed"),
        Column("members", TEXT, "", "all causes that cannot be told apart, likeliest first"),
        Column("snr", DOUBLE, "1", "signal-to-noise ratio of what is named", nullable=True),
        Column("at", DOUBLE, "", "value of what is scanned of the effect", nullable=True),
        Column("sentence", TEXT, "", "what is said of it"),
    ),
)
EFFECTS = Table(
    "effects",
    1,
    (
        Column("id", TEXT, "", "stable identifier: criticism/effect/parameter"),
        Column("effect", TEXT, "", "name in the catalogue"),
        Column("parameter", TEXT, "", "name within the effect"),
        Column("value", DOUBLE, "as unit", "estimate beside all named effects", nullable=True),
        Column("sigma", DOUBLE, "as unit", "its standard deviation", nullable=True),
        Column("visible", DOUBLE, "as unit", "5 sigma: what can be seen", nullable=True),
        Column("unit", TEXT, "", "unit of these"),
        Column("meaning", TEXT, "", "what it is"),
    ),
)
LINES = Table(
    "lines",
    2,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("axis", TEXT, "", "gyro axis, of the case", BODY),
        Column("frequency", DOUBLE, "Hz", "of the strongest line, or an alias of it"),
        Column("frequency_sigma", DOUBLE, "Hz", "its standard deviation"),
        Column("amplitude", DOUBLE, "rad/s", "of the rate, the averaging of a sample undone"),
        Column("amplitude_sigma", DOUBLE, "rad/s", "its standard deviation"),
        Column("p_value", DOUBLE, "1", "chance of such a peak by noise, the search paid for"),
        Column("order", DOUBLE, "1", "periods in one turn of the table", nullable=True),
        Column("effect", TEXT, "", "that it is taken for; empty: none stands out", nullable=True),
    ),
)
WALKS = Table(
    "walks",
    1,
    (
        Column("method", TEXT, "", "joint, with @ and the mount where there are several"),
        Column("sensor", TEXT, "", "gyro or accel"),
        Column("walk", DOUBLE, "SI/√s", "random walk of the biases beside the named effects"),
        Column("sigma", DOUBLE, "SI/√s", "its standard deviation; none: not known", nullable=True),
    ),
)
STRUCTURES = Table(
    "structures",
    1,
    (
        Column("method", TEXT, "", "joint, with @ and the mount where there are several"),
        Column("kind", TEXT, "", "time, angle, rate, attitude, temperature or change"),
        Column("channel", TEXT, "", "where it is clearest: sensor and axis; empty: none asked"),
        Column("place", DOUBLE, "", "s of a change, Hz, cycles per turn", nullable=True),
        Column("statistic", DOUBLE, "1", "drop of chi-squared with the functions of the test"),
        Column("degrees", INTEGER, "1", "of freedom of the drop"),
        Column("p_value", DOUBLE, "1", "after the search over channels and what is scanned"),
        Column("fires", TRUTH, "", "below the level that all six share"),
    ),
)
STRUCTURE_POINTS = Table(
    "structure_points",
    1,
    (
        Column("method", TEXT, "", "as in structures"),
        Column("kind", TEXT, "", "as in structures"),
        Column("channel", TEXT, "", "as in structures"),
        Column("x", DOUBLE, "as x_unit", "what the readings are a function of, mean of a bin"),
        Column("x_unit", TEXT, "", "unit of x"),
        Column("left", DOUBLE, "as unit", "what the model leaves there, all else as fitted"),
        Column("sigma", DOUBLE, "as unit", "its standard deviation"),
        Column("structure", DOUBLE, "as unit", "what the structure would be there"),
        Column("unit", TEXT, "", "rad/s or m/s²"),
    ),
)


# ---- The tables of the extension: what it gains, what it moves, what it is worth, and what
# counts.

_MOUNT = Column("mount", TEXT, "", "the mount, where there are several; else empty")

GAIN = Table(
    "gain",
    2,
    (
        Column("sensor", TEXT, "", "gyro or accel; with an axis: that channel by itself"),
        _MOUNT,
        Column("effects", TEXT, "", "the effects that were added, by name in the catalogue"),
        Column(
            "scope", TEXT, "", "fitted: all manoeuvres; held-out: each by the fit to the others"
        ),
        Column("rows", INTEGER, "1", "degrees of freedom without the effects; or samples"),
        Column("before", DOUBLE, "unit²", "chi-squared without the effects; or mean square"),
        Column("after", DOUBLE, "unit²", "the same with them"),
        Column("drop", DOUBLE, "unit²", "before less after"),
        Column(
            "snr_squared",
            DOUBLE,
            "1",
            "of the effects, noise taken off; held-out: the part that the counted folds took away,"
            " so the drop if the effects were known exactly",
            nullable=True,
        ),
        Column(
            "walked",
            DOUBLE,
            "1",
            "how much of the drop a walk of the biases brings too, where the joint fit has found"
            " one and the effects stand for it; else 0",
            nullable=True,
        ),
        Column("folds", INTEGER, "1", "groups of manoeuvres, each foretold", nullable=True),
        Column(
            "counted",
            INTEGER,
            "1",
            "those whose training keeps half of the signal: only these are in the numbers",
            nullable=True,
        ),
        Column("taken_away", TEXT, "", "the manoeuvres that were foretold", nullable=True),
        Column("left_out", TEXT, "", "those that alone show the effects", nullable=True),
        Column("rms_before", DOUBLE, "as unit", "of the residuals without", nullable=True),
        Column("rms_after", DOUBLE, "as unit", "and with the effects", nullable=True),
        Column("unit", TEXT, "", "sigma, or the unit of the channel"),
    ),
)
MOVED = Table(
    "moved",
    1,
    (
        Column("id", TEXT, "", "of the parameter by the extended fit"),
        Column("joint_id", TEXT, "", "of the same by the joint fit"),
        Column("parameter", TEXT, "", "its name"),
        Column("unit", TEXT, "", "unit of the values"),
        Column("joint", DOUBLE, "as unit", "value of the joint fit", nullable=True),
        Column("joint_sigma", DOUBLE, "as unit", "its standard deviation", nullable=True),
        Column("extended", DOUBLE, "as unit", "value with the effects in the model", nullable=True),
        Column("extended_sigma", DOUBLE, "as unit", "its standard deviation", nullable=True),
        Column("difference", DOUBLE, "as unit", "extended less joint", nullable=True),
        Column(
            "difference_sigma",
            DOUBLE,
            "as unit",
            "root of the difference of the variances; none where the joint fit allows for more",
            nullable=True,
        ),
        Column("in_sigmas", DOUBLE, "1", "difference in sigmas of the joint fit", nullable=True),
    ),
)
WORTH = Table(
    "worth",
    1,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        _MOUNT,
        Column("motion", TEXT, "", "rest or turn"),
        Column("rate", DOUBLE, "rad/s", "of the table, mean magnitude"),
        Column("seconds", DOUBLE, "s", "of free inertial navigation, as if it went on so long"),
        Column("attitude_joint", DOUBLE, "rad", "error with the joint result"),
        Column("attitude_joint_sigma", DOUBLE, "rad", "its standard deviation"),
        Column("attitude_extended", DOUBLE, "rad", "what the extended one leaves uncertain, rms"),
        Column("velocity_joint", DOUBLE, "m/s", "error with the joint result"),
        Column("velocity_joint_sigma", DOUBLE, "m/s", "its standard deviation"),
        Column("velocity_extended", DOUBLE, "m/s", "what the extended one leaves uncertain, rms"),
    ),
)
DECISION = Table(
    "decision",
    1,
    (
        Column("sensor", TEXT, "", "gyro or accel"),
        _MOUNT,
        Column("result", TEXT, "", "joint or extended: which counts from now on"),
        Column("effects", TEXT, "", "the effects that this sensor shows, of those named"),
        Column("drop", DOUBLE, "1", "held-out, as in gain, less walked", nullable=True),
        Column("snr_squared", DOUBLE, "1", "held-out, as in gain", nullable=True),
        Column("folds", INTEGER, "1", "as in gain", nullable=True),
        Column("counted", INTEGER, "1", "as in gain", nullable=True),
        Column("alarms", TEXT, "", "causes of findings that say that something else is wrong"),
        Column("sentence", TEXT, "", "the reason in words"),
    ),
)

"""What the model lacks: causes, scores, effects, lines, random walks and structures."""

from stages.contracts.parquet import Column, Table
from stages.contracts.tables.recording import FINDINGS
from stages.contracts.tables.shared import BODY, DOUBLE, INTEGER, TEXT, TRUTH

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

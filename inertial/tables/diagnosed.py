"""Repairs of a recording, candidates for the result, and the diagnosis: causes and verdict."""

from inertial.tables.table import (
    BODY,
    DOUBLE,
    INTEGER,
    MOUNT,
    SENTENCE,
    TEXT,
    TRUTH,
    Column,
    Table,
    optional,
)

SENSOR = optional("sensor", TEXT, "", "accel or gyro, where one is concerned")
AXIS = optional("axis", TEXT, "", BODY)

# ---- Repairs: what was set right before the estimation, on which condition.

REPAIRS = Table(
    "repairs",
    1,
    (
        Column("id", TEXT, "", "name by which `accept` of the campaign file confirms it"),
        Column(
            "repair",
            TEXT,
            "",
            "gravity, axes, signs, count_size, sense_of_table, other_way_up, exchanged_manoeuvres,"
            " stated_rate, stated_spans, stated_marks",
        ),
        Column(
            "state",
            TEXT,
            "",
            "applied; confirmed: applied, and accepted in the campaign file; refused: by the"
            " settings; rival: others explain as much, so none of them is applied",
        ),
        SENSOR,
        AXIS,
        optional("log", TEXT, "", "as in logs, where one is concerned"),
        optional("manoeuvre", TEXT, "", "as in manoeuvres, where one is concerned"),
        optional("value", DOUBLE, "as unit", "what is used, where it is a number"),
        optional("sigma", DOUBLE, "as unit", "its standard deviation"),
        optional("stated", DOUBLE, "as unit", "what the campaign states"),
        Column("unit", TEXT, "", "unit of value, sigma and stated"),
        optional("fitting_before", INTEGER, "1", "observations that fit the plan without it"),
        optional("fitting_after", INTEGER, "1", "observations that fit the plan with it"),
        optional("observations", INTEGER, "1", "observations that were compared"),
        optional("finding", TEXT, "", "id of the finding that it removes"),
        Column("condition", SENTENCE, "", "what must be true for it to be right, in words"),
        Column("sentence", SENTENCE, "", "what was set right, in words"),
    ),
)
CHANNEL_REPAIRS = Table(
    "channel_repairs",
    1,
    (
        Column("repair", TEXT, "", "id of an applied repair"),
        Column("log", TEXT, "", "as in logs: whose readings it concerns"),
        Column("sensor", TEXT, "", "accel or gyro"),
        Column("axis", TEXT, "", "axis whose reading is set right", BODY),
        Column("from_axis", TEXT, "", "axis under which it was recorded", BODY),
        Column("factor", DOUBLE, "1", "by which the recorded reading is multiplied"),
    ),
)

# ---- Candidates for the result of a sensor, from extension.

CANDIDATES = Table(
    "candidates",
    3,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        Column("method", TEXT, "", "method of its parameters, as in parameters of extension"),
        Column(
            "probability",
            DOUBLE,
            "1",
            "posterior probability among the members of its class, all equal beforehand; of the"
            " joint method that of the members which this sensor does not show",
        ),
        optional(
            "drop",
            DOUBLE,
            "1",
            "reduction of chi-squared of held-out manoeuvres against the joint model; none: not"
            " cross-validated",
        ),
        optional(
            "drop_without_walk",
            DOUBLE,
            "1",
            "the same against the joint model without its random walk of the biases; none: it has"
            " none",
        ),
        optional("snr_squared", DOUBLE, "1", "what exactly known effects would bring"),
        optional("folds", INTEGER, "1", "number of groups of manoeuvres held out"),
        optional("counted", INTEGER, "1", "of these, predictable from the others"),
        optional(
            "carried_by",
            TEXT,
            "",
            "manoeuvre without which an effect of it is not detected in the others; by which"
            " effect: candidate_effects",
        ),
        Column(
            "undetermined",
            INTEGER,
            "1",
            "parameters of the sensor that the joint model determines and this one does not",
        ),
        Column(
            "open_form",
            TRUTH,
            "",
            "whether its laws of the rate, or of the attitude, have about as many terms as the plan"
            " has of these, so that no manoeuvre confirms their form",
        ),
        Column(
            "saturated",
            TRUTH,
            "",
            "whether its effects have a term for nearly every manoeuvre, so that none predicts"
            " another",
        ),
        Column("sentence", SENTENCE, "", "the gain in words"),
    ),
)
CANDIDATE_EFFECTS = Table(
    "candidate_effects",
    2,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        Column("method", TEXT, "", "as in candidates"),
        Column("effect", TEXT, "", "effect of the catalogue in the model of this candidate"),
        Column("finding", TEXT, "", "id of the finding of criticism that names it or its class"),
        optional(
            "carried_by",
            TEXT,
            "",
            "manoeuvre without which this effect is not detected in the others, so that these do"
            " not show it, or contradict it; none: no single manoeuvre carries it",
        ),
    ),
)

# ---- The diagnosis.

CAUSE = Column("cause", TEXT, "", "id of the cause")

CAUSES = Table(
    "causes",
    2,
    (
        Column("id", TEXT, "", "stable identifier; no code reads anything from it"),
        Column("cause", TEXT, "", "what is wrong: an effect of the catalogue or a fault"),
        Column("verdict", TEXT, "", "found, one_of_class, law, or unknown_structure"),
        MOUNT,
        SENSOR,
        AXIS,
        optional("log", TEXT, "", "as in logs, where one is concerned"),
        optional("manoeuvre", TEXT, "", "as in manoeuvres, where one is concerned"),
        Column("count", INTEGER, "1", "how many equal ones this stands for"),
        Column("sentence", SENTENCE, "", "the cause in words, with how large and how sure"),
        optional("size", DOUBLE, "as unit", "how large"),
        optional("sigma", DOUBLE, "as unit", "standard deviation of size"),
        Column("unit", TEXT, "", "unit of size and sigma"),
        optional("snr", DOUBLE, "1", "signal-to-noise ratio of an effect"),
        optional("p_value", DOUBLE, "1", "chance of it if nothing is wrong"),
        Column(
            "cure",
            TEXT,
            "",
            "repaired, modelled, curve: of the temperature, masked, interpolated, left_out; none:"
            " nothing removes it here",
        ),
        optional("gain", SENTENCE, "", "what the cure brought, in words"),
        optional("fitting_before", INTEGER, "1", "as in repairs"),
        optional("fitting_after", INTEGER, "1", "as in repairs"),
        optional(
            "held_out_drop",
            DOUBLE,
            "1",
            "reduction of chi-squared of manoeuvres that the fit has not seen",
        ),
        optional(
            "moves",
            DOUBLE,
            "1",
            "largest shift of a parameter that it causes or caused, in sigma of that parameter;"
            " none: not known",
        ),
        optional("condition", SENTENCE, "", "on which the result is valid, in words"),
        Column("consequence", SENTENCE, "", "what it does to the result, in words"),
        Column("done", SENTENCE, "", "what was done about it, in words"),
        Column("action", SENTENCE, "", "what to do in the laboratory, in words"),
    ),
)
CAUSE_MEMBERS = Table(
    "cause_members",
    1,
    (
        Column("id", TEXT, "", "stable identifier; no code reads anything from it"),
        CAUSE,
        MOUNT,
        Column("rank", INTEGER, "1", "1 for the most probable"),
        Column("member", TEXT, "", "what it may be: an effect of the catalogue or a fault"),
        optional("probability", DOUBLE, "1", "posterior probability, where compared"),
    ),
)
CONSEQUENCES = Table(
    "consequences",
    1,
    (
        Column("finding", TEXT, "", "id of a finding"),
        Column("stage", TEXT, "", "stage whose finding it is"),
        CAUSE,
    ),
)
VERDICTS = Table(
    "verdicts",
    2,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        Column("recorded", TRUTH, "", "whether a log has readings of it"),
        Column("verdict", TEXT, "", "usable, usable_within_limits, on_condition, or not_usable"),
        Column("sentence", SENTENCE, "", "the verdict in words, the cause first"),
        Column("method", TEXT, "", "method of the result: joint, extended, or mixture"),
        optional("condition", SENTENCE, "", "on which the result is valid, in words"),
        Column("reason", SENTENCE, "", "why this method, in words"),
    ),
)

# ---- Parameters as functions of temperature, by the result that counts.

TEMPERATURE_CURVES = Table(
    "temperature_curves",
    2,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        Column("parameter", TEXT, "", "one of the twelve, as in parameters"),
        Column("temperature", DOUBLE, "K", "within the range of the campaign"),
        Column("value", DOUBLE, "as unit", "of the parameter at this temperature", BODY),
        Column("sigma", DOUBLE, "as unit", "its standard deviation, that at T0 included"),
        Column("unit", TEXT, "", "unit of value and sigma"),
        Column("order", INTEGER, "1", "degree of the polynomial, or of the lines beside a knot"),
        optional("knot", DOUBLE, "K", "where the slope changes, if it does"),
        optional(
            "probability",
            DOUBLE,
            "1",
            "of this order or knot, where the value is the mean over several shapes",
        ),
        optional(
            "relative_to",
            DOUBLE,
            "K",
            "temperature from which the value is a change, where its level is not known",
        ),
        optional(
            "not_separated",
            TEXT,
            "",
            "what else the change may be, in words, where one attitude does not separate it",
        ),
    ),
)

WARM_UP = Table(
    "warm_up",
    1,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        Column("axis", TEXT, "", BODY),
        Column("band", DOUBLE, "as unit", "to either side of the last value of the bias"),
        Column("unit", TEXT, "", "unit of band"),
        optional(
            "seconds",
            DOUBLE,
            "s",
            "from the first sample, after which the bias stays within; none: it does not settle",
        ),
        optional("sigma", DOUBLE, "s", "its standard deviation; none at the start"),
        Column("sentence", SENTENCE, "", "the same in words"),
    ),
)

DRIFT_MEANS = Table(
    "drift_means",
    1,
    (
        MOUNT,
        Column("sensor", TEXT, "", "gyro or accel"),
        Column("method", TEXT, "", "candidate whose effects drift"),
        Column("parameter", TEXT, "", "of a drift, as in its table of parameters"),
        Column("of", TEXT, "", "parameter of the sensor that drifts"),
        Column("mean", DOUBLE, "of/parameter", "change of `of` on average over the recording"),
    ),
)
PROPOSED = Table(
    "proposed",
    1,
    (
        MOUNT,
        Column("effect", TEXT, "", "the law, as in effects"),
        Column("file", TEXT, "", "name of its file in extension/proposed"),
        Column("text", TEXT, "", "the file: an effect in the form of the catalogue"),
    ),
)

"""Repairs of a recording, candidates for the result, and the diagnosis: causes and verdict."""

from inertial.tables.table import (
    BODY,
    MOUNT,
    integer,
    number,
    optional_integer,
    optional_number,
    optional_sentence,
    optional_text,
    sentence,
    table,
    text,
    truth,
)

SENSOR = optional_text("sensor", "accel or gyro, where one is concerned")
AXIS = optional_text("axis", BODY)

# ---- Repairs: what was set right before the estimation, on which condition.

REPAIRS = table(
    "repairs",
    1,
    text("id", "name by which `accept` of the campaign file confirms it"),
    text(
        "repair",
        "gravity, axes, signs, count_size, sense_of_table, other_way_up, exchanged_manoeuvres,"
        " stated_rate, stated_spans, stated_marks",
    ),
    text(
        "state",
        "applied; confirmed: applied, and accepted in the campaign file; refused: by the"
        " settings; rival: others explain as much, so none of them is applied",
    ),
    SENSOR,
    AXIS,
    optional_text("log", "as in logs, where one is concerned"),
    optional_text("manoeuvre", "as in manoeuvres, where one is concerned"),
    optional_number("value", "as unit", "what is used, where it is a number"),
    optional_number("sigma", "as unit", "its standard deviation"),
    optional_number("stated", "as unit", "what the campaign states"),
    text("unit", "unit of value, sigma and stated"),
    optional_integer("fitting_before", "observations that fit the plan without it"),
    optional_integer("fitting_after", "observations that fit the plan with it"),
    optional_integer("observations", "observations that were compared"),
    optional_text("finding", "id of the finding that it removes"),
    sentence("condition", "what must be true for it to be right, in words"),
    sentence("sentence", "what was set right, in words"),
)
CHANNEL_REPAIRS = table(
    "channel_repairs",
    1,
    text("repair", "id of an applied repair"),
    text("log", "as in logs: whose readings it concerns"),
    text("sensor", "accel or gyro"),
    text("axis", "axis whose reading is set right", BODY),
    text("from_axis", "axis under which it was recorded", BODY),
    number("factor", "1", "by which the recorded reading is multiplied"),
)

# ---- Candidates for the result of a sensor, from extension.

CANDIDATES = table(
    "candidates",
    3,
    MOUNT,
    text("sensor", "gyro or accel"),
    text("method", "method of its parameters, as in parameters of extension"),
    number(
        "probability",
        "1",
        "posterior probability among the members of its class, all equal beforehand; of the"
        " joint method that of the members which this sensor does not show",
    ),
    optional_number(
        "drop",
        "1",
        "reduction of chi-squared of held-out manoeuvres against the joint model; none: not"
        " cross-validated",
    ),
    optional_number(
        "drop_without_walk",
        "1",
        "the same against the joint model without its random walk of the biases; none: it has none",
    ),
    optional_number("snr_squared", "1", "what exactly known effects would bring"),
    optional_integer("folds", "number of groups of manoeuvres held out"),
    optional_integer("counted", "of these, predictable from the others"),
    optional_text(
        "carried_by",
        "manoeuvre without which an effect of it is not detected in the others; by which"
        " effect: candidate_effects",
    ),
    integer(
        "undetermined",
        "parameters of the sensor that the joint model determines and this one does not",
    ),
    truth(
        "open_form",
        "whether its laws of the rate, or of the attitude, have about as many terms as the plan"
        " has of these, so that no manoeuvre confirms their form",
    ),
    truth(
        "saturated",
        "whether its effects have a term for nearly every manoeuvre, so that none predicts another",
    ),
    sentence("sentence", "the gain in words"),
)
CANDIDATE_EFFECTS = table(
    "candidate_effects",
    2,
    MOUNT,
    text("sensor", "gyro or accel"),
    text("method", "as in candidates"),
    text("effect", "effect of the catalogue in the model of this candidate"),
    text("finding", "id of the finding of criticism that names it or its class"),
    optional_text(
        "carried_by",
        "manoeuvre without which this effect is not detected in the others, so that these do"
        " not show it, or contradict it; none: no single manoeuvre carries it",
    ),
)

# ---- The diagnosis.

CAUSE = text("cause", "id of the cause")

CAUSES = table(
    "causes",
    2,
    text("id", "stable identifier; no code reads anything from it"),
    text("cause", "what is wrong: an effect of the catalogue or a fault"),
    text("verdict", "found, one_of_class, law, or unknown_structure"),
    MOUNT,
    SENSOR,
    AXIS,
    optional_text("log", "as in logs, where one is concerned"),
    optional_text("manoeuvre", "as in manoeuvres, where one is concerned"),
    integer("count", "how many equal ones this stands for"),
    sentence("sentence", "the cause in words, with how large and how sure"),
    optional_number("size", "as unit", "how large"),
    optional_number("sigma", "as unit", "standard deviation of size"),
    text("unit", "unit of size and sigma"),
    optional_number("snr", "1", "signal-to-noise ratio of an effect"),
    optional_number("p_value", "1", "chance of it if nothing is wrong"),
    text(
        "cure",
        "repaired, modelled, curve: of the temperature, masked, interpolated, left_out; none:"
        " nothing removes it here",
    ),
    optional_sentence("gain", "what the cure brought, in words"),
    optional_integer("fitting_before", "as in repairs"),
    optional_integer("fitting_after", "as in repairs"),
    optional_number(
        "held_out_drop", "1", "reduction of chi-squared of manoeuvres that the fit has not seen"
    ),
    optional_number(
        "moves",
        "1",
        "largest shift of a parameter that it causes or caused, in sigma of that parameter;"
        " none: not known",
    ),
    optional_sentence("condition", "on which the result is valid, in words"),
    sentence("consequence", "what it does to the result, in words"),
    sentence("done", "what was done about it, in words"),
    sentence("action", "what to do in the laboratory, in words"),
)
CAUSE_MEMBERS = table(
    "cause_members",
    2,
    text("id", "stable identifier; no code reads anything from it"),
    CAUSE,
    MOUNT,
    integer("rank", "1 for the most probable"),
    text("member", "what it may be: an effect of the catalogue or a fault"),
    optional_number("probability", "1", "posterior probability, where compared"),
    optional_sentence("condition", "of a repair: what would have to be true, in words"),
)
CONSEQUENCES = table(
    "consequences",
    1,
    text("finding", "id of a finding"),
    text("stage", "stage whose finding it is"),
    CAUSE,
)
VERDICTS = table(
    "verdicts",
    2,
    MOUNT,
    text("sensor", "gyro or accel"),
    truth("recorded", "whether a log has readings of it"),
    text("verdict", "usable, usable_within_limits, on_condition, or not_usable"),
    sentence("sentence", "the verdict in words, the cause first"),
    text("method", "method of the result: joint, extended, or mixture"),
    optional_sentence("condition", "on which the result is valid, in words"),
    sentence("reason", "why this method, in words"),
)

# ---- Parameters as functions of temperature, by the result that counts.

TEMPERATURE_CURVES = table(
    "temperature_curves",
    2,
    MOUNT,
    text("sensor", "gyro or accel"),
    text("parameter", "one of the twelve, as in parameters"),
    number("temperature", "K", "within the range of the campaign"),
    number("value", "as unit", "of the parameter at this temperature", BODY),
    number("sigma", "as unit", "its standard deviation, that at T0 included"),
    text("unit", "unit of value and sigma"),
    integer("order", "degree of the polynomial, or of the lines beside a knot"),
    optional_number("knot", "K", "where the slope changes, if it does"),
    optional_number(
        "probability", "1", "of this order or knot, where the value is the mean over several shapes"
    ),
    optional_number(
        "relative_to",
        "K",
        "temperature from which the value is a change, where its level is not known",
    ),
    optional_text(
        "not_separated",
        "what else the change may be, in words, where one attitude does not separate it",
    ),
)

WARM_UP = table(
    "warm_up",
    1,
    MOUNT,
    text("sensor", "gyro or accel"),
    text("axis", BODY),
    number("band", "as unit", "to either side of the last value of the bias"),
    text("unit", "unit of band"),
    optional_number(
        "seconds",
        "s",
        "from the first sample, after which the bias stays within; none: it does not settle",
    ),
    optional_number("sigma", "s", "its standard deviation; none at the start"),
    sentence("sentence", "the same in words"),
)

DRIFT_MEANS = table(
    "drift_means",
    1,
    MOUNT,
    text("sensor", "gyro or accel"),
    text("method", "candidate whose effects drift"),
    text("parameter", "of a drift, as in its table of parameters"),
    text("of", "parameter of the sensor that drifts"),
    number("mean", "of/parameter", "change of `of` on average over the recording"),
)
PROPOSED = table(
    "proposed",
    1,
    MOUNT,
    text("effect", "the law, as in effects"),
    text("file", "name of its file in extension/proposed"),
    text("text", "the file: an effect in the form of the catalogue"),
)

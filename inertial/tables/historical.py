"""How well calibrations of one IMU repeat, jumps between them, and what the next may be."""

from inertial.tables.table import (
    QUANTITY,
    SENSOR,
    integer,
    number,
    optional_number,
    optional_text,
    sentence,
    table,
    text,
    truth,
)

UNIT = text("unit", "unit of the parameter, SI")

REPEATABILITY = table(
    "repeatability",
    1,
    SENSOR,
    QUANTITY,
    UNIT,
    text(
        "component",
        "within: rms of the calibrations' sigmas, shared errors out; repeatability: standard"
        " deviation of all values (JJF 1535-2015, 3.2; IEEE Std 528); day, mounting, switch_on:"
        " what values that share one have in common, beyond within; with + what the calibrations do"
        " not tell apart; power_cycle: between the switch-ons of this campaign, beside the noise;"
        " stability: of means over 10 s in the longest rest of this campaign (JJF 1535-2015, 3.3)",
    ),
    integer("calibrations", "values, one for each calibration and mount"),
    integer("groups", "days, mountings or switch-ons; of stability: means"),
    optional_number("value", "as unit", "standard deviation"),
    optional_number(
        "sigma", "as unit", "its standard deviation; none where 0 is the likeliest value"
    ),
    optional_number("upper", "as unit", "upper limit, one-sided 95 %"),
    sentence("reason", "why there is no value"),
)
JUMPS = table(
    "jumps",
    1,
    SENSOR,
    QUANTITY,
    UNIT,
    text("after", "date of the last calibration before the jump"),
    text("after_campaign", "its campaign"),
    text("until", "date of the first calibration after the jump"),
    text("until_campaign", "its campaign"),
    number("size", "as unit", "by how much the level changed, beside a drift"),
    number("sigma", "as unit", "its standard deviation"),
    number(
        "p_value",
        "1",
        "chance of such a jump of any parameter at any date in histories that have none",
    ),
    sentence("sentence", "the jump in words"),
)
CHANGES = table(
    "changes",
    1,
    SENSOR,
    QUANTITY,
    UNIT,
    text("since", "date of the calibration before"),
    text("since_campaign", "its campaign"),
    number("size", "as unit", "this calibration less the one before"),
    number(
        "sigma",
        "as unit",
        "its standard deviation, without the errors of references that both share",
    ),
    number("p_value", "1", "chance of a change so large, either way, if there is none"),
    truth("beyond", "whether it is more than chance, of all parameters (Holm 1979)"),
)
FORECAST = table(
    "forecast",
    1,
    SENSOR,
    QUANTITY,
    UNIT,
    integer("calibrations", "values of known date"),
    optional_text("from_date", "date of the first"),
    optional_text("to_date", "date of the last"),
    optional_number("drift", "unit per year", "by weighted regression"),
    optional_number(
        "drift_sigma", "unit per year", "its standard deviation, with what the days differ by"
    ),
    optional_text("at", "date of the next, after the usual interval"),
    optional_number("low", "as unit", "lower limit of its 95 % interval"),
    optional_number("median", "as unit", "median of what it may find"),
    optional_number("high", "as unit", "upper limit of its 95 % interval"),
    optional_number("tolerance", "as unit", "for a change, by campaign or config.yaml"),
    optional_text("due", "date from which the 95 % interval leaves the last value ± tolerance"),
    sentence("reason", "why there is no prediction, or no due date"),
)

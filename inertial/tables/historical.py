"""How well calibrations of one IMU repeat, jumps between them, and what the next may be."""

from inertial.tables.table import (
    DOUBLE,
    INTEGER,
    QUANTITY,
    SENSOR,
    SENTENCE,
    TEXT,
    TRUTH,
    Column,
    Table,
    optional,
)

UNIT = Column("unit", TEXT, "", "unit of the parameter, SI")

REPEATABILITY = Table(
    "repeatability",
    1,
    (
        SENSOR,
        QUANTITY,
        UNIT,
        Column(
            "component",
            TEXT,
            "",
            "within: rms of the calibrations' sigmas, shared errors out; repeatability: standard"
            " deviation of all values (JJF 1535-2015, 3.2; IEEE Std 528); day, mounting, switch_on:"
            " what values that share one have in common, beyond within; with + what the"
            " calibrations do not tell apart; power_cycle: between the switch-ons of this campaign,"
            " beside the noise; stability: of means over 10 s in the longest rest of"
            " this campaign (JJF 1535-2015, 3.3)",
        ),
        Column("calibrations", INTEGER, "1", "values, one for each calibration and mount"),
        Column("groups", INTEGER, "1", "days, mountings or switch-ons; of stability: means"),
        optional("value", DOUBLE, "as unit", "standard deviation"),
        optional(
            "sigma",
            DOUBLE,
            "as unit",
            "its standard deviation; none where 0 is the likeliest value",
        ),
        optional("upper", DOUBLE, "as unit", "upper limit, one-sided 95 %"),
        Column("reason", SENTENCE, "", "why there is no value"),
    ),
)
JUMPS = Table(
    "jumps",
    1,
    (
        SENSOR,
        QUANTITY,
        UNIT,
        Column("after", TEXT, "", "date of the last calibration before the jump"),
        Column("after_campaign", TEXT, "", "its campaign"),
        Column("until", TEXT, "", "date of the first calibration after the jump"),
        Column("until_campaign", TEXT, "", "its campaign"),
        Column("size", DOUBLE, "as unit", "by how much the level changed, beside a drift"),
        Column("sigma", DOUBLE, "as unit", "its standard deviation"),
        Column(
            "p_value",
            DOUBLE,
            "1",
            "chance of such a jump of any parameter at any date in histories that have none",
        ),
        Column("sentence", SENTENCE, "", "the jump in words"),
    ),
)
CHANGES = Table(
    "changes",
    1,
    (
        SENSOR,
        QUANTITY,
        UNIT,
        Column("since", TEXT, "", "date of the calibration before"),
        Column("since_campaign", TEXT, "", "its campaign"),
        Column("size", DOUBLE, "as unit", "this calibration less the one before"),
        Column(
            "sigma",
            DOUBLE,
            "as unit",
            "its standard deviation, without the errors of references that both share",
        ),
        Column("p_value", DOUBLE, "1", "chance of a change so large, either way, if there is none"),
        Column(
            "beyond", TRUTH, "", "whether it is more than chance, of all parameters (Holm 1979)"
        ),
    ),
)
FORECAST = Table(
    "forecast",
    1,
    (
        SENSOR,
        QUANTITY,
        UNIT,
        Column("calibrations", INTEGER, "1", "values of known date"),
        optional("from_date", TEXT, "", "date of the first"),
        optional("to_date", TEXT, "", "date of the last"),
        optional("drift", DOUBLE, "unit per year", "by weighted regression"),
        optional(
            "drift_sigma",
            DOUBLE,
            "unit per year",
            "its standard deviation, with what the days differ by",
        ),
        optional("at", TEXT, "", "date of the next, after the usual interval"),
        optional("low", DOUBLE, "as unit", "lower limit of its 95 % interval"),
        optional("median", DOUBLE, "as unit", "median of what it may find"),
        optional("high", DOUBLE, "as unit", "upper limit of its 95 % interval"),
        optional("tolerance", DOUBLE, "as unit", "for a change, by campaign or config.yaml"),
        optional(
            "due", TEXT, "", "date from which the 95 % interval leaves the last value ± tolerance"
        ),
        Column("reason", SENTENCE, "", "why there is no prediction, or no due date"),
    ),
)

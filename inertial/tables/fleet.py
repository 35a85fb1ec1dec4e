"""What several campaigns show together: effects and what shares them, populations of types."""

from inertial.tables.table import (
    SENSOR,
    integer,
    number,
    optional_integer,
    optional_number,
    optional_text,
    sentence,
    table,
    text,
    truth,
)

FINDING = text("finding", "id of the finding")
LEVELS = "type, table, imu or campaign; with + what the campaigns do not tell apart"
TYPE = text("instrument", "name of the IMU's type")
PARAMETER = (TYPE, SENSOR, text("parameter", "name of the parameter, such as bias_x"))

FLEET = {
    each.name: each
    for each in (
        table(
            "campaigns",
            1,
            text("campaign", "name of the campaign's folder"),
            text("mount", "of the plan; empty where there is a single one"),
            text("type", "name of the IMU's type"),
            text("imu", "serial number; of unknown ones the campaign"),
            text("table", "name of the table; without a name the campaign"),
            truth("pooled", "whether it is in the numbers"),
            text("reason", "why it is not"),
        ),
        table(
            "findings",
            3,
            FINDING,
            text("effect", "name in the catalogue"),
            text("level", "what shares it: type, table, imu or campaign"),
            optional_text(
                "group",
                "the type, table, IMU or campaign; none: each has a size of its own, or tables"
                " differ, see table_differences",
            ),
            optional_number(
                "statistic",
                "1",
                "reduction of chi-squared beside the others; none: tables differ, and p is averaged"
                " over the changes between campaigns that are possible",
            ),
            optional_integer("degrees", "degrees of freedom of the statistic"),
            number("p_value", "1", "by noise alone, the search accounted for"),
            optional_integer(
                "named_by", "campaigns that name the effect by themselves; none: tables differ"
            ),
            optional_integer("asked", "campaigns in which it is sought, of those that share it"),
        ),
        table(
            "members",
            1,
            FINDING,
            text("effect", "an effect that it may be, whatever shares it"),
            number("probability", "1", "posterior probability"),
        ),
        table(
            "sharings",
            1,
            FINDING,
            text("level", "type, table, imu or campaign"),
            number("probability", "1", "that this shares the effect, posterior"),
            truth("possible", "one of the most probable, of 95 % together"),
        ),
        table(
            "shares",
            1,
            text("effect", "name in the catalogue"),
            text("levels", LEVELS),
            number("share", "1", "of the mean square of the effect"),
            number("sigma", "1", "its standard deviation"),
        ),
        table(
            "sizes",
            1,
            FINDING,
            text("group", "the type, table, IMU or campaign"),
            text("parameter", "name within the effect"),
            number("value", "as unit", "estimate, all findings fitted together"),
            number("sigma", "as unit", "its standard deviation"),
            text("unit", "unit of value and sigma, SI"),
        ),
        table(
            "table_differences",
            1,
            FINDING,
            SENSOR,
            sentence("more", "tables on which all axes of all IMUs read more"),
            sentence("less", "tables on which they read less"),
            number("value", "1", "by how much, of all scale factors alike"),
            number("sigma", "1", "its standard deviation, turn-on to turn-on in it"),
            optional_number(
                "stated",
                "1",
                "standard deviation of a difference of two such tables by what the campaigns"
                " state; none: not stated",
            ),
            integer("imus", "IMUs that were on both sides"),
            integer("axes", "axes that show it"),
        ),
        table(
            "tables_alike",
            1,
            SENSOR,
            sentence("more", "tables on which all axes of all IMUs read more, if they differ"),
            sentence("less", "tables on which they would read less"),
            number("value", "1", "by how much, of all scale factors alike; no finding"),
            number("sigma", "1", "its standard deviation, turn-on to turn-on in it"),
            number("p_value", "1", "by noise and changes alone, the search accounted for"),
            truth(
                "as_well", "whether changes that all axes of an IMU have in common explain it too"
            ),
            number("change", "1", "standard deviation of a scale factor from turn-on to turn-on"),
        ),
        table(
            "outlying_changes",
            1,
            SENSOR,
            text("imu", "serial number"),
            text("axis", "x, y or z"),
            text("campaign", "in which the scale factor differs"),
            sentence(
                "others",
                "campaigns of the IMU from which it differs; of a single one nothing tells which"
                " of the two is off",
            ),
            number("value", "1", "by how much the scale factor is larger, tables' errors apart"),
            number("sigma", "1", "its standard deviation"),
            number("p_value", "1", "of any scale factor of the sensor, by noise and changes"),
        ),
        table(
            "population",
            3,
            *PARAMETER,
            integer("imus", "IMUs with a value, without outliers"),
            text("unit", "unit of the values, SI"),
            number("mean", "as unit", "of the type"),
            number(
                "mean_sigma",
                "as unit",
                "of the Student's t that has the 68 % and 95 % intervals of the mean, averaged"
                " over the spreads between tables that are possible; with one table its part is"
                " in the mean and not in sigma",
            ),
            optional_number(
                "mean_degrees",
                "1",
                "degrees of freedom of mean_sigma, for Student's t; none: on one table the"
                " differences are no larger than the sigmas, or how well they are known is not"
                " determined",
            ),
            optional_number(
                "prior_sigma",
                "as unit",
                "standard deviation of a new IMU of the type about the mean, in one campaign on"
                " one table, beside the sigma of that campaign; none: of a single IMU",
            ),
            optional_number(
                "prior_degrees",
                "1",
                "degrees of freedom of prior_sigma, for Student's t; none: of a single IMU, or"
                " the differences are no larger than the sigmas",
            ),
        ),
        table(
            "spreads",
            1,
            *PARAMETER,
            text("levels", LEVELS),
            integer("groups", "number of tables, IMUs or campaigns"),
            number("value", "as unit", "standard deviation, by restricted likelihood"),
            optional_number(
                "sigma", "as unit", "its standard deviation; none where 0 is the likeliest value"
            ),
            text("unit", "unit of the values, SI"),
        ),
        table(
            "correlations",
            1,
            TYPE,
            text("first", "sensor and parameter"),
            text("second", "sensor and parameter"),
            number("correlation", "1", "between the IMUs of the type"),
            number("sigma", "1", "its standard deviation"),
            number("p_value", "1", "if there is none, by Fisher's z"),
        ),
        table(
            "outliers",
            1,
            *PARAMETER,
            text("imu", "serial number; in no number of the population"),
            number("size", "1", "by how much it differs from the others, in sigmas"),
            number("p_value", "1", "of any IMU and parameter of the type"),
        ),
    )
}

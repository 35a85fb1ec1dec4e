"""What several campaigns show together: effects and what shares them, populations of types."""

from inertial.tables.table import (
    DOUBLE,
    INTEGER,
    SENSOR,
    SENTENCE,
    TEXT,
    TRUTH,
    Column,
    Table,
    optional,
)

FINDING = Column("finding", TEXT, "", "id of the finding")
LEVELS = "type, table, imu or campaign; with + what the campaigns do not tell apart"
TYPE = Column("instrument", TEXT, "", "name of the IMU's type")
PARAMETER = (TYPE, SENSOR, Column("parameter", TEXT, "", "name of the parameter, such as bias_x"))

FLEET = {
    table.name: table
    for table in (
        Table(
            "campaigns",
            1,
            (
                Column("campaign", TEXT, "", "name of the campaign's folder"),
                Column("mount", TEXT, "", "of the plan; empty where there is a single one"),
                Column("type", TEXT, "", "name of the IMU's type"),
                Column("imu", TEXT, "", "serial number; of unknown ones the campaign"),
                Column("table", TEXT, "", "name of the table; without a name the campaign"),
                Column("pooled", TRUTH, "", "whether it is in the numbers"),
                Column("reason", TEXT, "", "why it is not"),
            ),
        ),
        Table(
            "findings",
            2,
            (
                FINDING,
                Column("effect", TEXT, "", "name in the catalogue"),
                Column("level", TEXT, "", "what shares it: type, table, imu or campaign"),
                optional(
                    "group",
                    TEXT,
                    "",
                    "the type, table, IMU or campaign; none: each has a size of its own, or tables"
                    " differ, see table_differences",
                ),
                Column("statistic", DOUBLE, "1", "reduction of chi-squared beside the others"),
                Column("degrees", INTEGER, "1", "degrees of freedom of the statistic"),
                Column("p_value", DOUBLE, "1", "by noise alone, the search accounted for"),
            ),
        ),
        Table(
            "members",
            1,
            (
                FINDING,
                Column("effect", TEXT, "", "an effect that it may be, whatever shares it"),
                Column("probability", DOUBLE, "1", "posterior probability"),
            ),
        ),
        Table(
            "sharings",
            1,
            (
                FINDING,
                Column("level", TEXT, "", "type, table, imu or campaign"),
                Column("probability", DOUBLE, "1", "that this shares the effect, posterior"),
                Column("possible", TRUTH, "", "one of the most probable, of 95 % together"),
            ),
        ),
        Table(
            "shares",
            1,
            (
                Column("effect", TEXT, "", "name in the catalogue"),
                Column("levels", TEXT, "", LEVELS),
                Column("share", DOUBLE, "1", "of the mean square of the effect"),
                Column("sigma", DOUBLE, "1", "its standard deviation"),
            ),
        ),
        Table(
            "sizes",
            1,
            (
                FINDING,
                Column("group", TEXT, "", "the type, table, IMU or campaign"),
                Column("parameter", TEXT, "", "name within the effect"),
                Column("value", DOUBLE, "as unit", "estimate, all findings fitted together"),
                Column("sigma", DOUBLE, "as unit", "its standard deviation"),
                Column("unit", TEXT, "", "unit of value and sigma, SI"),
            ),
        ),
        Table(
            "table_differences",
            1,
            (
                FINDING,
                SENSOR,
                Column("more", SENTENCE, "", "tables on which all axes of all IMUs read more"),
                Column("less", SENTENCE, "", "tables on which they read less"),
                Column("value", DOUBLE, "1", "by how much, of all scale factors alike"),
                Column("sigma", DOUBLE, "1", "its standard deviation, turn-on to turn-on in it"),
                optional(
                    "stated",
                    DOUBLE,
                    "1",
                    "standard deviation of a difference of two such tables by what the campaigns"
                    " state; none: not stated",
                ),
                Column("imus", INTEGER, "1", "IMUs that were on both sides"),
                Column("axes", INTEGER, "1", "axes that show it"),
            ),
        ),
        Table(
            "population",
            3,
            (
                *PARAMETER,
                Column("imus", INTEGER, "1", "IMUs with a value, without outliers"),
                Column("unit", TEXT, "", "unit of the values, SI"),
                Column("mean", DOUBLE, "as unit", "of the type"),
                Column(
                    "mean_sigma",
                    DOUBLE,
                    "as unit",
                    "of the Student's t that has the 68 % and 95 % intervals of the mean, averaged"
                    " over the spreads between tables that are possible; with one table its part is"
                    " in the mean and not in sigma",
                ),
                optional(
                    "mean_degrees",
                    DOUBLE,
                    "1",
                    "degrees of freedom of mean_sigma, for Student's t; none: on one table the"
                    " differences are no larger than the sigmas, or how well they are known is not"
                    " determined",
                ),
                optional(
                    "prior_sigma",
                    DOUBLE,
                    "as unit",
                    "standard deviation of a new IMU of the type about the mean, in one campaign on"
                    " one table, beside the sigma of that campaign; none: of a single IMU",
                ),
                optional(
                    "prior_degrees",
                    DOUBLE,
                    "1",
                    "degrees of freedom of prior_sigma, for Student's t; none: of a single IMU, or"
                    " the differences are no larger than the sigmas",
                ),
            ),
        ),
        Table(
            "spreads",
            1,
            (
                *PARAMETER,
                Column("levels", TEXT, "", LEVELS),
                Column("groups", INTEGER, "1", "number of tables, IMUs or campaigns"),
                Column("value", DOUBLE, "as unit", "standard deviation, by restricted likelihood"),
                optional(
                    "sigma",
                    DOUBLE,
                    "as unit",
                    "its standard deviation; none where 0 is the likeliest value",
                ),
                Column("unit", TEXT, "", "unit of the values, SI"),
            ),
        ),
        Table(
            "correlations",
            1,
            (
                TYPE,
                Column("first", TEXT, "", "sensor and parameter"),
                Column("second", TEXT, "", "sensor and parameter"),
                Column("correlation", DOUBLE, "1", "between the IMUs of the type"),
                Column("sigma", DOUBLE, "1", "its standard deviation"),
                Column("p_value", DOUBLE, "1", "if there is none, by Fisher's z"),
            ),
        ),
        Table(
            "outliers",
            1,
            (
                *PARAMETER,
                Column("imu", TEXT, "", "serial number; in no number of the population"),
                Column("size", DOUBLE, "1", "by how much it differs from the others, in sigmas"),
                Column("p_value", DOUBLE, "1", "of any IMU and parameter of the type"),
            ),
        ),
    )
}

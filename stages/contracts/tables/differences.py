"""Results held against each other."""

from stages.contracts.parquet import Column, Table
from stages.contracts.tables.shared import DOUBLE, TEXT

DIFFERENCES = Table(
    "differences",
    1,
    (
        Column("id", TEXT, "", "stable identifier: comparison/kind/parameter, and which turns"),
        Column(
            "kind",
            TEXT,
            "",
            "static_against_turns, forward_against_backward, method_against_method, published,"
            " fencepost; with @ and the mount where there are several",
        ),
        Column("parameter", TEXT, "", "stage and parameter, such as gyroscope/bias_x"),
        Column("unit", TEXT, "", "unit of the values, SI"),
        Column("first", TEXT, "", "what is compared: id of a parameter, or in words"),
        Column("second", TEXT, "", "with what: id of a parameter, or in words"),
        Column("first_value", DOUBLE, "as unit", "none where not determined", nullable=True),
        Column("second_value", DOUBLE, "as unit", "none where not determined", nullable=True),
        Column("difference", DOUBLE, "as unit", "first less second", nullable=True),
        Column("sigma", DOUBLE, "as unit", "its sigma; none where not known", nullable=True),
        Column("in_sigmas", DOUBLE, "1", "difference in units of its sigma", nullable=True),
        Column("p_value", DOUBLE, "1", "chance of one so large, either way", nullable=True),
        Column("sentence", TEXT, "", "the difference and the verdict in words"),
    ),
)

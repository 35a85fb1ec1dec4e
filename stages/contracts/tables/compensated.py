"""Samples with the errors taken out, and the checks of them."""

from stages.contracts.parquet import Column, Table
from stages.contracts.tables.shared import DOUBLE, INTEGER, LABEL, TEXT, channels

COMPENSATED = Table(
    "compensated",
    1,
    (
        Column("log", LABEL, "", "as in logs"),
        Column("record", INTEGER, "1", "as in samples"),
        Column("time", DOUBLE, "s", "as in samples", nullable=True),
        *channels("specific force, angular rate, with the errors taken out"),
    ),
)
CHECKS = Table(
    "checks",
    1,
    (
        Column("id", TEXT, "", "stable identifier: compensation/quantity/manoeuvre"),
        Column(
            "manoeuvre",
            TEXT,
            "",
            "as in manoeuvres, with the rest of a turn in brackets",
            nullable=True,
        ),
        Column(
            "quantity",
            TEXT,
            "",
            "gravity: |f|; force_up: f along up; rate_up: rate along up; angle: of a turn about its"
            " axis, the earth's rate taken out; accelerometer, gyro: why one is not compensated",
        ),
        Column("unit", TEXT, "", "unit of the values, SI"),
        Column("expected", DOUBLE, "as unit", "what is known of it", nullable=True),
        Column("expected_sigma", DOUBLE, "as unit", "its standard deviation", nullable=True),
        Column("before", DOUBLE, "as unit", "by the readings", nullable=True),
        Column("after", DOUBLE, "as unit", "by the compensated readings", nullable=True),
        Column(
            "after_sigma",
            DOUBLE,
            "as unit",
            "of after less expected, by noise, angle, position and earth rate; without what all"
            " manoeuvres share and the parameters have taken up, as the sigma of gravity",
            nullable=True,
        ),
        Column("in_sigmas_after", DOUBLE, "1", "after less expected, in sigmas", nullable=True),
        Column("sentence", TEXT, "", "the check in words"),
    ),
)

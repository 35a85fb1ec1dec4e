"""Noise, parameters, covariance, fits and positions."""

from stages.contracts.parquet import Column, Table
from stages.contracts.tables.shared import BODY, DOUBLE, INTEGER, TEXT

NOISE = Table(
    "noise",
    1,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("phase", TEXT, "", "rest or steady"),
        Column("channel", TEXT, "", "one of the six channels"),
        Column("white_noise", DOUBLE, "rad/√s, m/s/√s", "random walk: root of the power density"),
        Column("sigma", DOUBLE, "rad/√s, m/s/√s", "standard deviation of white_noise"),
        Column("per_sample", DOUBLE, "rad/s, m/s²", "standard deviation of the samples"),
        Column("samples", INTEGER, "1", "number of samples"),
        Column("data_sheet", DOUBLE, "rad/√s, m/s/√s", "the data sheet's figure", nullable=True),
    ),
)
PARAMETERS = Table(
    "parameters",
    1,
    (
        Column("id", TEXT, "", "stable identifier: stage/method/parameter"),
        Column("stage", TEXT, "", "stage that estimated it"),
        Column("method", TEXT, "", "method of estimation"),
        Column("parameter", TEXT, "", "name within the method"),
        Column(
            "value", DOUBLE, "as unit", "estimate; none where it is not determined", nullable=True
        ),
        Column("sigma", DOUBLE, "as unit", "its standard deviation", nullable=True),
        Column("unit", TEXT, "", "unit of value and sigma"),
        Column("frame", TEXT, "", "frame it is expressed in"),
        Column("meaning", TEXT, "", "what it is, in words"),
        Column("reason", TEXT, "", "why it is not determined, and the manoeuvre that would help"),
    ),
)
COVARIANCE = Table(
    "covariance",
    1,
    (
        Column("first", TEXT, "", "id of a parameter"),
        Column("second", TEXT, "", "id of a parameter"),
        Column("covariance", DOUBLE, "product of the units", "of the two estimates"),
    ),
)
FIT = Table(
    "fit",
    2,
    (
        Column("method", TEXT, "", "method of estimation"),
        Column(
            "chi_squared",
            DOUBLE,
            "1",
            "weighted sum of squared residuals, the scatter allowed for",
        ),
        Column("degrees", INTEGER, "1", "degrees of freedom"),
        Column("p_value", DOUBLE, "1", "chance of residuals this large by noise alone"),
        Column(
            "scatter", DOUBLE, "as unit", "what manoeuvres differ by beyond noise; 0 where p ≥ 1 %"
        ),
        Column("unit", TEXT, "", "unit of the scatter"),
        Column("used", TEXT, "", "the manoeuvres that were used"),
        Column("left_out", TEXT, "", "the manoeuvres that were not, each with the reason"),
        Column(
            "random_walk", DOUBLE, "unit/√s", "of the bias, which is that of the middle; 0: none"
        ),
        Column("random_walk_sigma", DOUBLE, "unit/√s", "its standard deviation", nullable=True),
    ),
)
POSITIONS = Table(
    "positions",
    1,
    (
        Column("method", TEXT, "", "method of estimation"),
        Column("position", TEXT, "", "set position"),
        Column("quantity", TEXT, "", "tilt 0, tilt 1; level 0, level 1: part of the earth's rate"),
        Column("value", DOUBLE, "as unit", "estimate, about or along the level axis 0 or 1", BODY),
        Column("sigma", DOUBLE, "as unit", "its standard deviation"),
        Column("unit", TEXT, "", "unit of value and sigma"),
    ),
)
AVERAGING = Table(
    "averaging",
    1,
    (
        Column("parameter", TEXT, "", "id of a parameter"),
        Column("seconds", DOUBLE, "s", "length of each rest that was used, from its start"),
        Column("value", DOUBLE, "as the parameter", "estimate from these"),
        Column("sigma", DOUBLE, "as the parameter", "its standard deviation"),
    ),
)
WANTED = Table(
    "wanted",
    1,
    (
        Column("parameter", TEXT, "", "id of a bias by one of S0's formulas"),
        Column("seconds", DOUBLE, "s", "length of each rest that was recorded"),
        Column("sigma", DOUBLE, "as the parameter", "standard deviation of the bias by these"),
        Column("floor", DOUBLE, "as the parameter", "what of it no time averages out"),
        Column("random_walk", DOUBLE, "parameter·√s", "white noise of the bias, √s of a rest"),
        Column("wanted", DOUBLE, "as the parameter", "sigma that is wanted"),
        Column(
            "wanted_seconds",
            DOUBLE,
            "s",
            "for it; none where the floor is above it",
            nullable=True,
        ),
    ),
)

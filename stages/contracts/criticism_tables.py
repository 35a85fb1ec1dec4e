"""What the tables of criticism beside scores and findings hold: random walks, and structures."""

import pyarrow as pa

from stages.contracts.parquet import Column, Table

_text, _double, _integer, _truth = pa.string(), pa.float64(), pa.int64(), pa.bool_()

WALKS = Table(
    "walks",
    1,
    (
        Column("method", _text, "", "joint, with @ and the mount where there are several"),
        Column("sensor", _text, "", "gyro or accel"),
        Column("walk", _double, "SI/√s", "random walk of the biases beside the named effects"),
        Column("sigma", _double, "SI/√s", "its standard deviation; none: not known", nullable=True),
    ),
)
STRUCTURES = Table(
    "structures",
    1,
    (
        Column("method", _text, "", "joint, with @ and the mount where there are several"),
        Column("kind", _text, "", "time, angle, rate, attitude, temperature or change"),
        Column("channel", _text, "", "where it is clearest: sensor and axis; empty: none asked"),
        Column("place", _double, "", "s of a change, Hz, cycles per turn", nullable=True),
        Column("statistic", _double, "1", "drop of chi-squared with the functions of the test"),
        Column("degrees", _integer, "1", "of freedom of the drop"),
        Column("p_value", _double, "1", "after the search over channels and what is scanned"),
        Column("fires", _truth, "", "below the level that all six share"),
    ),
)
STRUCTURE_POINTS = Table(
    "structure_points",
    1,
    (
        Column("method", _text, "", "as in structures"),
        Column("kind", _text, "", "as in structures"),
        Column("channel", _text, "", "as in structures"),
        Column("x", _double, "as x_unit", "what the readings are a function of, mean of a bin"),
        Column("x_unit", _text, "", "unit of x"),
        Column("left", _double, "as unit", "what the model leaves there, all else as fitted"),
        Column("sigma", _double, "as unit", "its standard deviation"),
        Column("structure", _double, "as unit", "what the structure would be there"),
        Column("unit", _text, "", "rad/s or m/s²"),
    ),
)

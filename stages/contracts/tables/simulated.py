"""What should have been recorded."""

from stages.contracts.parquet import Column, Table
from stages.contracts.tables.shared import DOUBLE, INTEGER, LOG, PHASES, TEXT, channels

SIMULATED = Table(
    "simulated",
    1,
    (
        Column("manoeuvre", TEXT, "", "a whole turn, or a rest in blocks"),
        Column("phase", TEXT, "", PHASES),
        LOG,
        Column("record", INTEGER, "1", "record of the log; of a block the first"),
        Column("time", DOUBLE, "s", "time of the record, or middle of the block", nullable=True),
        *channels("what the IMU should have read"),
        *channels("read less simulated", prefix="residual_"),
    ),
)
FIDELITY = Table(
    "fidelity",
    1,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("channel", TEXT, "", "one of the six channels"),
        Column("profile", TEXT, "", "trapezoid; as the gyros have it; or at rest"),
        Column("residual_rms", DOUBLE, "rad/s, m/s²", "root mean square of the residuals"),
        Column("noise_rms", DOUBLE, "rad/s, m/s²", "what white noise alone would give"),
        Column("samples", INTEGER, "1", "number of samples, or of blocks of a rest"),
    ),
)

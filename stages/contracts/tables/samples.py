"""Samples, the account of every byte, and the clocks."""

import pyarrow as pa

from stages.contracts.parquet import Column, Table
from stages.contracts.tables.shared import DOUBLE, INTEGER, LABEL, LOG, TEXT, channels

SAMPLES = Table(
    "samples",
    1,
    (
        Column("log", LABEL, "", "as in logs"),
        Column("record", INTEGER, "1", "number of the record in its log, refused ones counted"),
        Column("offset", INTEGER, "byte", "where its line begins in the file"),
        Column("line", INTEGER, "1", "number of its line, from 1"),
        Column("time", DOUBLE, "s", "since the start of its clock", nullable=True),
        Column("status", pa.uint32(), "", "status word of the instrument", nullable=True),
        Column(
            "mean_of",
            DOUBLE,
            "1",
            "number of samples that this record is the mean of",
            nullable=True,
        ),
        *channels("specific force, angular rate"),
        Column("table_angle", DOUBLE, "rad", "as the table's encoder gives it", nullable=True),
        Column("temperature", DOUBLE, "K", "of the instrument", nullable=True),
        Column("label", LABEL, "", "label that the plan selects by", nullable=True),
    ),
)
REFUSED = Table(
    "refused",
    1,
    (
        LOG,
        Column("line", INTEGER, "1", "number of the line, from 1"),
        Column("offset", INTEGER, "byte", "where the line begins in the file"),
        Column("bytes", INTEGER, "byte", "its length with its line end"),
        Column("reason", TEXT, "", "what was found and what was expected"),
        Column("text", TEXT, "", "its beginning"),
    ),
)
ACCOUNTS = Table(
    "accounts",
    1,
    (
        LOG,
        Column("kind", TEXT, "", "decoded, other message, header, blank, not selected, refused"),
        Column("name", TEXT, "", "name of the message, where it has one"),
        Column("lines", INTEGER, "1", "number of lines"),
        Column("bytes", INTEGER, "byte", "their bytes; all rows of a log add up to its size"),
    ),
)
CLOCKS = Table(
    "clocks",
    2,
    (
        LOG,
        Column(
            "clock", TEXT, "", "GPS: shared by the logs; own: each log from its first sample; none"
        ),
        Column("epoch_gps", DOUBLE, "s", "GPS time at time 0", nullable=True),
        Column("recorded_on", TEXT, "", "UTC date of the first sample", nullable=True),
        Column("from_s", DOUBLE, "s", "time of the first sample", nullable=True),
        Column("to_s", DOUBLE, "s", "time of the last sample", nullable=True),
        Column("records", INTEGER, "1", "number of decoded records"),
        Column("interval", DOUBLE, "s", "median sample interval", nullable=True),
        Column("step", DOUBLE, "s", "what a sample counts for in a sum over time", nullable=True),
        Column(
            "imu_types",
            TEXT,
            "",
            "types of IMU that its messages tell, by NovAtel's list",
            nullable=True,
        ),
    ),
)

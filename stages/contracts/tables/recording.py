"""What is wrong with a recording, and its parts: findings, masks, segments, blocks."""

from stages.contracts.parquet import Column, Table
from stages.contracts.tables.shared import (
    BODY,
    DOUBLE,
    INTEGER,
    LOG,
    PHASES,
    RECORDS,
    TEXT,
    TRUTH,
    channels,
)

FINDINGS = Table(
    "findings",
    1,
    (
        Column("id", TEXT, "", "stable identifier: stage/cause/place"),
        Column("cause", TEXT, "", "what it is"),
        Column("sensor", TEXT, "", "accel or gyro, where one is concerned", nullable=True),
        Column("axis", TEXT, "", "x, y or z, where one is concerned", nullable=True),
        Column("log", TEXT, "", "as in logs", nullable=True),
        Column("manoeuvre", TEXT, "", "as in manoeuvres", nullable=True),
        Column("from_s", DOUBLE, "s", "from, in the time of the log", nullable=True),
        Column("to_s", DOUBLE, "s", "to, in the time of the log", nullable=True),
        Column("count", INTEGER, "1", "how many equal ones this stands for"),
        Column("size", DOUBLE, "as unit", "how large", nullable=True),
        Column("unit", TEXT, "", "unit of size"),
        Column("p_value", DOUBLE, "1", "chance of such a size if nothing is wrong", nullable=True),
        Column("severity", INTEGER, "", "3 spoils a result, 2 weakens it, 1 is good to know"),
        Column("consequence", TEXT, "", "what it does to the result"),
        Column("action", TEXT, "", "what the pipeline did, or what the laboratory should do"),
        Column("sentence", TEXT, "", "the finding in words"),
    ),
)
MASKS = Table(
    "masks",
    2,
    (
        LOG,
        *RECORDS,
        Column("channel", TEXT, "", "the one channel that is masked, else all", nullable=True),
        Column("repeated", TRUTH, "", "they repeat other records: no time passes with them"),
        Column("finding", TEXT, "", "id of the finding that masks these records"),
    ),
)
CLOSE_UPS = Table(
    "close_ups",
    1,
    (
        Column("finding", TEXT, "", "id of the finding that these records show"),
        LOG,
        Column("record", INTEGER, "1", "number of the record in its log"),
        Column("line", INTEGER, "1", "number of its line, from 1"),
        Column("time", DOUBLE, "s", "as in samples", nullable=True),
        *channels("as in samples"),
        Column("concerned", TRUTH, "", "it lies in the stretch that the finding is about"),
    ),
)
GAPS = Table(
    "gaps",
    1,
    (
        LOG,
        Column("record", INTEGER, "1", "first record after the gap"),
        Column("from_s", DOUBLE, "s", "time of the record before the gap"),
        Column("to_s", DOUBLE, "s", "time of the record after the gap"),
        Column("missing", INTEGER, "1", "number of samples that are missing"),
    ),
)
SEGMENTS = Table(
    "segments",
    1,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("phase", TEXT, "", PHASES),
        LOG,
        *RECORDS,
        Column("from_s", DOUBLE, "s", "time of its first record", nullable=True),
        Column("to_s", DOUBLE, "s", "time of its last record", nullable=True),
    ),
)
PERFORMED = Table(
    "performed",
    2,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("found", TRUTH, "", "found in its log"),
        Column("complete", TRUTH, "", "recorded from rest to rest without a gap, as planned"),
        Column(
            "bridged",
            TRUTH,
            "",
            "not complete, but what is missing lies in the steady part, so the joint estimate can"
            " bridge it; in a ramp, or by hand, only a few masked samples",
        ),
        Column("angle", DOUBLE, "rad", "angle that was recorded, about `about`", BODY, True),
        Column(
            "missing_angle", DOUBLE, "rad", "angle that was planned but not recorded", BODY, True
        ),
        Column("missing_s", DOUBLE, "s", "time that is lost or masked while it turns"),
        Column("rate", DOUBLE, "rad/s", "mean rate of the steady part, about `about`", BODY, True),
        Column("seconds", DOUBLE, "s", "duration of the rest, or from start to stop of the turn"),
        Column("sentence", TEXT, "", "what was recorded of it, in words"),
    ),
)
BLOCKS = Table(
    "blocks",
    2,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("phase", TEXT, "", PHASES),
        LOG,
        *RECORDS,
        Column("time", DOUBLE, "s", "middle of the block", nullable=True),
        Column("seconds", DOUBLE, "s", "count × step: mean × seconds is a sum", nullable=True),
        Column("count", DOUBLE, "1", "number of samples in the means"),
        Column(
            "missing_s",
            DOUBLE,
            "s",
            "of a turn: time before it, since the block before, that is lost or masked; else 0",
        ),
        *channels("mean"),
        Column("table_angle", DOUBLE, "rad", "mean angle of the table", nullable=True),
        Column("temperature", DOUBLE, "K", "mean temperature", nullable=True),
        Column("mask_share", DOUBLE, "1", "share of its records that are masked"),
    ),
)
TRACES = Table(
    "traces",
    1,
    (
        LOG,
        *RECORDS,
        Column("from_s", DOUBLE, "s", "time of the first record", nullable=True),
        Column("to_s", DOUBLE, "s", "time of the last record", nullable=True),
        *channels("smallest", prefix="least_"),
        *channels("largest", prefix="most_"),
    ),
)

"""What was recorded: samples, clocks, findings, masks, segments, blocks."""

from inertial.tables.table import (
    AS_CHANNEL,
    AXIS,
    BODY,
    DOUBLE,
    INTEGER,
    LABEL,
    LOG,
    PHASES,
    RECORDS,
    SENSOR,
    SENTENCE,
    TEXT,
    TRUTH,
    WORD,
    Column,
    Table,
    channels,
)
from inertial.text.parameters import AXES

SAMPLES = Table(
    "samples",
    1,
    (
        Column("log", LABEL, "", "as in logs"),
        Column("record", INTEGER, "1", "number of the record in its log, refused ones counted"),
        Column("offset", INTEGER, "byte", "where its line begins in the file"),
        Column("line", INTEGER, "1", "number of its line, from 1"),
        Column("time", DOUBLE, "s", "since the start of its clock", nullable=True),
        Column("status", WORD, "", "status word of the instrument", nullable=True),
        Column(
            "mean_of",
            DOUBLE,
            "1",
            "number of samples that this record is the mean of",
            nullable=True,
        ),
        *channels("specific force, angular rate"),
        Column(
            "table_angle",
            DOUBLE,
            "rad",
            "as the table's encoder gives it, continuous over turns",
            nullable=True,
        ),
        Column("temperature", DOUBLE, "K", "of the instrument", nullable=True),
        Column("label", LABEL, "", "label that the plan selects by", nullable=True),
    ),
)
MEAN_SIGMAS = Table(
    "mean_sigmas",
    1,
    (
        LOG,
        Column("record", INTEGER, "1", "as in samples, where records are means"),
        SENSOR,
        AXIS,
        Column("sigma", DOUBLE, AS_CHANNEL, "standard deviation of the mean, as the log states it"),
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
        Column("reason", SENTENCE, "", "what was found and what was expected"),
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
    6,
    (
        LOG,
        Column(
            "clock", TEXT, "", "GPS: shared by the logs; own: each log from its first sample; none"
        ),
        Column("epoch_gps", DOUBLE, "s", "GPS time at time 0", nullable=True),
        Column("began", DOUBLE, "s", "stamp of a clock of its own at time 0", nullable=True),
        Column("recorded_on", TEXT, "", "UTC date of the first sample", nullable=True),
        Column("from_s", DOUBLE, "s", "time of the first sample", nullable=True),
        Column("to_s", DOUBLE, "s", "time of the last sample", nullable=True),
        Column("records", INTEGER, "1", "number of decoded records"),
        Column("to_record", INTEGER, "1", "number after that of the last decoded record, else 0"),
        Column("interval", DOUBLE, "s", "median sample interval", nullable=True),
        Column(
            "integration_step",
            DOUBLE,
            "s",
            "mean sample interval: what a sample counts for in a sum over time",
            nullable=True,
        ),
        Column(
            "interval_sigma",
            DOUBLE,
            "s",
            "standard deviation of the interval of the regular clock; null: stamps are used",
            nullable=True,
        ),
        Column(
            "stamp_scatter",
            DOUBLE,
            "s",
            "rms of the stamps about the regular clock that is used instead; null: they are used",
            nullable=True,
        ),
        Column(
            "shortest_gap",
            DOUBLE,
            "s",
            "shortest gap that stamps which scatter show",
            nullable=True,
        ),
    ),
)
IMU_TYPES = Table(
    "imu_types",
    1,
    (
        LOG,
        Column("imu_type", INTEGER, "", "a type of IMU in its messages, by NovAtel's list"),
    ),
)
CHANNEL_STATISTICS = Table(
    "channel_statistics",
    2,
    (
        LOG,
        SENSOR,
        AXIS,
        Column("resolution", DOUBLE, AS_CHANNEL, "smallest step of its readings", nullable=True),
        Column(
            "noise",
            DOUBLE,
            AS_CHANNEL,
            "scatter of a reading about its neighbours, 1.4826/√2 × median of the absolute steps",
            nullable=True,
        ),
        Column("unchanged_share", DOUBLE, "1", "share of readings equal to the one before"),
        Column(
            "held_share",
            DOUBLE,
            "1",
            "share of records in which the sensor repeats its readings, if all the time; else 0",
        ),
        Column("smallest", DOUBLE, AS_CHANNEL, "smallest reading", BODY, nullable=True),
        Column("largest", DOUBLE, AS_CHANNEL, "largest reading", BODY, nullable=True),
    ),
)


FINDINGS = Table(
    "findings",
    2,
    (
        Column("id", TEXT, "", "stable identifier; no code reads anything from it"),
        Column("cause", TEXT, "", "what it is"),
        Column("mount", TEXT, "", "where there are several and one is concerned; else empty"),
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
        Column("consequence", SENTENCE, "", "what it does to the result"),
        Column("action", SENTENCE, "", "what the pipeline did, or what the laboratory should do"),
        Column("sentence", SENTENCE, "", "the finding in words"),
    ),
)
MASKS = Table(
    "masks",
    4,
    (
        LOG,
        *RECORDS,
        Column("sensor", TEXT, "", "accel or gyro where one channel is masked", nullable=True),
        Column("axis", TEXT, "", "x, y or z where one channel is masked", nullable=True),
        Column("repeated", TRUTH, "", "they repeat other records: no time passes with them"),
        Column(
            "censored",
            TRUTH,
            "",
            "masked for their value, at the end of the range: the mean of those left is biased",
        ),
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
    5,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("found", TRUTH, "", "found in its log"),
        Column(
            "complete",
            TRUTH,
            "",
            "recorded from rest to rest without a gap, as planned, but for a few masked samples",
        ),
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
        Column(
            "missing_s",
            DOUBLE,
            "s",
            "time that is lost or masked while it turns; 0 where it is complete",
        ),
        Column("rate", DOUBLE, "rad/s", "mean rate of the steady part, about `about`", BODY, True),
        Column("seconds", DOUBLE, "s", "duration of the rest, or from start to stop of the turn"),
        Column(
            "lost",
            TRUTH,
            "",
            "not complete, because of a gap or masked records alone: their findings are the cause",
        ),
        *(
            Column(
                f"peak_{axis}",
                DOUBLE,
                "m/s²",
                "last extreme of specific force on the way to it beyond both ends, by the readings;"
                " none where these do not show one",
                BODY,
                True,
            )
            for axis in AXES
        ),
        *(
            Column(
                f"sense_{axis}",
                DOUBLE,
                "1",
                "sense of the last rate about the axis on the way to it, 1 or -1, by the readings;"
                " none where these do not show one",
                BODY,
                True,
            )
            for axis in AXES
        ),
        Column("sentence", SENTENCE, "", "what was recorded of it, in words"),
    ),
)
BLOCKS = Table(
    "blocks",
    3,
    (
        Column("manoeuvre", TEXT, "", "as in manoeuvres"),
        Column("phase", TEXT, "", PHASES),
        LOG,
        *RECORDS,
        Column("time", DOUBLE, "s", "middle of the block", nullable=True),
        Column(
            "seconds",
            DOUBLE,
            "s",
            "count × integration step: mean × seconds is a sum",
            nullable=True,
        ),
        Column("count", DOUBLE, "1", "number of samples in the means"),
        Column(
            "missing_s",
            DOUBLE,
            "s",
            "of a turn: time before it, since the block before, that is lost or masked; else 0",
        ),
        *channels("mean"),
        Column("table_angle", DOUBLE, "rad", "mean angle of the table", nullable=True),
        *(
            Column(
                f"{what}_{edge}",
                DOUBLE,
                unit,
                f"of a turn: {what} of the table by its encoder at the {place} of the block; none"
                " where the encoder is not used",
                nullable=True,
            )
            for what, unit in (("angle", "rad"), ("rate", "rad/s"))
            for edge, place in (("from", "beginning"), ("to", "end"))
        ),
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

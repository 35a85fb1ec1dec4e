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
    optional,
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
        optional("time", DOUBLE, "s", "since the start of its clock"),
        optional("status", WORD, "", "status word of the instrument"),
        optional("mean_of", DOUBLE, "1", "number of samples that this record is the mean of"),
        *channels("specific force, angular rate"),
        optional(
            "table_angle", DOUBLE, "rad", "as the table's encoder gives it, continuous over turns"
        ),
        optional("temperature", DOUBLE, "K", "of the instrument"),
        optional("label", LABEL, "", "label that the plan selects by"),
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
        optional("epoch_gps", DOUBLE, "s", "GPS time at time 0"),
        optional("began", DOUBLE, "s", "stamp of a clock of its own at time 0"),
        optional("recorded_on", TEXT, "", "UTC date of the first sample"),
        optional("from_s", DOUBLE, "s", "time of the first sample"),
        optional("to_s", DOUBLE, "s", "time of the last sample"),
        Column("records", INTEGER, "1", "number of decoded records"),
        Column("to_record", INTEGER, "1", "number after that of the last decoded record, else 0"),
        optional("interval", DOUBLE, "s", "median sample interval"),
        optional(
            "integration_step",
            DOUBLE,
            "s",
            "mean sample interval: what a sample counts for in a sum over time",
        ),
        optional(
            "interval_sigma",
            DOUBLE,
            "s",
            "standard deviation of the interval of the regular clock; null: stamps are used",
        ),
        optional(
            "stamp_scatter",
            DOUBLE,
            "s",
            "rms of the stamps about the regular clock that is used instead; null: they are used",
        ),
        optional("shortest_gap", DOUBLE, "s", "shortest gap that stamps which scatter show"),
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
    3,
    (
        LOG,
        SENSOR,
        AXIS,
        optional("resolution", DOUBLE, AS_CHANNEL, "smallest step of its readings"),
        optional(
            "noise",
            DOUBLE,
            AS_CHANNEL,
            "scatter of a reading about its neighbours, 1.4826/√2 × median of the absolute steps",
        ),
        Column("unchanged_share", DOUBLE, "1", "share of readings equal to the one before"),
        Column(
            "held_share",
            DOUBLE,
            "1",
            "share of records in which the sensor repeats its readings, if all the time; else 0",
        ),
        optional("smallest", DOUBLE, AS_CHANNEL, "smallest reading", BODY),
        optional("largest", DOUBLE, AS_CHANNEL, "largest reading", BODY),
        optional(
            "threshold",
            DOUBLE,
            AS_CHANNEL,
            "of all logs: smaller readings are exactly 0, if they are",
        ),
    ),
)


FINDINGS = Table(
    "findings",
    2,
    (
        Column("id", TEXT, "", "stable identifier; no code reads anything from it"),
        Column("cause", TEXT, "", "what it is"),
        Column("mount", TEXT, "", "where there are several and one is concerned; else empty"),
        optional("sensor", TEXT, "", "accel or gyro, where one is concerned"),
        optional("axis", TEXT, "", "x, y or z, where one is concerned"),
        optional("log", TEXT, "", "as in logs"),
        optional("manoeuvre", TEXT, "", "as in manoeuvres"),
        optional("from_s", DOUBLE, "s", "from, in the time of the log"),
        optional("to_s", DOUBLE, "s", "to, in the time of the log"),
        Column("count", INTEGER, "1", "how many equal ones this stands for"),
        optional("size", DOUBLE, "as unit", "how large"),
        Column("unit", TEXT, "", "unit of size"),
        optional("p_value", DOUBLE, "1", "chance of such a size if nothing is wrong"),
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
        optional("sensor", TEXT, "", "accel or gyro where one channel is masked"),
        optional("axis", TEXT, "", "x, y or z where one channel is masked"),
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
        optional("time", DOUBLE, "s", "as in samples"),
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
        optional("from_s", DOUBLE, "s", "time of its first record"),
        optional("to_s", DOUBLE, "s", "time of its last record"),
    ),
)
PERFORMED = Table(
    "performed",
    6,
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
        Column(
            "stopped",
            DOUBLE,
            "s",
            "when the last turn about any axis on the way to it ended, as `time` of the samples;"
            " none where these do not show one",
            "",
            True,
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
        optional("time", DOUBLE, "s", "middle of the block"),
        optional("seconds", DOUBLE, "s", "count × integration step: mean × seconds is a sum"),
        Column("count", DOUBLE, "1", "number of samples in the means"),
        Column(
            "missing_s",
            DOUBLE,
            "s",
            "of a turn: time before it, since the block before, that is lost or masked; else 0",
        ),
        *channels("mean"),
        optional("table_angle", DOUBLE, "rad", "mean angle of the table"),
        *(
            optional(
                f"{what}_{edge}",
                DOUBLE,
                unit,
                f"of a turn: {what} of the table by its encoder at the {place} of the block; none"
                " where the encoder is not used",
            )
            for what, unit in (("angle", "rad"), ("rate", "rad/s"))
            for edge, place in (("from", "beginning"), ("to", "end"))
        ),
        optional("temperature", DOUBLE, "K", "mean temperature"),
        Column("mask_share", DOUBLE, "1", "share of its records that are masked"),
    ),
)
TRACES = Table(
    "traces",
    1,
    (
        LOG,
        *RECORDS,
        optional("from_s", DOUBLE, "s", "time of the first record"),
        optional("to_s", DOUBLE, "s", "time of the last record"),
        *channels("smallest", prefix="least_"),
        *channels("largest", prefix="most_"),
    ),
)

"""What was recorded: samples, clocks, findings, masks, segments, blocks."""

from inertial.tables.table import (
    AS_CHANNEL,
    AXIS,
    BODY,
    INTEGER,
    LABEL,
    LOG,
    PHASES,
    RECORDS,
    SENSOR,
    WORD,
    Column,
    channels,
    integer,
    number,
    optional,
    optional_number,
    optional_text,
    sentence,
    table,
    text,
    truth,
)
from inertial.text.parameters import AXES

SAMPLES = table(
    "samples",
    1,
    Column("log", LABEL, "", "as in logs"),
    integer("record", "number of the record in its log, refused ones counted"),
    Column("offset", INTEGER, "byte", "where its line begins in the file"),
    integer("line", "number of its line, from 1"),
    optional_number("time", "s", "since the start of its clock"),
    optional("status", WORD, "", "status word of the instrument"),
    optional_number("mean_of", "1", "number of samples that this record is the mean of"),
    *channels("specific force, angular rate"),
    optional_number("table_angle", "rad", "as the table's encoder gives it, continuous over turns"),
    optional_number("temperature", "K", "of the instrument"),
    optional("label", LABEL, "", "label that the plan selects by"),
)
MEAN_SIGMAS = table(
    "mean_sigmas",
    1,
    LOG,
    integer("record", "as in samples, where records are means"),
    SENSOR,
    AXIS,
    number("sigma", AS_CHANNEL, "standard deviation of the mean, as the log states it"),
)
REFUSED = table(
    "refused",
    1,
    LOG,
    integer("line", "number of the line, from 1"),
    Column("offset", INTEGER, "byte", "where the line begins in the file"),
    Column("bytes", INTEGER, "byte", "its length with its line end"),
    sentence("reason", "what was found and what was expected"),
    text("text", "its beginning"),
)
ACCOUNTS = table(
    "accounts",
    1,
    LOG,
    text("kind", "decoded, other message, header, blank, not selected, refused"),
    text("name", "name of the message, where it has one"),
    integer("lines", "number of lines"),
    Column("bytes", INTEGER, "byte", "their bytes; all rows of a log add up to its size"),
)
CLOCKS = table(
    "clocks",
    7,
    LOG,
    text("clock", "GPS: shared by the logs; own: each log from its first sample; none"),
    optional_number("epoch_gps", "s", "GPS time at time 0"),
    optional_number("began", "s", "stamp of a clock of its own at time 0"),
    optional_text("recorded_on", "UTC date of the first sample"),
    optional_number("from_s", "s", "time of the first sample"),
    optional_number("to_s", "s", "time of the last sample"),
    integer("records", "number of decoded records"),
    integer("to_record", "number after that of the last decoded record, else 0"),
    optional_number(
        "interval", "s", "sample interval, gaps left out: what a sample counts for in a sum"
    ),
    optional_number(
        "interval_sigma",
        "s",
        "standard deviation of the interval of the regular clock; null: stamps are used",
    ),
    optional_number(
        "stamp_scatter",
        "s",
        "rms of the stamps about the regular clock that is used instead; null: they are used",
    ),
    optional_number("shortest_gap", "s", "shortest gap that stamps which scatter show"),
)
IMU_TYPES = table(
    "imu_types",
    1,
    LOG,
    Column("imu_type", INTEGER, "", "a type of IMU in its messages, by NovAtel's list"),
)
CHANNEL_STATISTICS = table(
    "channel_statistics",
    3,
    LOG,
    SENSOR,
    AXIS,
    optional_number("resolution", AS_CHANNEL, "smallest step of its readings"),
    optional_number(
        "noise",
        AS_CHANNEL,
        "scatter of a reading about its neighbours, 1.4826/√2 × median of the absolute steps",
    ),
    number("unchanged_share", "1", "share of readings equal to the one before"),
    number(
        "held_share",
        "1",
        "share of records in which the sensor repeats its readings, if all the time; else 0",
    ),
    optional_number("smallest", AS_CHANNEL, "smallest reading", BODY),
    optional_number("largest", AS_CHANNEL, "largest reading", BODY),
    optional_number(
        "threshold", AS_CHANNEL, "of all logs: smaller readings are exactly 0, if they are"
    ),
)


FINDINGS = table(
    "findings",
    2,
    text("id", "stable identifier; no code reads anything from it"),
    text("cause", "what it is"),
    text("mount", "where there are several and one is concerned; else empty"),
    optional_text("sensor", "accel or gyro, where one is concerned"),
    optional_text("axis", "x, y or z, where one is concerned"),
    optional_text("log", "as in logs"),
    optional_text("manoeuvre", "as in manoeuvres"),
    optional_number("from_s", "s", "from, in the time of the log"),
    optional_number("to_s", "s", "to, in the time of the log"),
    integer("count", "how many equal ones this stands for"),
    optional_number("size", "as unit", "how large"),
    text("unit", "unit of size"),
    optional_number("p_value", "1", "chance of such a size if nothing is wrong"),
    Column("severity", INTEGER, "", "3 spoils a result, 2 weakens it, 1 is good to know"),
    sentence("consequence", "what it does to the result"),
    sentence("action", "what the pipeline did, or what the laboratory should do"),
    sentence("sentence", "the finding in words"),
)
MASKS = table(
    "masks",
    4,
    LOG,
    *RECORDS,
    optional_text("sensor", "accel or gyro where one channel is masked"),
    optional_text("axis", "x, y or z where one channel is masked"),
    truth("repeated", "they repeat other records: no time passes with them"),
    truth(
        "censored",
        "masked for their value, at the end of the range: the mean of those left is biased",
    ),
    text("finding", "id of the finding that masks these records"),
)
CLOSE_UPS = table(
    "close_ups",
    1,
    text("finding", "id of the finding that these records show"),
    LOG,
    integer("record", "number of the record in its log"),
    integer("line", "number of its line, from 1"),
    optional_number("time", "s", "as in samples"),
    *channels("as in samples"),
    truth("concerned", "it lies in the stretch that the finding is about"),
)
GAPS = table(
    "gaps",
    1,
    LOG,
    integer("record", "first record after the gap"),
    number("from_s", "s", "time of the record before the gap"),
    number("to_s", "s", "time of the record after the gap"),
    integer("missing", "number of samples that are missing"),
)
SEGMENTS = table(
    "segments",
    1,
    text("manoeuvre", "as in manoeuvres"),
    text("phase", PHASES),
    LOG,
    *RECORDS,
    optional_number("from_s", "s", "time of its first record"),
    optional_number("to_s", "s", "time of its last record"),
)
PERFORMED = table(
    "performed",
    6,
    text("manoeuvre", "as in manoeuvres"),
    truth("found", "found in its log"),
    truth(
        "complete",
        "recorded from rest to rest without a gap, as planned, but for a few masked samples",
    ),
    truth(
        "bridged",
        "not complete, but what is missing lies in the steady part, so the joint fit can"
        " bridge it; in a ramp, or by hand, only a few masked samples",
    ),
    optional_number("angle", "rad", "angle that was recorded, about `about`", BODY),
    optional_number("missing_angle", "rad", "angle that was planned but not recorded", BODY),
    number("missing_s", "s", "time that is lost or masked while it turns; 0 where it is complete"),
    optional_number("rate", "rad/s", "mean rate of the steady part, about `about`", BODY),
    number("seconds", "s", "duration of the rest, or from start to stop of the turn"),
    truth(
        "lost",
        "not complete, because of a gap or masked records alone: their findings are the cause",
    ),
    *(
        optional_number(
            f"peak_{axis}",
            "m/s²",
            "last extreme of specific force on the way to it beyond both ends, by the readings;"
            " none where these do not show one",
            BODY,
        )
        for axis in AXES
    ),
    *(
        optional_number(
            f"sense_{axis}",
            "1",
            "sense of the last rate about the axis on the way to it, 1 or -1, by the readings;"
            " none where these do not show one",
            BODY,
        )
        for axis in AXES
    ),
    optional_number(
        "stopped",
        "s",
        "when the last turn about any axis on the way to it ended, as `time` of the samples;"
        " none where these do not show one",
    ),
    sentence("sentence", "what was recorded of it, in words"),
)
BLOCKS = table(
    "blocks",
    3,
    text("manoeuvre", "as in manoeuvres"),
    text("phase", PHASES),
    LOG,
    *RECORDS,
    optional_number("time", "s", "middle of the block"),
    optional_number("seconds", "s", "count × integration step: mean × seconds is a sum"),
    number("count", "1", "number of samples in the means"),
    number(
        "missing_s",
        "s",
        "of a turn: time before it, since the block before, that is lost or masked; else 0",
    ),
    *channels("mean"),
    optional_number("table_angle", "rad", "mean angle of the table"),
    *(
        optional_number(
            f"{what}_{edge}",
            unit,
            f"of a turn: {what} of the table by its encoder at the {place} of the block; none"
            " where the encoder is not used",
        )
        for what, unit in (("angle", "rad"), ("rate", "rad/s"))
        for edge, place in (("from", "beginning"), ("to", "end"))
    ),
    optional_number("temperature", "K", "mean temperature"),
    number("mask_share", "1", "share of its records that are masked"),
)
TRACES = table(
    "traces",
    1,
    LOG,
    *RECORDS,
    optional_number("from_s", "s", "time of the first record"),
    optional_number("to_s", "s", "time of the last record"),
    *channels("smallest", prefix="least_"),
    *channels("largest", prefix="most_"),
)

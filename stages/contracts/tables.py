"""The tables that pass between stages, each column with its unit, frame and meaning."""

import pyarrow as pa

from stages.contracts.parquet import Column, Table

AXES = ("x", "y", "z")
CHANNELS = tuple(f"{sensor}_{axis}" for sensor in ("accel", "gyro") for axis in AXES)
UNITS = {"accel": "m/s²", "gyro": "rad/s"}
PHASES = (
    "rest; for a turn rest-before, spin-up, steady, spin-down, rest-after; by hand: turning;"
    " from one rest of unknown attitude to the next: between"
)
BODY = "body"  # axes x, y, z of the IMU's case, right-handed

_double, _text, _integer, _truth = pa.float64(), pa.string(), pa.int64(), pa.bool_()
_label = pa.dictionary(pa.int32(), pa.string())


def _vector(stem: str, unit: str, meaning: str, *, nullable: bool = True) -> list[Column]:
    return [
        Column(f"{stem}_{axis}", _double, unit, f"{meaning}, {axis}", BODY, nullable)
        for axis in AXES
    ]


def _channels(meaning: str, *, prefix: str = "") -> list[Column]:
    return [
        Column(
            f"{prefix}{channel}", _double, UNITS[channel[:-2]], f"{meaning}, {channel}", BODY, True
        )
        for channel in CHANNELS
    ]


_LOG = Column(
    "log", _text, "", "file name; with ':' and the format's name where it is read in several"
)
_RECORDS = (
    Column("from_record", _integer, "1", "first record"),
    Column("to_record", _integer, "1", "record after the last"),
)

# ---- plan

CAMPAIGN = Table(
    "campaign",
    2,
    (
        Column("campaign", _text, "", "name of the campaign's folder"),
        Column("simulated", _truth, "", "recorded by the simulated laboratory"),
        Column("compensated", _truth, "", "the errors were taken out of its logs already"),
        Column("instrument", _text, "", "name of the IMU's type"),
        Column("serial", _text, "", "serial number, or unknown"),
        Column("date", _text, "", "date as the campaign states it, or unknown"),
        Column("laboratory", _text, "", "where", nullable=True),
        Column("operator", _text, "", "by whom", nullable=True),
        Column("notes", _text, "", "remarks of the laboratory", nullable=True),
        Column("table", _text, "", "name of the table"),
        Column("rate", _double, "Hz", "stated sample rate", nullable=True),
        Column("latitude", _double, "rad", "geodetic latitude", "earth", True),
        Column("height", _double, "m", "height above the ellipsoid", "earth", True),
        Column("must_be_set", _integer, "", "bits that are set in the status of a valid record"),
        Column(
            "must_be_clear", _integer, "", "bits that are clear in the status of a valid record"
        ),
    ),
)
KNOWN = Table(
    "known",
    1,
    (
        Column("quantity", _text, "", "name of what is taken as known"),
        Column("value", _double, "as unit", "its value; none where it is not known", nullable=True),
        Column("sigma", _double, "as unit", "standard deviation of the value", nullable=True),
        Column("unit", _text, "", "unit of value and sigma"),
        Column("origin", _text, "", "stated in the campaign, computed, or assumed, and from what"),
    ),
)
SENSORS = Table(
    "sensors",
    1,
    (
        Column("channel", _text, "", "one of the six channels"),
        Column("count_size", _double, "rad, m/s", "increment of one count", nullable=True),
        Column("full_scale", _double, "rad/s, m/s²", "largest input", nullable=True),
        Column(
            "white_noise", _double, "rad/√s, m/s/√s", "random walk of the data sheet", nullable=True
        ),
        Column("source", _text, "", "where these figures are from", nullable=True),
    ),
)
LOGS = Table(
    "logs",
    1,
    (
        _LOG,
        Column("file", _text, "", "file name inside the campaign's folder"),
        Column("layout", _text, "", "how its bytes are read, as JSON"),
    ),
)
RANGES = Table(
    "ranges",
    1,
    (
        _LOG,
        Column("channel", _text, "", "one of the six channels"),
        Column("count", _double, "as the channel", "what one count is, if stated", nullable=True),
        Column("increments", _truth, "", "a count is an increment: its unit is times s"),
        Column("limit", _double, "as the channel", "how far it reaches, if stated", nullable=True),
    ),
)
COUNT_SIZES = Table(
    "count_sizes",
    1,
    (
        Column("instrument", _text, "", "entry of the list of instruments"),
        Column("sensor", _text, "", "accel or gyro"),
        Column("count_size", _double, "rad, m/s", "increment of one count"),
    ),
)
INPUTS = Table(
    "inputs",
    1,
    (
        Column("file", _text, "", "file name"),
        Column("size", _integer, "byte", "size of the file"),
        Column("sha256", _text, "", "SHA-256 of the file"),
    ),
)
MANOEUVRES = Table(
    "manoeuvres",
    1,
    (
        Column("manoeuvre", _text, "", "identifier, unique in the campaign"),
        Column("do", _text, "", "rest, turn or positions"),
        _LOG,
        Column("position", _text, "", "manoeuvres of one position share its error"),
        Column("mount", _text, "", "how the IMU sits on the table"),
        *_vector("up", "1", "unit vector that points up at the start"),
        *_vector("mark", "1", "unit vector to the table's zero mark at the start"),
        *_vector("about", "1", "unit vector of the axis of the turn"),
        Column(
            "angle", _double, "rad", "angle of the turn about `about`, right-hand rule", BODY, True
        ),
        Column("angle_sigma", _double, "rad", "standard deviation of the angle", nullable=True),
        Column("rate", _double, "rad/s", "signed rate of the turn about `about`", BODY, True),
        Column("acceleration", _double, "rad/s²", "of the table at start and stop", nullable=True),
        Column("seconds", _double, "s", "planned duration", nullable=True),
        Column("recorded", _text, "", "whole: rest on both sides is in the log; steady: it is not"),
        Column(
            "from_s", _double, "s", "start of the stated span, in the log's own time", nullable=True
        ),
        Column("to_s", _double, "s", "end of the stated span", nullable=True),
        Column("from_row", _integer, "1", "first data row of the stated rows", nullable=True),
        Column("to_row", _integer, "1", "data row after the last", nullable=True),
        Column("label", _text, "", "the records with this label", nullable=True),
    ),
)
PUBLISHED = Table(
    "published",
    2,
    (
        Column("parameter", _text, "", "stage and parameter, such as gyroscope/bias_x"),
        Column("value", _double, "as unit", "what others found for it"),
        Column("sigma", _double, "as unit", "its standard deviation, if told", nullable=True),
        Column("unit", _text, "", "unit of value and sigma, SI"),
        Column("source", _text, "", "where it is published"),
        Column("window", _double, "rad", "angle of the window it is from, if told", nullable=True),
        Column("samples", _double, "1", "intervals of that window, if told", nullable=True),
    ),
)

# ---- decode

SAMPLES = Table(
    "samples",
    1,
    (
        Column("log", _label, "", "as in logs"),
        Column("record", _integer, "1", "number of the record in its log, refused ones counted"),
        Column("offset", _integer, "byte", "where its line begins in the file"),
        Column("line", _integer, "1", "number of its line, from 1"),
        Column("time", _double, "s", "since the start of its clock", "", True),
        Column("status", pa.uint32(), "", "status word of the instrument", nullable=True),
        Column(
            "mean_of",
            _double,
            "1",
            "number of samples that this record is the mean of",
            nullable=True,
        ),
        *_channels("specific force, angular rate"),
        Column("table_angle", _double, "rad", "as the table's encoder gives it", nullable=True),
        Column("temperature", _double, "K", "of the instrument", nullable=True),
        Column("label", _label, "", "label that the plan selects by", nullable=True),
    ),
)
REFUSED = Table(
    "refused",
    1,
    (
        _LOG,
        Column("line", _integer, "1", "number of the line, from 1"),
        Column("offset", _integer, "byte", "where the line begins in the file"),
        Column("bytes", _integer, "byte", "its length with its line end"),
        Column("reason", _text, "", "what was found and what was expected"),
        Column("text", _text, "", "its beginning"),
    ),
)
ACCOUNTS = Table(
    "accounts",
    1,
    (
        _LOG,
        Column("kind", _text, "", "decoded, other message, header, blank, not selected, refused"),
        Column("name", _text, "", "name of the message, where it has one"),
        Column("lines", _integer, "1", "number of lines"),
        Column("bytes", _integer, "byte", "their bytes; all rows of a log add up to its size"),
    ),
)
CLOCKS = Table(
    "clocks",
    1,
    (
        _LOG,
        Column(
            "clock", _text, "", "GPS: shared by the logs; own: each log from its first sample; none"
        ),
        Column("epoch_gps", _double, "s", "GPS time at time 0", nullable=True),
        Column("recorded_on", _text, "", "UTC date of the first sample", nullable=True),
        Column("from_s", _double, "s", "time of the first sample", nullable=True),
        Column("to_s", _double, "s", "time of the last sample", nullable=True),
        Column("records", _integer, "1", "number of decoded records"),
        Column("interval", _double, "s", "median sample interval", nullable=True),
        Column("step", _double, "s", "what a sample counts for in a sum over time", nullable=True),
    ),
)

# ---- quality, segment

FINDINGS = Table(
    "findings",
    1,
    (
        Column("id", _text, "", "stable identifier: stage/cause/place"),
        Column("cause", _text, "", "what it is"),
        Column("sensor", _text, "", "accel or gyro, where one is concerned", nullable=True),
        Column("axis", _text, "", "x, y or z, where one is concerned", nullable=True),
        Column("log", _text, "", "as in logs", nullable=True),
        Column("manoeuvre", _text, "", "as in manoeuvres", nullable=True),
        Column("from_s", _double, "s", "from, in the time of the log", nullable=True),
        Column("to_s", _double, "s", "to, in the time of the log", nullable=True),
        Column("count", _integer, "1", "how many equal ones this stands for"),
        Column("size", _double, "as unit", "how large", nullable=True),
        Column("unit", _text, "", "unit of size"),
        Column("p_value", _double, "1", "chance of such a size if nothing is wrong", nullable=True),
        Column("severity", _integer, "", "3 spoils a result, 2 weakens it, 1 is good to know"),
        Column("consequence", _text, "", "what it does to the result"),
        Column("action", _text, "", "what the pipeline did, or what the laboratory should do"),
        Column("sentence", _text, "", "the finding in words"),
    ),
)
MASKS = Table(
    "masks",
    2,
    (
        _LOG,
        *_RECORDS,
        Column("channel", _text, "", "the one channel that is masked, else all", nullable=True),
        Column("repeated", _truth, "", "they repeat other records: no time passes with them"),
        Column("finding", _text, "", "id of the finding that masks these records"),
    ),
)
CLOSE_UPS = Table(
    "close_ups",
    1,
    (
        Column("finding", _text, "", "id of the finding that these records show"),
        _LOG,
        Column("record", _integer, "1", "number of the record in its log"),
        Column("line", _integer, "1", "number of its line, from 1"),
        Column("time", _double, "s", "as in samples", nullable=True),
        *_channels("as in samples"),
        Column("concerned", _truth, "", "it lies in the stretch that the finding is about"),
    ),
)
GAPS = Table(
    "gaps",
    1,
    (
        _LOG,
        Column("record", _integer, "1", "first record after the gap"),
        Column("from_s", _double, "s", "time of the record before the gap"),
        Column("to_s", _double, "s", "time of the record after the gap"),
        Column("missing", _integer, "1", "number of samples that are missing"),
    ),
)
SEGMENTS = Table(
    "segments",
    1,
    (
        Column("manoeuvre", _text, "", "as in manoeuvres"),
        Column("phase", _text, "", PHASES),
        _LOG,
        *_RECORDS,
        Column("from_s", _double, "s", "time of its first record", nullable=True),
        Column("to_s", _double, "s", "time of its last record", nullable=True),
    ),
)
PERFORMED = Table(
    "performed",
    2,
    (
        Column("manoeuvre", _text, "", "as in manoeuvres"),
        Column("found", _truth, "", "found in its log"),
        Column("complete", _truth, "", "recorded from rest to rest without a gap, as planned"),
        Column(
            "bridged",
            _truth,
            "",
            "not complete, but what is missing lies in the steady part, so the joint estimate can"
            " bridge it; in a ramp, or by hand, only a few masked samples",
        ),
        Column("angle", _double, "rad", "angle that was recorded, about `about`", BODY, True),
        Column(
            "missing_angle", _double, "rad", "angle that was planned but not recorded", BODY, True
        ),
        Column("missing_s", _double, "s", "time that is lost or masked while it turns"),
        Column("rate", _double, "rad/s", "mean rate of the steady part, about `about`", BODY, True),
        Column("seconds", _double, "s", "duration of the rest, or from start to stop of the turn"),
        Column("sentence", _text, "", "what was recorded of it, in words"),
    ),
)
BLOCKS = Table(
    "blocks",
    2,
    (
        Column("manoeuvre", _text, "", "as in manoeuvres"),
        Column("phase", _text, "", PHASES),
        _LOG,
        *_RECORDS,
        Column("time", _double, "s", "middle of the block", nullable=True),
        Column("seconds", _double, "s", "count × step: mean × seconds is a sum", nullable=True),
        Column("count", _double, "1", "number of samples in the means"),
        Column(
            "missing_s",
            _double,
            "s",
            "of a turn: time before it, since the block before, that is lost or masked; else 0",
        ),
        *_channels("mean"),
        Column("table_angle", _double, "rad", "mean angle of the table", nullable=True),
        Column("temperature", _double, "K", "mean temperature", nullable=True),
        Column("mask_share", _double, "1", "share of its records that are masked"),
    ),
)
TRACES = Table(
    "traces",
    1,
    (
        _LOG,
        *_RECORDS,
        Column("from_s", _double, "s", "time of the first record", nullable=True),
        Column("to_s", _double, "s", "time of the last record", nullable=True),
        *_channels("smallest", prefix="least_"),
        *_channels("largest", prefix="most_"),
    ),
)

# ---- noise and estimation

NOISE = Table(
    "noise",
    1,
    (
        Column("manoeuvre", _text, "", "as in manoeuvres"),
        Column("phase", _text, "", "rest or steady"),
        Column("channel", _text, "", "one of the six channels"),
        Column("white_noise", _double, "rad/√s, m/s/√s", "random walk: root of the power density"),
        Column("sigma", _double, "rad/√s, m/s/√s", "standard deviation of white_noise"),
        Column("per_sample", _double, "rad/s, m/s²", "standard deviation of the samples"),
        Column("samples", _integer, "1", "number of samples"),
        Column("data_sheet", _double, "rad/√s, m/s/√s", "the data sheet's figure", nullable=True),
    ),
)
PARAMETERS = Table(
    "parameters",
    1,
    (
        Column("id", _text, "", "stable identifier: stage/method/parameter"),
        Column("stage", _text, "", "stage that estimated it"),
        Column("method", _text, "", "method of estimation"),
        Column("parameter", _text, "", "name within the method"),
        Column(
            "value", _double, "as unit", "estimate; none where it is not determined", nullable=True
        ),
        Column("sigma", _double, "as unit", "its standard deviation", nullable=True),
        Column("unit", _text, "", "unit of value and sigma"),
        Column("frame", _text, "", "frame it is expressed in"),
        Column("meaning", _text, "", "what it is, in words"),
        Column("reason", _text, "", "why it is not determined, and the manoeuvre that would help"),
    ),
)
COVARIANCE = Table(
    "covariance",
    1,
    (
        Column("first", _text, "", "id of a parameter"),
        Column("second", _text, "", "id of a parameter"),
        Column("covariance", _double, "product of the units", "of the two estimates"),
    ),
)
FIT = Table(
    "fit",
    2,
    (
        Column("method", _text, "", "method of estimation"),
        Column(
            "chi_squared",
            _double,
            "1",
            "weighted sum of squared residuals, the scatter allowed for",
        ),
        Column("degrees", _integer, "1", "degrees of freedom"),
        Column("p_value", _double, "1", "chance of residuals this large by noise alone"),
        Column(
            "scatter", _double, "as unit", "what manoeuvres differ by beyond noise; 0 where p ≥ 1 %"
        ),
        Column("unit", _text, "", "unit of the scatter"),
        Column("used", _text, "", "the manoeuvres that were used"),
        Column("left_out", _text, "", "the manoeuvres that were not, each with the reason"),
        Column(
            "random_walk", _double, "unit/√s", "of the bias, which is that of the middle; 0: none"
        ),
        Column("random_walk_sigma", _double, "unit/√s", "its standard deviation", nullable=True),
    ),
)
POSITIONS = Table(
    "positions",
    1,
    (
        Column("method", _text, "", "method of estimation"),
        Column("position", _text, "", "set position"),
        Column("quantity", _text, "", "tilt 0, tilt 1; level 0, level 1: part of the earth's rate"),
        Column("value", _double, "as unit", "estimate, about or along the level axis 0 or 1", BODY),
        Column("sigma", _double, "as unit", "its standard deviation"),
        Column("unit", _text, "", "unit of value and sigma"),
    ),
)
AVERAGING = Table(
    "averaging",
    1,
    (
        Column("parameter", _text, "", "id of a parameter"),
        Column("seconds", _double, "s", "length of each rest that was used, from its start"),
        Column("value", _double, "as the parameter", "estimate from these"),
        Column("sigma", _double, "as the parameter", "its standard deviation"),
    ),
)
WANTED = Table(
    "wanted",
    1,
    (
        Column("parameter", _text, "", "id of a bias by one of S0's formulas"),
        Column("seconds", _double, "s", "length of each rest that was recorded"),
        Column("sigma", _double, "as the parameter", "standard deviation of the bias by these"),
        Column("floor", _double, "as the parameter", "what of it no time averages out"),
        Column("random_walk", _double, "parameter·√s", "white noise of the bias, √s of a rest"),
        Column("wanted", _double, "as the parameter", "sigma that is wanted"),
        Column(
            "wanted_seconds",
            _double,
            "s",
            "for it; none where the floor is above it",
            nullable=True,
        ),
    ),
)

# ---- history


def _rows(*fields: tuple[str, pa.DataType, str]) -> pa.DataType:
    """A column that holds rows of its own, of columns with name, type and meaning."""
    return pa.list_(
        pa.struct([pa.field(name, kind, True, {"meaning": told}) for name, kind, told in fields])
    )


# An archive outlives the other tables, so it borrows no columns of theirs. Whoever counts its
# version up writes how the older files are read.
CALIBRATION = Table(
    "calibration",
    1,
    (
        Column("campaign", _text, "", "name of the campaign's folder"),
        Column("simulated", _truth, "", "recorded by the simulated laboratory"),
        Column("compensated", _truth, "", "the errors were taken out of its logs already"),
        Column("instrument", _text, "", "name of the IMU's type"),
        Column("serial", _text, "", "serial number, or unknown"),
        Column("date", _text, "", "date as the campaign states it, or unknown"),
        Column("laboratory", _text, "", "where", nullable=True),
        Column("operator", _text, "", "by whom", nullable=True),
        Column("notes", _text, "", "remarks of the laboratory", nullable=True),
        Column("table", _text, "", "name of the table"),
        Column(
            "parameters",
            _rows(
                ("id", _text, "stable identifier: stage/method/parameter"),
                ("method", _text, "method of estimation"),
                ("value", _double, "estimate in this unit; none where it is not determined"),
                ("sigma", _double, "its standard deviation"),
                ("unit", _text, "unit of value and sigma"),
                ("frame", _text, "frame it is expressed in"),
                ("meaning", _text, "what it is, in words"),
                ("reason", _text, "why it is not determined"),
            ),
            "as unit",
            "the parameters of every method",
        ),
        Column(
            "covariance",
            _rows(
                ("first", _text, "id of a parameter"),
                ("second", _text, "id of a parameter"),
                ("covariance", _double, "of the two estimates"),
            ),
            "product of the units",
            "of the joint methods, and of the extended result where that counts",
        ),
        Column(
            "inputs",
            _rows(
                ("file", _text, "file name"),
                ("size", _integer, "size of the file, byte"),
                ("sha256", _text, "SHA-256 of the file"),
            ),
            "",
            "campaign file and logs",
        ),
        Column(
            "made_by",
            _rows(
                ("stage", _text, "name of the stage"),
                ("settings", _text, "its settings, as JSON"),
                ("code", _text, "SHA-256 of its code"),
                ("inputs", _text, "SHA-256 of each file that it read, as JSON"),
            ),
            "",
            "the stages that made these tables",
        ),
        Column("content", _text, "", "SHA-256 of what makes it another calibration"),
        Column("supersedes", pa.list_(_text), "", "files of the archive that it replaces"),
    ),
)
ARCHIVED = Table(
    "archived",
    1,
    (
        Column("file", _text, "", "the archive's file that holds this calibration"),
        Column("sha256", _text, "", "SHA-256 of that file"),
        Column("content", _text, "", "SHA-256 of what makes it another calibration"),
        Column("supersedes", _text, "", "files that it replaces, with spaces between; or none"),
    ),
)
EARLIER = Table(
    "earlier",
    2,
    (
        Column("campaign", _text, "", "campaign of another calibration of the same IMU"),
        Column("date", _text, "", "its date, not later than this campaign's, or unknown"),
        Column("file", _text, "", "the archive's file that holds it"),
        Column("id", _text, "", "identifier of the parameter by the joint method"),
        Column("value", _double, "as unit", "its estimate then, by the result that counted"),
        Column("sigma", _double, "as unit", "standard deviation of the estimate"),
        Column("unit", _text, "", "unit of value and sigma"),
    ),
)

# ---- simulation

SIMULATED = Table(
    "simulated",
    1,
    (
        Column("manoeuvre", _text, "", "a whole turn, or a rest in blocks"),
        Column("phase", _text, "", PHASES),
        _LOG,
        Column("record", _integer, "1", "record of the log; of a block the first"),
        Column("time", _double, "s", "time of the record, or middle of the block", nullable=True),
        *_channels("what the IMU should have read"),
        *_channels("read less simulated", prefix="residual_"),
    ),
)
FIDELITY = Table(
    "fidelity",
    1,
    (
        Column("manoeuvre", _text, "", "as in manoeuvres"),
        Column("channel", _text, "", "one of the six channels"),
        Column("profile", _text, "", "trapezoid; as the gyros have it; or at rest"),
        Column("residual_rms", _double, "rad/s, m/s²", "root mean square of the residuals"),
        Column("noise_rms", _double, "rad/s, m/s²", "what white noise alone would give"),
        Column("samples", _integer, "1", "number of samples, or of blocks of a rest"),
    ),
)

# ---- studies

EPOCHS = Table(
    "epochs",
    1,
    (
        Column("parameter", _text, "", "stage, rests and parameter: gyroscope/rests/bias_x"),
        Column("unit", _text, "", "unit of the parameter, SI"),
        Column("seconds", _double, "s", "end of the epoch, from the start of every rest"),
        Column("single", _double, "as unit", "by this epoch alone", nullable=True),
        Column("single_sigma", _double, "as unit", "its sigma by white noise"),
        Column("running", _double, "as unit", "by all epochs up to this one", nullable=True),
        Column("running_sigma", _double, "as unit", "its sigma by white noise"),
    ),
)
SPREADS = Table(
    "spreads",
    1,
    (
        Column("parameter", _text, "", "as in epochs"),
        Column("unit", _text, "", "unit of the parameter, SI"),
        Column("seconds", _double, "s", "length of an epoch"),
        Column("epochs", _integer, "1", "how many there are"),
        Column("single", _double, "unit²", "variance of the values by single epochs"),
        Column("running", _double, "unit²", "variance of the values by running means"),
        Column("white", _double, "unit²", "variance by single epochs that white noise would give"),
    ),
)
WINDOWS = Table(
    "windows",
    1,
    (
        Column("axis", _text, "", "gyro, and axis of both turns", BODY),
        Column("forward", _text, "", "manoeuvre of the turn forward"),
        Column("backward", _text, "", "manoeuvre of the turn backward"),
        Column(
            "by",
            _text,
            "",
            "how the angle of the window is known: whole turn; set rate: by time; own angle: by the"
            " time and angle of the same two turns; other turns: by the speed of turns about other"
            " axes",
        ),
        Column("from_s", _double, "s", "start of the window, from the start of the steady part"),
        Column("samples", _integer, "1", "intervals of the window"),
        Column("angle", _double, "rad", "half of what lies between the two angles of the table"),
        Column("scale", _double, "1", "scale factor error"),
        Column("scale_sigma", _double, "1", "its sigma"),
        Column("cut_sigma", _double, "1", "the part of it that differs from window to window"),
        Column("bias", _double, "rad/s", "bias"),
        Column("bias_sigma", _double, "rad/s", "its sigma"),
    ),
)
TIME_ANGLE = Table(
    "time_angle",
    1,
    (
        Column("manoeuvre", _text, "", "a turn that was recorded whole"),
        Column("seconds", _double, "s", "since the stretch with its motion began"),
        Column("angle", _double, "rad", "turned so far, mean over some samples about this time"),
        Column("swing", _double, "rad", "half the range within them, what bends slowly left out"),
        Column("sigma", _double, "rad", "of the angle; at the end that of the whole angle"),
        Column("set_angle", _double, "rad", "of the trapezoid that was set", nullable=True),
    ),
)
MOTIONS = Table(
    "motions",
    1,
    (
        Column("manoeuvre", _text, "", "a turn that was recorded whole"),
        Column(
            "quantity",
            _text,
            "",
            "speed; spin-up or spin-down and start, seconds, acceleration: as if it were constant",
        ),
        Column("value", _double, "as unit", "by time and angle"),
        Column("sigma", _double, "as unit", "its sigma"),
        Column("set_value", _double, "as unit", "what was set", nullable=True),
        Column("unit", _text, "", "unit of these"),
    ),
)
NOT_STUDIED = Table(
    "not_studied",
    1,
    (
        Column("study", _text, "", "rests, or turns"),
        Column("subject", _text, "", "manoeuvres or parameters, in words"),
        Column("reason", _text, "", "why there is nothing of it"),
    ),
)

# ---- comparison

DIFFERENCES = Table(
    "differences",
    1,
    (
        Column("id", _text, "", "stable identifier: comparison/kind/parameter, and which turns"),
        Column(
            "kind",
            _text,
            "",
            "static_against_turns, forward_against_backward, method_against_method, published,"
            " fencepost; with @ and the mount where there are several",
        ),
        Column("parameter", _text, "", "stage and parameter, such as gyroscope/bias_x"),
        Column("unit", _text, "", "unit of the values, SI"),
        Column("first", _text, "", "what is compared: id of a parameter, or in words"),
        Column("second", _text, "", "with what: id of a parameter, or in words"),
        Column("first_value", _double, "as unit", "none where not determined", nullable=True),
        Column("second_value", _double, "as unit", "none where not determined", nullable=True),
        Column("difference", _double, "as unit", "first less second", nullable=True),
        Column("sigma", _double, "as unit", "its sigma; none where not known", nullable=True),
        Column("in_sigmas", _double, "1", "difference in units of its sigma", nullable=True),
        Column("p_value", _double, "1", "chance of one so large, either way", nullable=True),
        Column("sentence", _text, "", "the difference and the verdict in words"),
    ),
)

# ---- compensation

COMPENSATED = Table(
    "compensated",
    1,
    (
        Column("log", _label, "", "as in logs"),
        Column("record", _integer, "1", "as in samples"),
        Column("time", _double, "s", "as in samples", nullable=True),
        *_channels("specific force, angular rate, with the errors taken out"),
    ),
)
CHECKS = Table(
    "checks",
    1,
    (
        Column("id", _text, "", "stable identifier: compensation/quantity/manoeuvre"),
        Column(
            "manoeuvre",
            _text,
            "",
            "as in manoeuvres, with the rest of a turn in brackets",
            nullable=True,
        ),
        Column(
            "quantity",
            _text,
            "",
            "gravity: |f|; force_up: f along up; rate_up: rate along up; angle: of a turn about its"
            " axis, the earth's rate taken out; accelerometer, gyro: why one is not compensated",
        ),
        Column("unit", _text, "", "unit of the values, SI"),
        Column("expected", _double, "as unit", "what is known of it", nullable=True),
        Column("expected_sigma", _double, "as unit", "its standard deviation", nullable=True),
        Column("before", _double, "as unit", "by the readings", nullable=True),
        Column("after", _double, "as unit", "by the compensated readings", nullable=True),
        Column(
            "after_sigma",
            _double,
            "as unit",
            "of after less expected, by noise, angle, position and earth rate; without what all"
            " manoeuvres share and the parameters have taken up, as the sigma of gravity",
            nullable=True,
        ),
        Column("in_sigmas_after", _double, "1", "after less expected, in sigmas", nullable=True),
        Column("sentence", _text, "", "the check in words"),
    ),
)

# ---- criticism, extension

CAUSES = Table(
    "causes",
    1,
    (
        *FINDINGS.columns,
        Column("verdict", _text, "", "found, one_of_class, unknown_structure", nullable=True),
        Column("members", _text, "", "those that cannot be told apart", nullable=True),
        Column("statistic", _double, "1", "drop of chi-squared beside the others", nullable=True),
        Column("degrees", _integer, "1", "of freedom of the drop", nullable=True),
        Column("snr", _double, "1", "root of the drop less what noise adds", nullable=True),
        Column("parameters", _text, "SI", "name = value ± sigma unit, each", nullable=True),
        Column("split_manoeuvre", _text, "", "what would tell the members apart", nullable=True),
        Column("split_snr", _double, "1", "how clearly it would, in sigmas", nullable=True),
    ),
)
BLIND_SPOTS = Table(
    "blind_spots",
    1,
    (
        Column("effect", _text, "", "name in the catalogue, with @ and the mount if of several"),
        Column("parameter", _text, "", "name within the effect"),
        Column("visible", _double, "as unit", "5 sigma: what could have been seen", nullable=True),
        Column("best", _double, "as unit", "at the best value of what is scanned", nullable=True),
        Column("worst", _double, "as unit", "and at the worst", nullable=True),
        Column("unit", _text, "", "unit of these"),
        Column("reason", _text, "", "visible, not_excited, absorbed, or only_together"),
        Column("sentence", _text, "", "the same in words"),
    ),
)
SCORES = Table(
    "scores",
    2,
    (
        Column("effect", _text, "", "name in the catalogue"),
        Column("cause", _text, "", "its physical cause"),
        Column("sought_in", _text, "", "blocks, spectrum, noise or quality"),
        Column("statistic", _double, "1", "drop of chi-squared beyond what was named before it"),
        Column("degrees", _integer, "1", "of freedom: what the plan excites of the effect"),
        Column("p_value", _double, "1", "chance of such a statistic, or peak, by noise alone"),
        Column("named", _truth, "", "below the family-wise level"),
        Column("verdict", _text, "", "found, one_of_class, unknown_structure; empty: not needed"),
        Column("members", _text, "", "all causes that cannot be told apart, likeliest first"),
        Column("snr", _double, "1", "signal-to-noise ratio of what is named", nullable=True),
        Column("at", _double, "", "value of what is scanned of the effect", nullable=True),
        Column("sentence", _text, "", "what is said of it"),
    ),
)
EFFECTS = Table(
    "effects",
    1,
    (
        Column("id", _text, "", "stable identifier: criticism/effect/parameter"),
        Column("effect", _text, "", "name in the catalogue"),
        Column("parameter", _text, "", "name within the effect"),
        Column("value", _double, "as unit", "estimate beside all named effects", nullable=True),
        Column("sigma", _double, "as unit", "its standard deviation", nullable=True),
        Column("visible", _double, "as unit", "5 sigma: what can be seen", nullable=True),
        Column("unit", _text, "", "unit of these"),
        Column("meaning", _text, "", "what it is"),
    ),
)
LINES = Table(
    "lines",
    2,
    (
        Column("manoeuvre", _text, "", "as in manoeuvres"),
        Column("axis", _text, "", "gyro axis, of the case", BODY),
        Column("frequency", _double, "Hz", "of the strongest line, or an alias of it"),
        Column("frequency_sigma", _double, "Hz", "its standard deviation"),
        Column("amplitude", _double, "rad/s", "of the rate, the averaging of a sample undone"),
        Column("amplitude_sigma", _double, "rad/s", "its standard deviation"),
        Column("p_value", _double, "1", "chance of such a peak by noise, the search paid for"),
        Column("order", _double, "1", "periods in one turn of the table", nullable=True),
        Column("effect", _text, "", "that it is taken for; empty: none stands out", nullable=True),
    ),
)

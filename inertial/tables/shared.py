"""What many tables share: types, axes, channels, and columns that come together."""

from inertial.sensors import CHANNELS, UNITS
from inertial.tables.table import DOUBLE, INTEGER, TEXT, Column
from inertial.text.parameters import AXES

# Lists, for pandas takes a tuple as one name.
ACCEL, GYRO = ([f"{sensor}_{axis}" for axis in AXES] for sensor in ("accel", "gyro"))
STATIC_PHASES = ["rest", "rest-before", "rest-after"]  # in which the table is at rest
PHASES = (
    "rest; for a turn rest-before, spin-up, steady, spin-down, settling, rest-after; by hand:"
    " turning; from one rest of unknown attitude to the next: between"
)
CHANNEL_PARTS = {f"{sensor}_{axis}": (sensor, axis) for sensor in UNITS for axis in AXES}
BODY = "body"  # axes x, y, z of the IMU's case, right-handed
# By hand nothing tells the case: axes square to each other, nearest to those of the accelerometers.
OF_TRIAD = "accelerometer triad"


def vector(stem: str, unit: str, meaning: str, *, nullable: bool = True) -> list[Column]:
    return [
        Column(f"{stem}_{axis}", DOUBLE, unit, f"{meaning}, {axis}", BODY, nullable)
        for axis in AXES
    ]


def channels(meaning: str, *, prefix: str = "") -> list[Column]:
    return [
        Column(
            f"{prefix}{channel}",
            DOUBLE,
            UNITS[channel[:-2]],
            f"{meaning}, {channel}",
            BODY,
            nullable=True,
        )
        for channel in CHANNELS
    ]


LOG = Column(
    "log", TEXT, "", "file name; with ':' and the format's name where it is read in several"
)
RECORDS = (
    Column("from_record", INTEGER, "1", "first record"),
    Column("to_record", INTEGER, "1", "record after the last"),
)
SENSOR = Column("sensor", TEXT, "", "accel or gyro")
AXIS = Column("axis", TEXT, "", "x, y or z, of the body")
AS_CHANNEL = "m/s² of accel, rad/s of gyro"
MOUNT = Column("mount", TEXT, "", "of the plan; empty where the campaign has a single one")
METHOD = Column("method", TEXT, "", "method of estimation")
QUANTITY = Column("quantity", TEXT, "", "name of the parameter, such as bias_x")

"""The two sensors of an IMU: their names in tables and in files, channels, units and words."""

from inertial.text.messages import _
from inertial.text.parameters import AXES

SENSORS = ("gyro", "accel")  # as columns call them
FILE_KEYS = {"accel": "accelerometer", "gyro": "gyro"}  # as campaign files call them
UNITS = {"accel": "m/s²", "gyro": "rad/s"}  # of a reading
CHANNELS = tuple(f"{sensor}_{axis}" for sensor in UNITS for axis in AXES)
COLUMNS = {"accel": slice(0, 3), "gyro": slice(3, 6)}  # of a sensor among the channels

SINGULAR = {"accel": _("accelerometer"), "gyro": _("gyro")}
PLURAL = {"accel": _("accelerometers"), "gyro": _("gyros")}


def unit_of(sensor: str, parameter: str) -> str:
    """The SI unit of a bias, scale factor or cross term of a sensor."""
    return UNITS[sensor] if parameter.startswith("bias") else "1"

"""The bytes of a message of ROS 2, by ROS' own definition of it."""

from functools import cache
from typing import Any

from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from stages.formats.bag_imu import IMU


def understood(data: bytes) -> Any:
    """The sensor_msgs/Imu that `data` are; whatever else they are, is an error of rosbags."""
    return _store().deserialize_cdr(data, IMU)


@cache
def _store() -> Typestore:
    return get_typestore(Stores.ROS2_HUMBLE)

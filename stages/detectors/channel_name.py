"""What a channel is called in a sentence."""

from stages.detectors.detector import CHANNELS

SENSORS = {"accel": "accelerometer", "gyro": "gyro"}


def channel_name(channel: int) -> str:
    """Its sensor and axis: accelerometer x, gyro z."""
    sensor, _, axis = CHANNELS[channel].partition("_")
    return f"{SENSORS[sensor]} {axis}"

"""What the bytes of a NovAtel log are: messages, blank lines, and what is refused."""

import numpy as np
from numpy.typing import NDArray

from stages.formats.gps_time import NANOSECONDS, WEEK

Bytes = NDArray[np.uint8]

# What a stretch of bytes is. UNSURE: an IMU message of right checksum whose fields are not as they
# should be; GOES_ON: the beginning of a damage of which more follows.
IMU, OTHER_TEXT, OTHER_BINARY, EMPTY, DAMAGE, GOES_ON, UNSURE = range(7)

# What a reader of messages says instead of the byte after one: more bytes are needed to tell; no
# message begins here. Of a damaged one whose header can be read: its length, negative.
MORE, NOTHING = 0, -1

LAST_WEEK = 9999  # the year 2171: what claims a later one is no week
WEEK_NS = WEEK * NANOSECONDS

Fields = tuple[
    NDArray[np.int64],  # stamp, ns since the start of GPS time, (n,)
    NDArray[np.uint32],  # status word, (n,)
    NDArray[np.int32],  # counts as sent, (n, 6)
    NDArray[np.int16],  # type of the IMU, −1 where the message does not tell, (n,)
]
STAMP, STATUS, COUNTS, TYPE = range(4)

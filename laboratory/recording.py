"""What a performance leaves: the logs and the campaign's file, and the truth, for tests only."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from laboratory.arrays import Array, Counts
from laboratory.placement import Placement
from laboratory.sensor import Reading


@dataclass(frozen=True)
class LogTruth:
    """What truly happened during one log; n samples, those too that a fault took from it."""

    time: Array  # s since the campaign's first sample, (n,): the end of every sample
    rate: Array  # rad/s, (n, 3), body axes: true mean rate over every sample
    force: Array  # m/s², (n, 3), body axes: true mean specific force over every sample
    noiseless: Reading  # (n, 3) m/s and rad: running integrals of what the sensors read
    noisy: Reading  # the same with the noise
    accelerometer: Counts  # (n, 3): as counted, x y z
    gyro: Counts  # (n, 3)
    rows: Mapping[str, range]  # manoeuvre → its samples, rest before and after a turn included


@dataclass(frozen=True)
class Recording:
    """A campaign as recorded."""

    campaign: Mapping[str, Any]  # what campaign.yaml says
    logs: Mapping[str, bytes]  # name → bytes, in the order in which they were written
    truth: Mapping[str, LogTruth]  # by log
    placements: Mapping[str, Placement]  # by position ("of <id>" where the plan names none)

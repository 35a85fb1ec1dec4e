"""Result of a simulation: the logs, the campaign file, and the truth, for tests only."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from laboratory.arrays import Array, Counts
from laboratory.placement import Placement
from laboratory.receiver import Receiver
from laboratory.records import Records
from laboratory.sensor import Reading


@dataclass(frozen=True)
class LogTruth:
    """The truth during one log, before any fault; n samples."""

    time: Array  # s since the campaign's first sample, (n,): when every sample truly ended
    rate: Array  # rad/s, (n, 3), body axes: true mean rate over every sample
    force: Array  # m/s², (n, 3), body axes: true mean specific force over every sample
    temperature: Array  # K, (n,): of the thermometer, at the end of every sample
    table_angle: Array | None  # rad, (n,): as the encoder reads it; None where there is none
    noiseless: Reading  # (n, 3) m/s and rad: running integrals of what the sensors read
    noisy: Reading  # the same with the noise, after filters, within the range of the sensors
    accelerometer: Counts  # (n, 3): as counted, x y z
    gyro: Counts  # (n, 3)
    rows: Mapping[str, range]  # manoeuvre → its samples, rest before and after a turn included


@dataclass(frozen=True)
class Spoiled:
    """Consecutive records of a log, as written, that one fault has changed.

    Records are numbered from 0, so that record k is in line k + 1. Where records are missing, or
    time goes back, it is the one record after the jump of the stamps. Records that a later fault
    removes are not listed; those that it overwrites are.
    """

    fault: str  # its name in the specification
    log: str  # the name under which it was written
    first: int
    after: int  # the record after the last
    first_stamp: int  # ns since the start of GPS time, as written
    last_stamp: int


@dataclass(frozen=True)
class Recording:
    """A campaign as recorded."""

    campaign: Mapping[str, Any]  # what campaign.yaml says
    receiver: Receiver
    start: int  # ns since the start of GPS time: the campaign's first sample
    records: Mapping[str, Records]  # name → what is written, in the order of writing
    truth: Mapping[str, LogTruth]  # by log, before any fault: also before an exchange of names
    placements: Mapping[str, Placement]  # by position ("of <id>" where the plan names none)
    spoiled: Sequence[Spoiled]  # by log, then by fault in order, then by record

    @cached_property
    def logs(self) -> dict[str, bytes]:
        """The bytes of every log, computed at first use."""
        return {
            log: self.receiver.log_bytes(records, self.start)
            for log, records in self.records.items()
        }

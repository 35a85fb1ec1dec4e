"""The receiver: it writes times, counts of the six channels and, as columns, the temperature."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from laboratory import columns, rawimu
from laboratory.arrays import Array, Counts
from laboratory.counts import count, rounded
from laboratory.gps_time import NANOSECONDS
from laboratory.rawimu import Samples
from laboratory.records import Records

COLUMNS = "columns"  # the message that is a table of text


@dataclass(frozen=True)
class Receiver:
    """The receiver that writes the logs."""

    message: str
    step: int  # ns from sample to sample
    gyro_count: float  # rad
    accelerometer_count: float  # m/s
    status: str
    line_end: bytes
    encoder: bool  # whether the angle of the table is a column
    imu_type: int  # by NovAtel's list; in the messages with X
    carries: bool = True  # whether what a count leaves over goes into the next

    @classmethod
    def specified(cls, written: Mapping[str, Any], encoder: bool = False) -> "Receiver":
        """The receiver that simulated.schema.yaml describes."""
        return cls(
            written["message"],
            round(NANOSECONDS / written["rate_hz"]),
            written["gyro_count_rad"],
            written["accelerometer_count_m_s"],
            written["status"],
            {"crlf": b"\r\n", "lf": b"\n"}[written["line_end"]],
            encoder,
            written.get("imu_type", 0),
            written.get("carries", True),
        )

    @property
    def interval(self) -> float:
        """Time from sample to sample by its own clock, s."""
        return self.step / NANOSECONDS

    def counted(self, running: Array, size: float) -> Counts:
        """The counts of each sample, by the running integral of the reading, (n, 3)."""
        return count(running, size) if self.carries else rounded(running, size)

    def records(self, samples: Samples, temperature: Array, table_angle: Array | None) -> Records:
        """A log before any fault; temperature: (n,), K; table_angle: (n,), rad, if recorded."""
        return Records(
            stamps=samples.stamps,
            counts=np.hstack([samples.accelerometer, samples.gyro]),
            ends=samples.stamps,
            temperature=temperature,
            table_angle=table_angle,
            units=np.repeat([self.accelerometer_count, self.gyro_count], 3) / self.interval,
            interval=self.interval,
        )

    def log_bytes(self, records: Records, start: int) -> bytes:
        """A log as it is written; start: ns since the start of GPS time, the campaign's first."""
        if self.message == COLUMNS:
            return columns.log_bytes(records, start, self.line_end)
        fixed = (self.message, self.status, self.line_end, self.imu_type)
        return rawimu.log_bytes(records.samples, *fixed)

    @property
    def format(self) -> dict[str, Any] | None:
        """How a campaign file describes its logs; None where the instrument does."""
        if self.message != COLUMNS:
            return None
        rate, force = self.interval / self.gyro_count, self.interval / self.accelerometer_count
        return columns.layout(rate, force, self.encoder)

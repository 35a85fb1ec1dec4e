"""The angle of the table at the samples of the IMU, by the log of its encoder."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from inertial.arrays import Array
from inertial.formats.columns.encoder_log import Encoder
from inertial.formats.gps_time import WEEK
from stages.decode.decoded import path_of

ANGLE_UNITS = {"deg": math.radians(1), "rad": 1.0}


class Continuous:
    """An angle without its jumps by whole turns, piece by piece; NaN where it is not known."""

    def __init__(self) -> None:
        self._last = math.nan

    def __call__(self, angle: Array) -> Array:
        """The next piece, (n,), rad."""
        result = np.array(angle, dtype=np.float64)
        known = np.flatnonzero(np.isfinite(result))
        if len(known):
            before = [] if math.isnan(self._last) else [self._last]
            whole = np.unwrap(np.concatenate([before, result[known]]), period=2 * math.pi)
            result[known] = whole[len(before) :]
            self._last = float(whole[-1])
        return result


@dataclass(frozen=True)
class TableAngle:
    """The encoder's log of a campaign: its file, GPS week or none, and what its time lacks, s."""

    file: str
    encoder: Encoder
    week: int | None
    offset: float
    unit: float  # rad

    @classmethod
    def of_logs(cls, rows: Sequence[Mapping[str, str]], raw: list[Path]) -> "TableAngle | None":
        """Of a campaign's logs; None where it has none."""
        stated = json.loads(rows[0]["layout"]).get("encoder") if rows else None
        if stated is None:
            return None
        layout = stated["layout"]
        unit = ANGLE_UNITS[layout["table_angle"]["unit"]]
        encoder = Encoder(path_of(stated["file"], raw), layout, 2 * math.pi / unit)
        return cls(stated["file"], encoder, stated["gps_week"], stated["offset"], unit)

    @property
    def absolute(self) -> bool:
        """Whether its clock is GPS time."""
        return self.week is not None

    def at(self, time: Array) -> Array:
        """The angle at times of the IMU's clock, (n,), rad; NaN where it is not known."""
        began = (self.week or 0) * WEEK + self.offset
        return self.encoder.angle_at(time - began) * self.unit

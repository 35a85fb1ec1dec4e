"""What the synthetic campaign is: its numbers, and rows as tables."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

GRAVITY = 9.7936174
DEGREE = np.pi / 180
INTERVAL = 0.01
REST_S, TURN_S = 300.0, 58.0
GAP = (21.89, 33.87)
GAP_LINE = 2192  # the first record after it, numbered from 0; lines are numbered from 1
GAP_FINDING = "quality/gap/z-backward.asc/2192"
RINGING_FINDING = "quality/oscillation/gyro_x"
AXES = "xyz"
PAIRS = [(i, j) for i in range(3) for j in range(3) if i != j]
SCALE = {"accel": (3.2852e-4, 3.2826e-4, 2.3567e-4), "gyro": (6.151e-4, -1.62e-5, 6.442e-4)}
CROSS = (0.0021831, 0.0076080, -0.0027442, -0.0007839, -0.0075585, 0.0007016)
BIAS = {"accel": (-0.0052949, 0.0050641, -0.0018790), "gyro": (1.30e-6, -2.10e-6, 0.90e-6)}
NOISE = {"accel": 1.07e-3, "gyro": 3.5e-5}
BATCH = 700  # rows, so that a turn comes in several batches
SENSOR = {"accelerometer": "accel", "gyroscope": "gyro"}
Rows = list[dict[str, Any]]


@dataclass(frozen=True)
class Held:
    """A table that is handed over as a stream."""

    frame: pd.DataFrame

    def columns(self, names: list[str]) -> Iterator[pa.RecordBatch]:
        yield from pa.Table.from_pandas(self.frame[names]).to_batches(max_chunksize=BATCH)


def rows_as(table: Any, rows: Rows) -> pd.DataFrame:
    """Rows in the columns of the contract; what a row omits is a gap, its mount the only one."""
    names = [column.name for column in table.columns]
    unknown = {name for row in rows for name in row} - set(names)
    assert not unknown, unknown
    given = [{"mount": ""} | row for row in rows]
    frame = pd.DataFrame([{name: row.get(name) for name in names} for row in given], columns=names)
    return pd.DataFrame(table.arrow(frame).to_pandas())

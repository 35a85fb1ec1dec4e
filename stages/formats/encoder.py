"""The angle of the table by the log of its encoder, beside the IMU's log.

Between two of its readings the table turns evenly. Where it has none for longer than usual, before
the first and after the last, there is no angle.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.tables.errors import Refusal
from stages.formats import columns
from stages.formats.account import Account, RefusedLine
from stages.formats.column_layout import ticks_per_second

Reals = NDArray[np.float64]

MOST = 20_000_000  # readings, which are held in memory: 320 MB
LONGER = 5.5  # usual intervals without a reading, across which nothing is said


class Encoder:
    """Its readings: time, s, ascending, and angle, as it stands in the log, going on over a turn.

    `whole`: the angle after which it begins anew.

    Raises
    ------
    Refusal
        where it cannot be read, or has more readings than memory should hold
    """

    def __init__(self, path: Path, layout: Mapping[str, Any], whole: float) -> None:
        self.account, self.refused = Account(), list[RefusedLine]()
        ticks, angles, count = list[Reals](), list[Reals](), 0
        for reading in columns.read(path, layout):
            self.account.add_account(reading.account)
            self.refused += reading.refused
            rows = reading.records
            if rows.ticks is not None and rows.table_angle is not None:
                ticks.append(rows.ticks)
                angles.append(rows.table_angle)
                count += len(rows.ticks)
            if count > MOST:
                raise Refusal(
                    path.name,
                    "",
                    f"more than {MOST} readings of the encoder",
                    "fewer",
                    "thin them out: between two readings the table turns evenly",
                )
        time = np.concatenate([np.zeros(0), *ticks]) / ticks_per_second(layout)
        ahead = np.diff(time, prepend=-np.inf) > 0  # a time that comes again tells nothing new
        self.time = time[ahead]
        self.angle = np.unwrap(np.concatenate([np.zeros(0), *angles])[ahead], period=whole)

    def angle_at(self, time: Reals) -> Reals:
        """The angle at these times of its clock, (n,), NaN where it is not known."""
        if len(self.time) < 2:
            return np.full(len(time), np.nan)
        step = np.diff(self.time)
        angle = np.interp(time, self.time, self.angle, left=np.nan, right=np.nan)
        between = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(step) - 1)
        angle[step[between] > LONGER * np.median(step)] = np.nan
        return np.asarray(angle)

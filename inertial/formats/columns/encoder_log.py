"""The angle of the table from the log of its encoder, beside the IMU's log.

Between two readings the angle is interpolated linearly. In gaps, before the first reading and after
the last one there is no angle.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.formats.account import Account, RefusedLine
from inertial.formats.columns import column_reader
from inertial.formats.columns.column_layout import ticks_per_second
from inertial.tables.errors import Refusal
from inertial.text.messages import _

MAX_READINGS = 20_000_000  # held in memory: 320 MB
MAX_GAP_INTERVALS = 5.5  # median intervals between two readings that are interpolated


class Encoder:
    """Its readings: time, s, ascending, and angle, in the unit of the log, continuous over turns.

    `turn`: the angle of a whole turn.

    Raises
    ------
    Refusal
        where it cannot be read, or has more readings than memory should hold
    """

    def __init__(self, path: Path, layout: Mapping[str, Any], turn: float) -> None:
        self.account, self.refused = Account(), list[RefusedLine]()
        ticks, angles, count = list[Array](), list[Array](), 0
        for reading in column_reader.read(path, layout):
            self.account.add_account(reading.account)
            self.refused += reading.refused
            rows = reading.records
            if rows.ticks is not None and rows.table_angle is not None:
                ticks.append(rows.ticks.astype(np.float64))
                angles.append(rows.table_angle)
                count += len(rows.ticks)
            if count > MAX_READINGS:
                raise Refusal(
                    path.name,
                    "",
                    _(
                        "more than {max_readings} readings of the encoder",
                        max_readings=MAX_READINGS,
                    ),
                    "fewer",
                    _("thin them out: between two readings the table turns evenly"),
                )
        time = np.concatenate([np.zeros(0), *ticks]) / ticks_per_second(layout)
        later = np.diff(time, prepend=-np.inf) > 0  # of equal times the first counts
        self.time = time[later]
        self.angle = np.unwrap(np.concatenate([np.zeros(0), *angles])[later], period=turn)

    def angle_at(self, time: Array) -> Array:
        """The angle at these times of its clock, (n,), NaN where it is not known."""
        if len(self.time) < 2:
            return np.full(len(time), np.nan)
        step = np.diff(self.time)
        angle = np.interp(time, self.time, self.angle, left=np.nan, right=np.nan)
        between = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(step) - 1)
        angle[step[between] > MAX_GAP_INTERVALS * np.median(step)] = np.nan
        return np.asarray(angle)

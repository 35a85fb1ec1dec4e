"""The times of records whose stamps are those of their arrival: by a regular clock."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.formats.account import Integers
from inertial.formats.columns.data_rows import Rows
from inertial.signal.regular_clock import RegularClock, are_regular, regular_clock
from stages.decode.decoded import Reals


@dataclass(frozen=True)
class Stamped:
    """The stamps of one sensor, for two may come in rows of their own.

    record, ticks: (n,), of its rows; repeated: (n,), which have stamp and readings of the row
    before, so that no sample is taken with them.
    """

    record: Integers
    ticks: Reals | Integers
    repeated: NDArray[np.bool_]

    @classmethod
    def of(cls, rows: Rows, sensor: str) -> "Stamped":
        """The stamps of accelerometer or gyro in some rows of a log with time."""
        own = rows.accelerometer if sensor == "accelerometer" else rows.gyro
        there = np.isfinite(own).any(axis=1)
        all_ticks = np.zeros(0) if rows.ticks is None else rows.ticks  # of a log without rows
        ticks, values = all_ticks[there], np.hstack([rows.accelerometer, rows.gyro])[there]
        repeated = np.append(False, np.diff(ticks) == 0)[: len(ticks)]
        still = np.flatnonzero(repeated)
        same = np.nan_to_num(values[still]) == np.nan_to_num(values[still - 1])
        repeated[still] = same.all(axis=1)
        return cls(rows.record[there], ticks, repeated)

    @classmethod
    def joined(cls, parts: Iterable["Stamped"]) -> "Stamped":
        """Those of consecutive rows."""
        columns = zip(*((each.record, each.ticks, each.repeated) for each in parts), strict=True)
        return cls(*(np.concatenate(column) for column in columns))


class ArrivalTimes:
    """The times of a log's records, s since the first, by the clock of one sensor's samples.

    `first`: the stamp of time 0 by that clock, ticks; `ticks`: in a second.
    """

    def __init__(self, stamped: Stamped, clock: RegularClock, ticks: float) -> None:
        self.clock = clock
        self.first = float(stamped.ticks[0] + clock.start * ticks)
        self._record = stamped.record
        self._time = clock.time[np.cumsum(~stamped.repeated) - 1]

    def of(self, record: Integers) -> Reals:
        """The time of each record, (n,), s; one of the other sensor lies between its neighbours."""
        return np.asarray(np.interp(record, self._record, self._time))


def arrival_times(
    beginning: NDArray[Any], stamps: Callable[[], Iterable[Stamped]], ticks: float
) -> ArrivalTimes | None:
    """The times of a log whose first stamps are not regular; None where these are, or no clock."""
    if are_regular((beginning - beginning[0]) / ticks):
        return None
    stamped = Stamped.joined(stamps())
    clock = regular_clock((stamped.ticks[~stamped.repeated] - stamped.ticks[0]) / ticks)
    return None if clock is None else ArrivalTimes(stamped, clock, ticks)

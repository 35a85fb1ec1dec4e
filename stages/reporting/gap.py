"""A gap by its two lines: the record before it and the record after it."""

from __future__ import annotations

import numpy as np
import pandas as pd

from inertial.tables import AXES
from inertial.text import numbers
from inertial.text.units import DEGREES_PER_SECOND, METRES
from stages.reporting.close_ups import CloseUp, gaps_in
from stages.reporting.outline import Column, Row, Table

# As many decimals as show a count of a good instrument.
SENSORS = (("gyro", "Gyro", DEGREES_PER_SECOND, 4), ("accel", "Accelerometer", METRES, 5))


def two_records(close_up: CloseUp, gaps: pd.DataFrame) -> Table | None:
    """Line, time and six readings on both sides of the longest gap that is close up."""
    after = gaps_in(close_up, gaps)
    if not after:
        return None
    i = max(after, key=lambda place: close_up.time[place] - close_up.time[place - 1])
    columns = [Column(""), Column("Line", "number"), Column("Time, s", "number")]
    cells = [["before", "after"]]
    cells.append([numbers.whole(int(close_up.line[place])) for place in (i - 1, i)])
    cells.append([numbers.fixed(float(close_up.time[place]), 3) for place in (i - 1, i)])
    for sensor, name, unit, decimals in SENSORS:
        for axis in AXES:
            values = close_up.values[f"{sensor}_{axis}"][[i - 1, i]] / unit.size
            if np.isfinite(values).any():
                columns.append(Column(axis, "number", f"{name}, {unit.name}"))
                cells.append([numbers.fixed(float(value), decimals) for value in values])
    rows = tuple(Row(tuple(texts)) for texts in zip(*cells, strict=True))
    return Table("The record before the gap and the record after it.", tuple(columns), rows)

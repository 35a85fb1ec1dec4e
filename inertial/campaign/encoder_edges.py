"""The angle of the table's encoder where stretches of the records of a log begin and end."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.campaign.masked_samples import Batch
from inertial.campaign.sums import Stretches, rows_in

EDGE_SAMPLES = 8  # by which the rate of the table at the edge of a block is known


@dataclass(frozen=True)
class Edges:
    """The encoder's angle, rad, and rate, rad/s, at the beginning and end of k stretches, (k,)."""

    angle_from: Array
    angle_to: Array
    rate_from: Array
    rate_to: Array


class EdgesOver:
    """The angle of the table's encoder where stretches of records begin and end.

    It is read at the end of a sample; where the first one began it was by its rate, which is that
    of a parabola through the first samples.
    """

    columns = ("time", "table_angle")

    def __init__(self, stretches: Stretches) -> None:
        self._stretches = stretches
        self._ends: dict[str, dict[int, tuple[Array, Array]]] = {log: {} for log in stretches}

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        read = np.column_stack([batch["time"], batch["table_angle"]])
        for k, start, end in stretches_with_angle(batch, self._stretches):
            own = self._ends[batch.log]
            first, last = own.get(k, (read[:0], read[:0]))
            more = read[start : min(end, start + EDGE_SAMPLES - len(first))]
            tail = np.concatenate([last, read[max(start, end - EDGE_SAMPLES) : end]])
            own[k] = np.concatenate([first, more]), tail[-EDGE_SAMPLES:]

    def result(self) -> dict[str, Edges]:
        """By log, in the order of the stretches; NaN where the encoder gives nothing."""
        result = {}
        for log, (first, _after) in self._stretches.items():
            found = np.full((len(first), 4), np.nan)
            for k, (head, tail) in self._ends[log].items():
                step = (tail[-1, 0] - tail[0, 0]) / max(len(tail) - 1, 1)
                found[k, [0, 2]] = _at_edge(head, head[0, 0] - step)
                found[k, [1, 3]] = _at_edge(tail, tail[-1, 0])
            result[log] = Edges(*found.T)
        return result


def stretches_with_angle(batch: Batch, stretches: Stretches) -> Iterator[tuple[int, int, int]]:
    """The stretches of which a batch with the encoder's angle has rows [start, end)."""
    if np.isnan(batch["table_angle"]).all():
        return
    if found := rows_in(batch, stretches):
        for k, start, end in zip(found.stretches, found.starts, found.ends, strict=True):
            yield int(k), int(start), int(end)


def _at_edge(read: Array, time: float) -> tuple[float, float]:
    """Angle and rate at an edge by samples next to it: n times and angles, (n, 2)."""
    if len(read) < 4 or not np.isfinite(read).all():
        return np.nan, np.nan
    near = int(np.argmin(np.abs(read[:, 0] - time)))
    curved, rate, _angle = np.polyfit(read[:, 0] - time, read[:, 1], 2)
    ago = float(read[near, 0] - time)
    return float(read[near, 1] - rate * ago - curved * ago**2), float(rate)

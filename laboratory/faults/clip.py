"""Saturation of a channel."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.channels import column, in_its_unit
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Clip(Fault):
    """What is beyond ± `limit`, m/s² or rad/s, reads the limit, to the next count.

    Counted from zero; or `from_mean`, from the magnitude of the mean reading of these lines, so
    that a limit of less than its noise cuts that off, wherever the IMU stands.
    Marked: the records that read something else before.
    """

    name: ClassVar[str] = "clip"
    channel: int
    limit: float
    from_mean: bool = False

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters["log"],
            Lines.specified(parameters),
            column(parameters["channel"]),
            in_its_unit(parameters, "limit"),
            parameters.get("counted_from", "zero") == "mean",
        )

    def change(self, records: Records) -> Records:
        rows = self.lines.rows(len(records))
        counts = records.counts.copy()
        mean = abs(counts[rows, self.channel].mean()) if self.from_mean else 0.0
        limit = int(np.rint(mean + self.limit / records.units[self.channel]))
        counts[rows, self.channel] = np.clip(counts[rows, self.channel], -limit, limit)
        clipped = np.flatnonzero(counts[:, self.channel] != records.counts[:, self.channel])
        return replace(records, counts=counts).marked(self.name, clipped)

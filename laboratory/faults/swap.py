"""Exchanged axes."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from laboratory.channels import column_of
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Swap(Fault):
    """Two axes of the accelerometers or of the gyros are exchanged."""

    name: ClassVar[str] = "swap"
    channels: tuple[int, int]

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        one, other = (column_of(parameters["sensor"], axis) for axis in parameters["axes"])
        return cls(parameters["log"], Lines.specified(parameters), (one, other))

    def change(self, records: Records) -> Records:
        rows = self.lines.rows(len(records))
        one, other = self.channels
        counts = records.counts.copy()
        counts[rows, one], counts[rows, other] = records.counts[rows][:, [other, one]].T
        return replace(records, counts=counts).marked(self.name, rows)

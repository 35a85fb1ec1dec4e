"""Wrong sign of an axis."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from laboratory.channels import column_of
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Flip(Fault):
    """One axis of the accelerometers or of the gyros has the wrong sign."""

    name: ClassVar[str] = "flip"
    channel: int

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        channel = column_of(parameters["sensor"], parameters["axis"])
        return cls(parameters["log"], Lines.specified(parameters), channel)

    def change(self, records: Records) -> Records:
        rows = self.lines.rows(len(records))
        counts = records.counts.copy()
        counts[rows, self.channel] *= -1
        return replace(records, counts=counts).marked(self.name, rows)

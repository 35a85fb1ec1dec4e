"""Clock set back."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.gps_time import NANOSECONDS
from laboratory.records import Records


@dataclass(frozen=True)
class TurnBack(Fault):
    """From `line` on all stamps are earlier by `back`, ns. Marked: the record of `line`."""

    name: ClassVar[str] = "turn_back"
    back: int

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        back = round(parameters["seconds"] * NANOSECONDS)
        return cls(parameters["log"], Lines.specified(parameters), back)

    def change(self, records: Records) -> Records:
        rows = self.lines.rows(len(records))
        stamps = records.stamps.copy()
        stamps[rows] -= self.back
        return replace(records, stamps=stamps).jumped(self.name, [int(rows[0])])

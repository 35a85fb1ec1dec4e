"""Single missing records."""

from dataclasses import dataclass
from typing import ClassVar

from laboratory.faults.fault import Fault
from laboratory.records import Records


@dataclass(frozen=True)
class Drop(Fault):
    """Each of `lines` is missing; time continues. Marked: the record after each gap."""

    name: ClassVar[str] = "drop"

    def change(self, records: Records) -> Records:
        return records.without(self.name, self.lines.rows(len(records)))

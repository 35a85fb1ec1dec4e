"""A gap: consecutive missing samples."""

from dataclasses import dataclass
from typing import ClassVar

from laboratory.faults.fault import Fault
from laboratory.records import Records


@dataclass(frozen=True)
class Lose(Fault):
    """The lines `line` … `line + samples − 1` are missing; time continues.

    Marked: the record after the gap; none at the end of a log.
    """

    name: ClassVar[str] = "lose"

    def change(self, records: Records) -> Records:
        return records.without(self.name, self.lines.rows(len(records)))

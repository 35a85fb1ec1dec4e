"""A stretch of samples that was never written."""

from dataclasses import dataclass
from typing import ClassVar

from laboratory.faults.fault import Fault
from laboratory.records import Records


@dataclass(frozen=True)
class Lose(Fault):
    """The lines `line` … `line + samples − 1` are missing; time goes on without them.

    Touched: the record after the gap, which no one is at the end of a log.
    """

    name: ClassVar[str] = "lose"

    def spoils(self, records: Records) -> Records:
        return records.without(self.name, self.lines.rows(len(records)))

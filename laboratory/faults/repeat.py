"""A record that is written again and again."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Repeat(Fault):
    """The record of `line` comes `samples` more times, right after itself.

    running: False: with the same stamp, and the log is longer by so many lines; True: in place
    of the readings of the records that follow, whose stamps go on. Touched: the repetitions.
    """

    name: ClassVar[str] = "repeat"
    running: bool

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        running = parameters["stamps"] == "running"
        return cls(parameters["log"], Lines.specified(parameters), running)

    @property
    def last_line(self) -> int:
        return self.lines.last + 1 if self.running else self.lines.numbers[0]

    def spoils(self, records: Records) -> Records:
        repetitions = self.lines.rows(len(records)) + 1
        row = int(repetitions[0]) - 1
        if self.running:
            counts = records.counts.copy()
            counts[repetitions] = counts[row]
            repeated = replace(records, counts=counts)
        else:
            rows = np.arange(len(records))
            repeated = records.at(np.insert(rows, row, np.full(len(repetitions), row)))
        return repeated.touched(self.name, repetitions)

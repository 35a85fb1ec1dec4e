"""Repeated records."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Repeat(Fault):
    """The record of `line` is written `samples` more times, directly after itself.

    running: False: with the same stamp, and the log is longer by `samples` lines; True: instead
    of the readings of the following records, whose stamps continue. Marked: the repetitions.
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

    def change(self, records: Records) -> Records:
        repetitions = self.lines.rows(len(records)) + 1
        row = int(repetitions[0]) - 1
        if self.running:
            counts = records.counts.copy()
            counts[repetitions] = counts[row]
            repeated = replace(records, counts=counts)
        else:
            rows = np.arange(len(records))
            repeated = records.at(np.insert(rows, row, np.full(len(repetitions), row)))
        return repeated.marked(self.name, repetitions)

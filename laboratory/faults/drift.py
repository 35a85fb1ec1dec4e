"""Time stamps with a rate error."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Drift(Fault):
    """For `samples` intervals after the record of `line` the stamps run fast by `excess`, 1.

    Afterwards they run at the right rate with that offset. Marked: the records at the ends of
    these intervals; the stamp of `line` is still right.
    """

    name: ClassVar[str] = "drift"
    excess: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["log"], Lines.specified(parameters), parameters["ppm"] * 1e-6)

    @property
    def last_line(self) -> int:
        return self.lines.last if self.lines.onwards else self.lines.last + 1

    def change(self, records: Records) -> Records:
        rows = self.lines.rows(len(records))
        first, last = int(rows[0]), min(int(rows[-1]) + 1, len(records) - 1)
        inside = records.stamps[np.clip(np.arange(len(records)), first, last)]
        offset = np.rint(self.excess * (inside - records.stamps[first])).astype(np.int64)
        fast = replace(records, stamps=records.stamps + offset)
        return fast.marked(self.name, np.arange(first + 1, last + 1))

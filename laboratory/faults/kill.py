"""A dead axis."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

from laboratory.channels import column
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Kill(Fault):
    """From `line` on one channel has zero counts or, frozen, always those of `line`."""

    name: ClassVar[str] = "kill"
    channel: int
    frozen: bool

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters["log"],
            Lines.specified(parameters),
            column(parameters["channel"]),
            parameters["reads"] == "frozen",
        )

    def change(self, records: Records) -> Records:
        rows = self.lines.rows(len(records))
        counts = records.counts.copy()
        counts[rows, self.channel] = counts[rows[0], self.channel] if self.frozen else 0
        return replace(records, counts=counts).marked(self.name, rows)

"""What a fault of the recording may change, after the IMU has measured."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Self

import numpy as np

from laboratory.faults.lines import Lines
from laboratory.records import Records

ALL: Final = "all"  # in place of a log's name


@dataclass(frozen=True)
class Fault:
    """One fault of a recording: each class overrides the methods it needs.

    Faults are applied one after another, each to the logs as changed by those before.
    """

    name: ClassVar[str]
    log: str  # the log that it changes, or `all`: each of them
    lines: Lines

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        """The fault that simulated.schema.yaml describes."""
        return cls(parameters["log"], Lines.specified(parameters))

    @property
    def logs(self) -> tuple[str, ...]:
        """The logs that it names."""
        return (self.log,)

    @property
    def last_line(self) -> int:
        """The last line that each of its logs must have."""
        return self.lines.last

    def apply(
        self, logs: Mapping[str, Records], generators: Mapping[str, np.random.Generator]
    ) -> dict[str, Records]:
        """All logs of the campaign after the fault; `generators`: of random numbers, by log."""
        return {
            name: self.change_randomly(self.change(records), generators[name])
            if self.log in (ALL, name)
            else records
            for name, records in logs.items()
        }

    def change(self, records: Records) -> Records:
        """One log after the fault."""
        return records

    def change_randomly(self, records: Records, generator: np.random.Generator) -> Records:
        """One log after the random part of the fault."""
        return records

"""What can go wrong with a recording after the IMU has done its work."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Self

import numpy as np

from laboratory.faults.lines import Lines
from laboratory.records import Records

ALL: Final = "all"  # in place of a log's name


@dataclass(frozen=True)
class Fault:
    """One fault of a recording: it overrides what it does, and leaves the rest alone.

    Faults strike one after another, and each finds the logs as those before have left them.
    """

    name: ClassVar[str]
    log: str  # the log that it spoils, or `all`: each of them
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

    def strikes(
        self, logs: Mapping[str, Records], generators: Mapping[str, np.random.Generator]
    ) -> dict[str, Records]:
        """All logs of the campaign after it; what falls by chance has a generator by log."""
        return {
            name: self.scatters(self.spoils(records), generators[name])
            if self.log in (ALL, name)
            else records
            for name, records in logs.items()
        }

    def spoils(self, records: Records) -> Records:
        """What it makes of one log."""
        return records

    def scatters(self, records: Records, generator: np.random.Generator) -> Records:
        """What it makes of one log by chance."""
        return records

"""Two logs under each other's names."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Exchange(Fault):
    """The log of one name is handed over under the other's, and the other way round.

    Faults after it that name a log find under this name what is handed over under it.
    Touched: all records of both.
    """

    name: ClassVar[str] = "exchange"
    other: str

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        log, other = parameters["logs"]
        return cls(log, Lines.specified(parameters), other)

    @property
    def logs(self) -> tuple[str, ...]:
        return (self.log, self.other)

    @property
    def last_line(self) -> int:
        return 0  # also an empty log can be exchanged

    def strikes(
        self, logs: Mapping[str, Records], generators: Mapping[str, np.random.Generator]
    ) -> dict[str, Records]:
        one, other = (
            logs[name].touched(self.name, np.arange(len(logs[name]))) for name in self.logs
        )
        return {**logs, self.log: other, self.other: one}

"""Exchanged names of two logs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Exchange(Fault):
    """Each of two logs is written under the name of the other.

    Later faults that name a log refer to the name under which it is written.
    Marked: all records of both.
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

    def apply(
        self, logs: Mapping[str, Records], generators: Mapping[str, np.random.Generator]
    ) -> dict[str, Records]:
        one, other = (
            logs[name].marked(self.name, np.arange(len(logs[name]))) for name in self.logs
        )
        return {**logs, self.log: other, self.other: one}

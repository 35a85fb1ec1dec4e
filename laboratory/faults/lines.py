"""Which lines of a log a fault changes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Counts


@dataclass(frozen=True)
class Lines:
    """Lines of a log, counted from 1 in the log before the fault."""

    numbers: Sequence[int]  # ascending, at least one
    onwards: bool  # from that single number to the end of the log

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        """`lines` one by one; or `samples` lines from `line` on, or all from `line` on."""
        if "lines" in parameters:
            return cls(sorted(parameters["lines"]), onwards=False)
        line = parameters.get("line", 1)
        numbers = range(line, line + parameters.get("samples", 1))
        return cls(numbers, onwards="samples" not in parameters)

    @property
    def last(self) -> int:
        """The last line that the log must have."""
        return self.numbers[-1]

    def rows(self, length: int) -> Counts:
        """Their rows in a log of so many records, counted from 0, (k,)."""
        if self.onwards:
            return np.arange(self.last - 1, length)
        return np.array(self.numbers) - 1

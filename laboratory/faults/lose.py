"""A stretch of samples that was never written."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.rawimusa import Samples


@dataclass(frozen=True)
class Lose:
    """The lines `line` … `line + samples − 1` are missing; time goes on without them.

    line: counted from 1 in the log as it would be without this fault.
    """

    log: str
    line: int
    samples: int

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["log"], parameters["line"], parameters["samples"])

    def spoils(self, samples: Samples) -> Samples:
        lost = slice(self.line - 1, self.line - 1 + self.samples)
        kept = np.ones(len(samples.stamps), dtype=bool)
        kept[lost] = False
        return Samples(samples.stamps[kept], samples.accelerometer[kept], samples.gyro[kept])

"""Jitter or rounding of the time stamps."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.gps_time import NANOSECONDS
from laboratory.records import Records


@dataclass(frozen=True)
class Jitter(Fault):
    """Every stamp has a random error, or is the nearest multiple of `unit`; samples are unchanged.

    sigma: standard deviation of a stamp, ns, independent, normal; unit: ns. Zero: none.
    """

    name: ClassVar[str] = "jitter"
    sigma: float
    unit: int

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters["log"],
            Lines.specified(parameters),
            parameters.get("sigma_s", 0.0) * NANOSECONDS,
            round(parameters.get("rounded_to_s", 0.0) * NANOSECONDS),
        )

    def change_randomly(self, records: Records, generator: np.random.Generator) -> Records:
        rows = self.lines.rows(len(records))
        stamps = records.stamps.copy()
        if self.sigma:
            scatter = np.rint(self.sigma * generator.standard_normal(len(rows)))
            stamps[rows] += scatter.astype(np.int64)
        if self.unit:
            stamps[rows] = (stamps[rows] + self.unit // 2) // self.unit * self.unit
        return replace(records, stamps=stamps).marked(self.name, rows)

"""Temperature of the IMU in the course of a campaign."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.instants import Instants
from laboratory.units import HOUR, ICE_POINT


@dataclass(frozen=True)
class Temperature:
    """T(t) = start + slope t + rise (1 − exp(−t / time constant)) + step, from its moment on.

    t: s since the campaign's first sample, through all logs and the pauses between.
    """

    start: float  # K
    slope: float  # K/s
    rise: float  # K, of the warm-up
    time_constant: float  # s
    step: float  # K
    moment: float  # s
    reference: float  # K: at which `truth` specifies M and bias

    @classmethod
    def specified(cls, written: Mapping[str, Any]) -> Self:
        """The course that simulated.schema.yaml describes."""
        start = written["start_deg_c"] + ICE_POINT
        reference = written.get("reference_deg_c", written["start_deg_c"]) + ICE_POINT
        warm_up = written.get("warm_up", {"rise_k": 0.0, "time_constant_s": 1.0})
        step = written.get("step", {"size_k": 0.0, "at_s": 0.0})
        return cls(
            start,
            written.get("slope_k_h", 0.0) / HOUR,
            warm_up["rise_k"],
            warm_up["time_constant_s"],
            step["size_k"],
            step["at_s"],
            reference,
        )

    def course(self, instants: Instants) -> Array:
        """T at the instants, (m,), K."""
        time = instants.time
        warm_up = self.rise * -np.expm1(-time / self.time_constant)
        course: Array = self.start + self.slope * time + warm_up
        return course + self.step * instants.since(self.moment) if self.step else course

    def above(self, instants: Instants) -> Array:
        """T less the reference at the instants, (m,), K."""
        return self.course(instants) - self.reference

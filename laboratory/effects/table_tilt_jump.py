"""Tilt of the table that sets in at once."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.rotation import rotation_of, seen_from
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class TableTiltJump(Effect):
    """The base of the table, with all its axes, is tilted from a moment on, s.

    tilt: R, (3, 3), in the level frame, as of a tilt that is always there. What is fixed to the
    ground, gravity and the earth's rate v, is then seen as Cᵀ Rᵀ v. No sample has the motion
    itself: it is over before the next position.
    """

    tilt: Array
    moment: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        north, east = (parameters[key] * ARCSECOND for key in ("north_arcsec", "east_arcsec"))
        return cls(rotation_of(np.array([-north, east, 0.0])), parameters["at_s"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        motion = truth.motion
        since = motion.instants.since(self.moment)[:, None]
        force, rate = (
            seen_from(motion.attitude, np.einsum("nij,nj->ni", motion.attitude, v) @ self.tilt) - v
            for v in (truth.force, truth.rate - motion.rate)
        )
        return Reading(
            since * sensors.accelerometer.project(force), since * sensors.gyro.project(rate)
        )

"""What errors of the table's angle that repeat with every revolution have in common."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from laboratory.arrays import Array
from laboratory.chance import Chance
from laboratory.effects.effect import Effect
from laboratory.harmonic import Harmonic
from laboratory.instants import Instants
from laboratory.manoeuvre import Manoeuvre
from laboratory.motion import Turning
from laboratory.rotation import rotation_about


@dataclass(frozen=True)
class PeriodicAngle(Effect):
    """The true angle is θ + ψ(θ), θ the angle of the scale since the start; error: ψ, rad."""

    error: Harmonic

    def change_rotations(
        self, turnings: Sequence[Turning], instants: Instants
    ) -> Sequence[Turning]:
        if not turnings or not turnings[0].planned:
            return turnings
        return [self.error_at(turnings[0]).added_to(turnings[0]), *turnings[1:]]

    def error_at(self, table: Turning) -> Harmonic:
        """The error while the table turns."""
        return self.error

    def position_error(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        angle = 0.0 if manoeuvre.step is None else manoeuvre.step.angle
        further = self.error.value(np.asarray(angle))
        return rotation_about(set_attitude @ manoeuvre.about, further)

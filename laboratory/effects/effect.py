"""What a hidden effect may do: an effect overrides what it does, and leaves the rest alone."""

from collections.abc import Sequence

import numpy as np

from laboratory.arrays import Array
from laboratory.instants import Instants
from laboratory.motion import Motion, Turning
from laboratory.sensor import Reading
from laboratory.truth import Pull, Truth


class Effect:
    """One way in which the IMU, its table or its site is not ideal.

    An effect is made anew for every performance, from parameters in SI and radians, and is asked
    stretch by stretch in the order of time. Zero parameters mean that it is absent.
    """

    def tilts(self) -> Array:
        """How the base of the table stands in the level frame: a rotation, (3, 3)."""
        return np.eye(3)

    def carries(self, instants: Instants) -> Sequence[Turning]:
        """Rotations of the whole table, what stands on it included; axes in the level frame."""
        return []

    def moves(self, turnings: Sequence[Turning], instants: Instants) -> Sequence[Turning]:
        """The rotations of the case, given those that the plan and the effects before it ask for.

        The table's own is the first; there is none while the table stands.
        """
        return turnings

    def pulls(self, motion: Motion) -> Pull | None:
        """A specific force that the motion causes."""
        return None

    def reads(self, truth: Truth) -> Reading | None:
        """What it adds to the reading at the instants: (m, 3) m/s² and (m, 3) rad/s."""
        return None

    def scatters(self, truth: Truth, generator: np.random.Generator) -> Reading | None:
        """Noise that it adds to the increments of the samples: (n, 3) m/s and (n, 3) rad."""
        return None

"""What a hidden effect may do: an effect overrides what it does, and leaves the rest alone."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.arrays import Array, Counts
from laboratory.chance import Chance
from laboratory.instants import Instants
from laboratory.manoeuvre import Manoeuvre
from laboratory.motion import Motion, Turning
from laboratory.profiles import Profile
from laboratory.sensor import Reading, Sensors
from laboratory.site import Site
from laboratory.truth import Pull, Truth


class Effect:
    """One way in which the IMU, its table or its site is not ideal.

    An effect is made anew for every performance, from parameters in SI and radians, and is asked
    stretch by stretch in the order of time. Zero parameters mean that it is absent.
    """

    # ---- the site and the clock

    def stands(self, site: Site) -> Site:
        """The place as it truly is, where the laboratory takes it for `site`."""
        return site

    def ticks(self) -> float:
        """Seconds that truly pass while the receiver's clock says one."""
        return 1.0

    def stamps(self, stamps: Counts) -> Counts:
        """The times that are written, (n,), ns since the campaign's first sample."""
        return stamps

    # ---- the table

    def tilts(self, manoeuvre: Manoeuvre, set_attitude: Array) -> Array:
        """How the table, its axis included, leans in the level frame: a rotation, (3, 3).

        Asked once for every position; set_attitude: of the IMU, level from body, (3, 3).
        """
        return np.eye(3)

    def misses(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        """How far the IMU stands from its set attitude on the table: a rotation, (3, 3), as above.

        Unlike a lean of the table it goes along with a turn.
        """
        return np.eye(3)

    def sets(self, profile: Profile) -> Profile:
        """The turn that the table makes when it is set to `profile`."""
        return profile

    def moves(self, turnings: Sequence[Turning], instants: Instants) -> Sequence[Turning]:
        """The rotations of the case, given those that the plan and the effects before it ask for.

        The table's own is the first; there is none while the table stands.
        """
        return turnings

    def carries(
        self, turnings: Sequence[Turning], attitude: Array, instants: Instants
    ) -> Sequence[Turning]:
        """Rotations of the whole table, what stands on it included; axes in the level frame.

        turnings: those of the case; attitude: of the case before them, (3, 3), level from body.
        """
        return []

    # ---- the IMU

    def delays(self) -> float:
        """Seconds by which the gyros lag behind."""
        return 0.0

    def pulls(self, motion: Motion, sensors: Sensors) -> Pull | None:
        """A specific force that the motion causes."""
        return None

    def reads(self, truth: Truth, sensors: Sensors) -> Reading | None:
        """What it adds to the reading at the instants: (m, 3) m/s² and (m, 3) rad/s."""
        return None

    def scatters(self, truth: Truth, generator: np.random.Generator) -> Reading | None:
        """Noise that it adds to the increments of the samples: (n, 3) m/s and (n, 3) rad."""
        return None

    def limits(self, increments: Reading, interval: float) -> Reading:
        """What is left of the increments, noise included, (n, 3) m/s and (n, 3) rad."""
        return increments


@dataclass
class ScalarEffect(Effect):
    """An effect of one number: that of KEY in the specification, given in UNIT."""

    KEY: ClassVar[str]
    UNIT: ClassVar[float]
    value: float  # SI and radians

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters[cls.KEY] * cls.UNIT)


@dataclass
class ArrayEffect(Effect):
    """An effect of three numbers or a matrix: those of KEY in the specification, given in UNIT."""

    KEY: ClassVar[str]
    UNIT: ClassVar[float]
    value: Array  # SI and radians

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters[cls.KEY], dtype=float) * cls.UNIT)

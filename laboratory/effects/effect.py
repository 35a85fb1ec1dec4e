"""What a hidden effect may change: each effect overrides the methods it needs."""

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
from laboratory.truth import ExtraForce, Truth


class Effect:
    """One way in which the IMU, its table or its site is not ideal.

    An effect is created for every simulation, from parameters in SI and radians, and is called
    segment by segment in the order of time. With zero parameters it is absent.
    """

    of_scale: ClassVar[bool] = False  # whether it is an error of the scale that the encoder reads

    # ---- the site and the clock

    def true_site(self, site: Site) -> Site:
        """The true site, where the campaign states `site`."""
        return site

    def clock_ratio(self) -> float:
        """True seconds per second of the receiver clock."""
        return 1.0

    def stamps(self, stamps: Counts) -> Counts:
        """The written time stamps, (n,), ns since the campaign's first sample."""
        return stamps

    # ---- the table

    def table_tilt(self, manoeuvre: Manoeuvre, set_attitude: Array) -> Array:
        """Tilt of the table, its axis included, in the level frame: a rotation, (3, 3).

        Called once for every position; set_attitude: of the IMU, level from body, (3, 3).
        """
        return np.eye(3)

    def position_error(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        """Error of the attitude of the IMU on the table: a rotation, (3, 3), as above.

        Unlike a tilt of the table it turns with the IMU.
        """
        return np.eye(3)

    def later_error(self, manoeuvre: Manoeuvre, set_attitude: Array, set_at: float) -> Array:
        """Error of the attitude where the position is set at a time: a rotation, as above.

        set_at: s since the campaign's first sample.
        """
        return np.eye(3)

    def axis_error(
        self, manoeuvre: Manoeuvre, set_attitude: Array, set_at: float, chance: Chance
    ) -> Array:
        """The part of these two by which the axis of the turn leans too: a rotation."""
        return np.eye(3)

    def actual_profile(self, profile: Profile) -> Profile:
        """The actual course of a turn that is set to `profile`."""
        return profile

    def actual_turn(self, manoeuvre: Manoeuvre, profile: Profile) -> Profile:
        """The actual course of one turn, where the effects before it make it `profile`."""
        return self.actual_profile(profile)

    def change_rotations(
        self, turnings: Sequence[Turning], instants: Instants
    ) -> Sequence[Turning]:
        """The rotations of the case, given those of the plan and of the effects before it.

        That of the table is the first; there is none while the table is at rest.
        """
        return turnings

    def table_rotations(
        self, turnings: Sequence[Turning], attitude: Array, instants: Instants
    ) -> Sequence[Turning]:
        """Rotations of the whole table with the IMU; axes in the level frame.

        turnings: those of the case; attitude: of the case before them, (3, 3), level from body.
        """
        return []

    # ---- the IMU

    def begin_log(self, generator: np.random.Generator) -> None:
        """Called before the first sample of each log; `generator`: that of the log's noise."""

    def gyro_delay(self) -> float:
        """Delay of the gyros, s."""
        return 0.0

    def accelerometer_delay(self) -> float:
        """Delay of the accelerometers, s."""
        return 0.0

    def extra_force(self, motion: Motion, sensors: Sensors) -> ExtraForce | None:
        """Additional specific force that the motion causes."""
        return None

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading | None:
        """Error of the readings at the instants: (m, 3) m/s² and (m, 3) rad/s."""
        return None

    def noise(self, truth: Truth, generator: np.random.Generator) -> Reading | None:
        """Noise of the increments of the samples: (n, 3) m/s and (n, 3) rad."""
        return None

    def recorded_increments(self, increments: Reading, interval: float) -> Reading:
        """The increments of the samples after filters and within the range, noise included."""
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

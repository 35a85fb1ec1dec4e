"""A manoeuvre of the table: a rest, or a turn."""

from dataclasses import dataclass
from math import ceil, pi
from typing import Final

from laboratory.arrays import Array
from laboratory.errors import Complaint
from laboratory.profiles import Profile

AS_MOUNTED: Final = "as mounted"  # the mount that a plan does not name


@dataclass(frozen=True)
class Step:
    """The step of a tumble that leads to a rest."""

    tumble: str  # its id
    angle: float  # rad, about the tumble's axis, since its start
    size: float  # rad, from rest to rest
    way: int  # +1 or -1: the direction of the step that leads to it


@dataclass(frozen=True)
class Manoeuvre:
    """A rest or a turn."""

    name: str
    log: str
    position: str  # the same for manoeuvres of the same attitude, errors included
    shares: str  # name of the position with the same error, though approached from elsewhere
    mount: str  # how the IMU is fixed to the table
    up: Array  # unit vector, (3,), body axes: points up at the start
    mark: Array  # body axes, not vertical: its azimuth at the start is known, or random
    azimuth: str | None  # None: that of the table's zero mark; else random, by this name
    about: Array  # unit vector, (3,), body axes: axis of the turn, or of the tumble
    profile: Profile
    seconds: float  # with the rest before and after a turn
    step: Step | None = None  # of a rest in a tumble

    def samples(self, interval: float) -> int:
        """Number of samples of the manoeuvre."""
        return ceil(self.seconds / interval - 1e-6)

    @property
    def comes_back(self) -> bool:
        """Whether the attitude at the end is that at the start."""
        turns = self.profile.angle / (2 * pi)
        return abs(turns - round(turns)) < 1e-12


class PlanError(ValueError):
    """A manoeuvre that cannot be carried out."""

    def __init__(self, complaint: Complaint) -> None:
        self.complaint = complaint
        super().__init__(str(complaint))

"""What every physical effect must tell about itself."""

from abc import ABC
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from stages.model.motion import Motion

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Truth:
    """Angular rate (n, 3), rad/s, and specific force (n, 3), m/s², that the sensors feel."""

    rate: Array
    force: Array


@dataclass(frozen=True)
class Reading:
    """What the sensors say: gyro (n, 3), rad/s, and accel (n, 3), m/s²."""

    gyro: Array
    accel: Array


@dataclass(frozen=True)
class Parameter:
    """One number that an effect needs; zero means that the effect is absent."""

    name: str
    unit: str
    typical: float  # size in a good laboratory IMU or table; sets the step of derivatives
    meaning: str


class Effect(ABC):
    """One physical effect: its name, its cause, its source, its parameters and how it acts.

    It `moves` the truth before it is sensed, or changes what the sensor `reads`, or both.
    `rings` tells that it is faster than a block and is sought in the spectrum of the
    full-rate residuals instead.
    """

    name: ClassVar[str]
    cause: ClassVar[str]
    source: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]
    rings: ClassVar[bool] = False

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        """The truth with this effect in it; `values` follow `parameters`."""
        return truth

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        """The reading with this effect in it; `values` follow `parameters`."""
        return reading

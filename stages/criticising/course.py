"""A drift that could be anything: half waves over the campaign, of one sensor."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from stages.model.drift import without_clock
from stages.model.effect import Array, Effect, Parameter, Reading, Truth
from stages.model.motion import Motion

HALF_WAVES = 8  # in the campaign: the fastest that is told from a jump
STRENGTH = {"gyro": ("rad/s", 5e-6), "accel": ("m/s²", 1e-4)}  # a degree per hour, 10 µg


class Course(Effect):
    """Reading += c cos(k π t/T): no physical effect, but what a drift without a law is made of.

    It takes the place of several effects that together would only imitate it.
    """

    cause = "the bias drifts, by no law of the catalogue"
    source = "Fourier, by cosines over the time of the campaign"
    thinkable = 1e4

    def __init__(self, sensor: str, half_waves: int) -> None:
        unit, size = STRENGTH[sensor]
        self.sensor, self.at = sensor, float(half_waves)
        self.name = course_of(sensor)  # type: ignore[misc]
        self.parameters = tuple(  # type: ignore[misc]
            Parameter(f"c_{axis}", unit, size, f"of the {axis} reading") for axis in "xyz"
        )
        self.sizes = {"usual": size}  # type: ignore[misc]

    def blind(self, motion: Motion) -> str:
        return without_clock(motion)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        if without_clock(motion) or self.at is None:
            return reading
        first, last = motion.time.min(), motion.time.max()
        phase = np.pi * self.at * (motion.time - first) / max(last - first, 1.0)
        wave = np.outer(np.cos(phase), values)
        if self.sensor == "gyro":
            return replace(reading, gyro=reading.gyro + wave)
        return replace(reading, accel=reading.accel + wave)


def course_of(sensor: str) -> str:
    """The name of the free course of a sensor."""
    return f"{sensor}_drift"


def courses(sensor: str) -> Iterator[Course]:
    """The half waves of a sensor."""
    return (Course(sensor, k) for k in range(1, HALF_WAVES + 1))

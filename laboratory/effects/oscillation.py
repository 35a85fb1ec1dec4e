"""Oscillation of the case about one of its axes while the table turns."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.axes import direction
from laboratory.effects.effect import Effect
from laboratory.instants import Instants
from laboratory.motion import Turning
from laboratory.profiles import smooth_step
from laboratory.units import DEGREE


@dataclass(frozen=True)
class Oscillation(Effect):
    """A vibration of the case by the angle ψ = A/(2πf) w S(2πf t + phase) about `axis`.

    A: amplitude, rad/s; f: frequency, Hz; t: from the start of the manoeuvre; w: the rate of the
    table as a fraction of its steady rate, smoothed (`smooth_step`), so 0 at rest: over a whole
    turn the vibration adds no angle. Periodic in the angle of the table it is
    A/(n r) w S(nθ + phase), n periods per revolution, θ the angle of the table and r its steady
    rate. It is a motion like any other: it tilts gravity, acts on a lever arm, and reaches the
    other sensors through M. Observed in S0, figures 5-14 to 5-16.

    S is a sine, or the limit cycle of a drive that keeps itself in motion, x'' − ε (1 − x²) x' + x
    = 0, to the first order of ε and in units of its fundamental: B. van der Pol, Phil. Mag. 2,
    1926, 978; A. H. Nayfeh, Introduction to Perturbation Techniques, 1981, chapter 4.
    """

    frequency: float | None  # Hz; None: periodic in the angle of the table
    order: float  # n, where periodic in the angle
    amplitude: float
    axis: Array  # unit vector, (3,), body axes
    phase: float  # rad
    nonlinearity: float = 0.0  # ε

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters.get("frequency_hz"),
            parameters.get("order", 0.0),
            parameters["amplitude_rad_s"],
            direction(parameters["axis"]),
            parameters.get("phase_deg", 0.0) * DEGREE,
            parameters.get("nonlinearity", 0.0),
        )

    def change_rotations(
        self, turnings: Sequence[Turning], instants: Instants
    ) -> Sequence[Turning]:
        if not turnings or self.amplitude == 0:
            return turnings
        table = turnings[0]
        per_second = np.sign(table.rate) * table.acceleration / table.steady_rate
        w, slope, bend = smooth_step(np.abs(table.rate) / table.steady_rate)
        w1, w2 = slope * per_second, bend * per_second**2
        if self.frequency is None:
            argument, speed = self.order * table.angle, self.order * table.rate
            change, steady = self.order * table.acceleration, self.order * table.steady_rate
        else:
            steady = 2 * pi * self.frequency
            argument, speed, change = steady * instants.elapsed, np.asarray(steady), np.asarray(0.0)
        wave, wave1, wave2 = limit_cycle(argument + self.phase, self.nonlinearity)
        size = self.amplitude / steady
        vibration = Turning(
            self.axis,
            angle=size * w * wave,
            rate=size * (w1 * wave + w * speed * wave1),
            acceleration=size
            * (w2 * wave + 2 * w1 * speed * wave1 + w * (change * wave1 + speed**2 * wave2)),
            steady_rate=self.amplitude,
        )
        return [*turnings, vibration]


def limit_cycle(phase: Array, nonlinearity: float) -> tuple[Array, Array, Array]:
    """S of a phase, rad, sin − (ε/8) cos 3, and its first two derivatives."""
    third = nonlinearity / 8
    sine, cosine = np.sin(3 * phase), np.cos(3 * phase)
    return (
        np.sin(phase) - third * cosine,
        np.cos(phase) + 3 * third * sine,
        -np.sin(phase) + 9 * third * cosine,
    )

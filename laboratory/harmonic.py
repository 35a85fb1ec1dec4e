"""Angles that are periodic in the angle of the table."""

from dataclasses import dataclass, replace

import numpy as np

from laboratory.arrays import Array
from laboratory.motion import Turning

LEVEL = 1e-9  # an axis that points down by less is horizontal


@dataclass(frozen=True)
class Harmonic:
    """ψ(θ) = c (cos nθ − 1) + s sin nθ, zero at θ = 0. order: n; c, s: rad."""

    order: float
    cosine: float
    sine: float

    def value(self, angle: Array) -> Array:
        """ψ, rad, shape of the angle, rad."""
        turned = self.order * angle
        # cos − 1, but exact where it is small
        value: Array = self.sine * np.sin(turned) - 2 * self.cosine * np.sin(turned / 2) ** 2
        return value

    def slopes(self, angle: Array) -> tuple[Array, Array]:
        """dψ/dθ and d²ψ/dθ², shape of the angle."""
        sine, cosine = np.sin(self.order * angle), np.cos(self.order * angle)
        slope = self.order * (self.sine * cosine - self.cosine * sine)
        bend = -(self.order**2) * (self.sine * sine + self.cosine * cosine)
        return slope, bend

    def turning(self, axis: Array, table: Turning) -> Turning:
        """A rotation by ψ about an axis, unit vector, (3,), while the table turns."""
        slope, bend = self.slopes(table.angle)
        return Turning(
            axis,
            angle=self.value(table.angle),
            rate=slope * table.rate,
            acceleration=slope * table.acceleration + bend * table.rate**2,
            steady_rate=table.steady_rate,
        )

    def added_to(self, table: Turning) -> Turning:
        """The rotation of a table that turns by θ + ψ(θ)."""
        more = self.turning(table.axis, table)
        return replace(
            table,
            angle=table.angle + more.angle,
            rate=table.rate + more.rate,
            acceleration=table.acceleration + more.acceleration,
        )


def across(axis: Array) -> tuple[Array, Array]:
    """East and north, (3,) each, after the shortest rotation from up, or down, to an axis.

    axis: unit vector, (3,), level frame. An axis that points down is reversed.
    """
    x, y, z = axis if axis[2] >= -LEVEL else -axis
    # Rodrigues' formula for the rotation from (0, 0, 1) to (x, y, z).
    share = 1 / (1 + z)
    east = np.array([1 - share * x * x, -share * x * y, -x])
    north = np.array([-share * x * y, 1 - share * y * y, -y])
    return east, north

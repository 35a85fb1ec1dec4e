"""Axes of a table that are not at right angles."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion, cross, without_north
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND

HOME = np.array([0.0, 0.0, 1.0])  # of the case: up where the middle axis is at zero
MIN_MIDDLE_SINE = 0.1  # of the angle of the middle axis, from which it gives that axis alone


class TableAxisNonOrthogonality(Effect):
    """f −= λ × f, ω −= λ × ω,   λ = δ (1 − cos φ) m × u + ε sin φ m,   sin φ m = u × home.

    The level middle axis m of the table has turned the case by φ from where home, its z axis, was
    up to where u is. It leans upwards by δ, and home was made level, so what it turns goes on a
    cone; and it turns by ε too far in a quarter. The error is fixed to the outer frame of the
    table, so it goes along with a turn about the vertical, unlike that of a table that is not
    level. Where z is up or down, m is where it was on the sides; campaigns do not say how the case
    sits in the table.
    """

    name = "table_axis_non_orthogonality"
    cause = _("the middle axis of the table is not at a right angle to its outer one")
    source = "IEEE Std 1554-2005, orthogonality of table axes"
    parameters = (
        Parameter("lean", "rad", 1e-5, _("δ, by which the middle axis points above the horizon")),
        Parameter("quarter", "rad", 1e-5, _("ε, by which a quarter turn about it is too large")),
    )
    sizes = of_tables(ARC_SECOND, 2, 30)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        up = motion.up_at_start
        middle, sine = _middle(up, np.nan_to_num(motion.north_at_start))
        error = values[0] * (1 - up @ HOME)[:, None] * cross(middle, up)
        error += values[1] * sine[:, None] * middle
        return replace(
            truth,
            rate=truth.rate - cross(error, motion.omega),
            force=truth.force - cross(error, truth.force),
        )

    def blind(self, motion: Motion) -> str:
        return without_north(motion)


def middle_axis(motion: Motion) -> Array:
    """The middle axis in body axes when each manoeuvre began, (n, 3); 0 where nothing tells it."""
    return _middle(motion.up_at_start, np.nan_to_num(motion.north_at_start))[0]


def _middle(up: Array, north: Array) -> tuple[Array, Array]:
    """The middle axis in body axes, (n, 3), and the sine of its angle, (n,).

    It is one line in the laboratory, given by the first side whose azimuth is known; a tumble that
    goes on beyond down turns about it still.
    """
    across = cross(up, HOME)
    size = np.linalg.norm(across, axis=1)
    level = np.stack([north, cross(north, up)], axis=1)  # (n, 2, 3), north and east
    azimuth = np.einsum("nij,nj->ni", level, across)
    sides = np.flatnonzero((size > MIN_MIDDLE_SINE) & azimuth.any(axis=1))
    if not len(sides):
        return np.zeros_like(up), size
    first = azimuth[sides[0]] / np.linalg.norm(azimuth[sides[0]])
    sign = np.where(azimuth @ first < -0.5 * size, -1.0, 1.0)
    beside = np.einsum("nij,i->nj", level, first)
    own = sign[:, None] * across / np.maximum(size, MIN_MIDDLE_SINE)[:, None]
    return np.where(size[:, None] > MIN_MIDDLE_SINE, own, beside), sign * size

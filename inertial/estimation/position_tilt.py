"""The tilt of a set position: two unknowns at rest, more while the table turns.

An error of the IMU on the table is fixed to its case, so a turn does not change it in body axes. An
error of the table's axis, as of the outer axis of a two-axis table, is fixed to the laboratory, so
in body axes it turns the other way. Which of the two a tilt t is, is not known. So the part l that
is fixed to the laboratory has unknowns of its own, and in a turn by θ the accelerometers show

    t + (R(θ) − 1) l,

with the sigma of the table for t and for l, independently: that holds where the tilt is wholly of
the case, and where it is wholly of the axis. The directions are the level ones of the start. In a
turn about another axis than the vertical those of the case do not stay level, and an azimuth a of
the case about the vertical of the start, of which nothing is seen there, becomes a tilt.

Gyros show the part that is fixed to the case, for it moves the axis of the turn there. By
themselves they know it to the same sigma; beside the accelerometers it is t − l.
"""

from collections.abc import Sequence

import numpy as np

from inertial.arrays import Array
from inertial.estimation.elimination import Name

TILTS = ("tilt 0", "tilt 1")  # t
OF_AXIS = ("tilt of axis 0", "tilt of axis 1")  # l
AZIMUTH = ("azimuth of case",)  # a
OF_CASE = ("tilt of case 0", "tilt of case 1")  # t − l


def names_of(positions: Sequence[str], kinds: Sequence[str]) -> tuple[Name, ...]:
    """The unknowns of these kinds of some positions."""
    return tuple((kind, position) for position in positions for kind in kinds)


def in_force(case: Array, laboratory: Array) -> Array:
    """The directions of t and l in what accelerometers show, (…, 4, 3), from level axes, (…, 2, 3).

    `case`: fixed to the case; `laboratory`: fixed to the laboratory, in body axes.
    """
    return np.concatenate([case, laboratory - case], axis=-2)


def case_by_both(positions: int) -> Array:
    """OF_CASE of some positions by their TILTS and OF_AXIS, (2 positions, 4 positions)."""
    return np.asarray(np.kron(np.eye(positions), np.hstack([np.eye(2), -np.eye(2)])))

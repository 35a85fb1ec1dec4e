"""The tilt of a set position: two unknowns at rest, more while the table turns about the vertical.

An error of the IMU on the table is fixed to its case, so a turn does not change it in body axes. An
error of the table's axis, as of the outer axis of a two-axis table, is fixed to the laboratory, so
in body axes it turns the other way. Which of the two a tilt t is, is not known. So the part l that
is fixed to the laboratory has unknowns of its own, and in a turn by θ the accelerometers show

    t + (R(θ) − 1) l.

Gyros show the part that is fixed to the case, for it moves the axis of the turn there: as much of t
as not, t/2 + d √3/2. All of t, l and d have the sigma of the table, independently, so that each
part has it, and their sum at rest, if the tilt is wholly of the case, or wholly of the axis.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.elimination import Name

Array = NDArray[np.float64]

TILTS = ("tilt 0", "tilt 1")
OF_AXIS = ("tilt of axis 0", "tilt of axis 1")  # l, of accelerometers
OF_CASE = ("tilt of case 0", "tilt of case 1")  # d, of gyros
SHARES = (0.5, float(np.sqrt(0.75)))  # of t and of d in what is fixed to the case


def names_of(position: str, kinds: Sequence[str] = TILTS) -> tuple[Name, ...]:
    """The names of unknowns of a position."""
    return tuple((kind, position) for kind in kinds)


def in_case(axes: Sequence[Array]) -> list[Array]:
    """The directions of t and d, (3,) each, in what gyros show, from the two level axes."""
    return [share * axis for share in SHARES for axis in axes]


def in_force(case: Array, laboratory: Array) -> Array:
    """Those of t and l in what accelerometers show, (…, 4, 3), from level axes, (…, 2, 3).

    `case`: fixed to the case; `laboratory`: fixed to the laboratory, in body axes.
    """
    return np.concatenate([case, laboratory - case], axis=-2)

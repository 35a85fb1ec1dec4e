"""The tilt of a set position: two unknowns at rest, four while the table turns about the vertical.

An error of the IMU on the table is fixed to its case, so a turn does not change it in body axes. An
error of the table's axis, as of the outer axis of a two-axis table, is fixed to the laboratory, so
in body axes it turns the other way. Which of the two a tilt t is, is not known: of each of its
components

    t/2 − e √3/2   is fixed to the case,   t/2 + e √3/2   to the laboratory,

with a second unknown e. t and e have the sigma of the table, independently; so has each part, and
their sum at rest, t. Gyros show the first part alone, for it moves the axis of a turn in the case.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.elimination import Name

Array = NDArray[np.float64]

KINDS = ("tilt 0", "tilt 1", "tilt of axis 0", "tilt of axis 1")
OF_CASE = np.array([0.5, -np.sqrt(0.75)])  # shares of t and of e
OF_AXIS = np.array([0.5, np.sqrt(0.75)])


def names_of(position: str, *, turning: bool) -> tuple[Name, ...]:
    """The unknowns of a position at rest or in turns about its vertical."""
    return tuple((kind, position) for kind in (KINDS if turning else KINDS[:2]))


def of_case(axes: Sequence[Array]) -> list[Array]:
    """The directions (3,) of the four unknowns in what is fixed to the case, from those of two."""
    return [share * axis for share in OF_CASE for axis in axes]


def of_both(case: Array, laboratory: Array) -> Array:
    """The same in the whole tilt, (…, 4, 3), from two fixed to each, (…, 2, 3), in body axes."""
    parts = zip(OF_CASE, OF_AXIS, strict=True)
    return np.concatenate([own * case + other * laboratory for own, other in parts], axis=-2)

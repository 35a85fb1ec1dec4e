"""What a stretch on the table sees of the turning earth.

The upward part stays where it is while the table turns about the vertical; the level part turns in
body axes, and its sum over a whole turn at a steady rate is zero. Ramps and standstill leave some
of it: of S3's windows of 64 s and 36 s, 4.0 s and 6.0 s times the level rate, which is 0.81 and
2.16 °/h of their means.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.inference.whole_turns import Earth, Position
from stages.model.motion import level_axes, turned_all
from stages.model.vectors import cross

Array = NDArray[np.float64]


@dataclass(frozen=True)
class EarthSeen:
    """The earth's rate in body axes, summed over a stretch; all (3,).

    `known`: what is known of it, rad; `up`: per unit of the upward rate, s; `level`: for each
    unknown direction of the level rate, by kind and name, its size at one sigma, rad.
    """

    known: Array
    up: Array
    level: Mapping[tuple[str, str], Array]


def earth_seen(
    earth: Earth, position: Position, about: Array, angles: Array, seconds: Array
) -> EarthSeen:
    """Sum the earth's rate over pieces of a turn.

    An unknown azimuth is a random direction of the level rate; positions with a common mark
    share it.

    Parameters
    ----------
    about : (3,), axis of the turn, body axes at its start
    angles : (k,), rad, turned since the start at the middle of each piece
    seconds : (k,), how long each piece is; shares of 1 give the mean rate, in rad/s, instead
    """

    def summed(direction: Array) -> Array:
        return np.asarray(seconds @ turned_all(direction, about, angles))

    up = summed(position.up)
    if position.north is not None:
        return EarthSeen(earth.up * up + earth.level * summed(position.north), up, {})
    axes, name = level_axes(position.up), position.name
    if position.mark is not None:
        axes, name = (position.mark, cross(position.up, position.mark)), "the table"
    sigma = earth.level / np.sqrt(2)
    level = {(f"level {i}", name): sigma * summed(axis) for i, axis in enumerate(axes)}
    return EarthSeen(earth.up * up, up, level)

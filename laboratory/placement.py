"""Attitude of the IMU at every position of the plan: as set, and true."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from laboratory.arrays import Array
from laboratory.chance import Chance
from laboratory.manoeuvre import Manoeuvre
from laboratory.rotation import rotation_of


@dataclass(frozen=True)
class Placement:
    """One position. Matrices (3, 3), level (east, north, up) from body."""

    set_attitude: Array  # as the plan says, at the true azimuth, on a level table
    tilt: Array  # (3, 3), level frame: the error of the position
    base: Array  # (3, 3), level frame: tilt of the whole table, its axis included
    of_axis: bool  # the error of the position tilts the axis of the table too
    mounting: Array  # (3, 3): from the axes of the case to those that the plan names

    @property
    def attitude(self) -> Array:
        """C = base · tilt · set attitude · mounting."""
        return self.base @ self.tilt @ self.set_attitude @ self.mounting

    def missed(self, error: Array) -> Self:
        """The same with a further error of the position, (3, 3), level frame."""
        return replace(self, tilt=self.tilt @ error)

    def true_axis(self, about: Array, error: Array) -> Array:
        """The table's axis in body axes, (3,), where the plan names `about`.

        The table turns about its own axis, base · error · set attitude · about, against which the
        case is tilted by the rest of the error of the position, so that the axis of the case
        describes a cone; or the axis is tilted with the case.
        """
        axis = self.base @ (self.tilt if self.of_axis else error)
        return self.attitude.T @ axis @ self.set_attitude @ about


def place(
    manoeuvres: Sequence[Manoeuvre],
    *,
    heading: float | None,
    position_sigma: float,
    leaning: Callable[[Manoeuvre, Array], Array],
    mountings: Mapping[str, Array],
    of_axis: bool,
    missed: Callable[[Manoeuvre, Array], Array],
    chance: Chance,
) -> dict[str, Placement]:
    """The placement at every position, by its name.

    heading: azimuth of the table's zero mark, rad clockwise from north; None: drawn, the same for
    all positions with a mark. A position without mark stands at an azimuth of its own, drawn; the
    rests of a tumble share one. position_sigma: rad, of the rotation about east and about north
    of the position error. leaning: tilt of the table at a set attitude; missed: further position
    error there; both rotations in the level frame. mountings: by mount, where it differs from the
    plan. of_axis: the error of a position tilts the axis of the table with the case.
    """
    if heading is None:
        heading = azimuth(chance, "the table's zero mark")
    placements: dict[str, Placement] = {}
    for manoeuvre in manoeuvres:
        name = manoeuvre.position
        if name in placements:
            continue
        east, north = chance.stream("tilt", manoeuvre.shares).normal(0.0, position_sigma, 2)
        drawn = manoeuvre.azimuth
        towards = heading if drawn is None else azimuth(chance, drawn)
        set_attitude = facing(manoeuvre.up, manoeuvre.mark, towards)
        tilt = rotation_of(np.array([east, north, 0.0])) @ missed(manoeuvre, set_attitude)
        base = leaning(manoeuvre, set_attitude)
        mounting = mountings.get(manoeuvre.mount, np.eye(3))
        placements[name] = Placement(set_attitude, tilt, base, of_axis, mounting)
    return placements


def azimuth(chance: Chance, name: str) -> float:
    """A random azimuth, rad."""
    return float(chance.stream("azimuth", name).uniform(0.0, 2 * np.pi))


def facing(up: Array, mark: Array, azimuth: float) -> Array:
    """The attitude, level from body, with `up` upwards and `mark` at an azimuth (rad, clockwise).

    Only the horizontal part of the mark counts. The two triads of directions (horizontal mark,
    up × mark, up) are the same in the body and in the level frame.
    """
    ahead = mark - (mark @ up) * up
    ahead = ahead / np.linalg.norm(ahead)
    in_body = np.column_stack([ahead, np.cross(up, ahead), up])
    in_level = np.array(
        [
            [np.sin(azimuth), -np.cos(azimuth), 0.0],
            [np.cos(azimuth), np.sin(azimuth), 0.0],
            [0.0, 0.0, 1.0],
        ]
    )
    return in_level @ in_body.T

"""What is in every log, stretch by stretch: manoeuvres, and the way from one to the next."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import numpy as np

from laboratory.arrays import Array
from laboratory.placement import Placement
from laboratory.plan import Manoeuvre
from laboratory.profiles import Change, Profile
from laboratory.rotation import axis_and_angle, rotation_about


@dataclass(frozen=True)
class Stretch:
    """A piece of a log in which the table does one thing."""

    manoeuvre: str | None  # its name; None on the way from one position to the next
    samples: int
    attitude: Array  # level from body, (3, 3), at the start
    axis: Array  # the table's axis, (3,), body axes
    profile: Profile


def logs_of(manoeuvres: Sequence[Manoeuvre]) -> dict[str, list[Manoeuvre]]:
    """The manoeuvres of every log, logs in the order of the plan."""
    logs: dict[str, list[Manoeuvre]] = {}
    for manoeuvre in manoeuvres:
        logs.setdefault(manoeuvre.log, []).append(manoeuvre)
    return logs


def changes_between(before: Manoeuvre, after: Manoeuvre) -> bool:
    """Whether the table has to bring the IMU to another attitude."""
    return before.position != after.position or not before.comes_back


def length(manoeuvres: Sequence[Manoeuvre], interval: float, change_s: float) -> int:
    """The samples of a log."""
    changes = sum(changes_between(*pair) for pair in pairwise(manoeuvres))
    resting_or_turning = sum(manoeuvre.samples(interval) for manoeuvre in manoeuvres)
    return resting_or_turning + changes * ceil(change_s / interval - 1e-6)


def lay_out(
    manoeuvres: Sequence[Manoeuvre],
    placements: Mapping[str, Placement],
    interval: float,
    change_s: float,
) -> list[Stretch]:
    """The stretches of one log. A change of position is one rotation about one axis."""
    stretches: list[Stretch] = []
    before: Manoeuvre | None = None
    for manoeuvre in manoeuvres:
        placement = placements[manoeuvre.position]
        if before is not None and changes_between(before, manoeuvre):
            left = stretches[-1]
            turned = rotation_about(left.axis, np.asarray(left.profile.angle))
            stretches.append(change(left.attitude @ turned, placement.attitude, interval, change_s))
        stretches.append(
            Stretch(
                manoeuvre.name,
                manoeuvre.samples(interval),
                placement.attitude,
                placement.true_axis(manoeuvre.about),
                manoeuvre.profile,
            )
        )
        before = manoeuvre
    return stretches


def change(start: Array, end: Array, interval: float, change_s: float) -> Stretch:
    """The way from one attitude to another."""
    axis, angle = axis_and_angle(start.T @ end)
    return Stretch(None, ceil(change_s / interval - 1e-6), start, axis, Change(angle, change_s))

"""The segments of every log: manoeuvres, and changes of position between them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, pi

import numpy as np

from laboratory.arrays import Array
from laboratory.instants import Instants
from laboratory.manoeuvre import Manoeuvre
from laboratory.motion import Turning
from laboratory.placement import Placement
from laboratory.profiles import Change, Profile, Trapezoid
from laboratory.rotation import axis_and_angle, rotation_about

SETTLED = 0.1  # s at rest after every step of a tumble


@dataclass(frozen=True)
class Handling:
    """How the table changes from one position to the next within a log."""

    interval: float  # s, of a sample
    change: float  # s; 0 where there is none
    step_rate: float  # rad/s, of the steps of a tumble
    step_acceleration: float  # rad/s²

    def samples(self, seconds: float) -> int:
        """Number of whole samples in a time."""
        return ceil(seconds / self.interval - 1e-6)

    def step(self, angle: float) -> Trapezoid:
        """The course of a step, from its start."""
        return Trapezoid(0.0, angle, self.step_rate, self.step_acceleration)

    def step_samples(self, size: float) -> int:
        """The samples of a step, until the table has settled."""
        return self.samples(self.step(size).seconds + SETTLED)


@dataclass(frozen=True)
class Segment:
    """Part of a log with one profile of the table."""

    manoeuvre: str | None  # its name; None for a change of position
    samples: int
    attitude: Array  # level from body, (3, 3), at the start
    axis: Array  # the table's axis, (3,), body axes
    profile: Profile

    def turning(self, instants: Instants) -> Turning:
        """The rotation that is set, at these instants."""
        course, steady = self.profile.course(instants.elapsed), self.profile.steady_rate
        return Turning(self.axis, *course, steady, self.manoeuvre is not None)

    @property
    def end(self) -> Array:
        """The attitude at the end, (3, 3)."""
        return self.attitude @ rotation_about(self.axis, np.asarray(self.profile.angle))


def logs_of(manoeuvres: Sequence[Manoeuvre]) -> dict[str, list[Manoeuvre]]:
    """The manoeuvres of every log, logs in the order of the plan."""
    logs: dict[str, list[Manoeuvre]] = {}
    for manoeuvre in manoeuvres:
        logs.setdefault(manoeuvre.log, []).append(manoeuvre)
    return logs


def changes_between(before: Manoeuvre, after: Manoeuvre) -> bool:
    """Whether the table changes the attitude between them, steps of a tumble excluded."""
    if steps_between(before, after):
        return False
    return before.position != after.position or not before.comes_back


def steps_between(before: Manoeuvre, after: Manoeuvre) -> list[float]:
    """The steps from one rest of a tumble to the next, rad about its axis.

    Where the direction reverses, the table first continues by one step, so that it approaches every
    rest on the way back from the other side, the first one too.
    """
    one, other = before.step, after.step
    if one is None or other is None or one.tumble != other.tumble:
        return []
    if one.way != other.way:
        return [one.size, -one.size]
    return [other.angle - one.angle]


def length(manoeuvres: Sequence[Manoeuvre], handling: Handling) -> int:
    """The samples of a log."""
    pairs = list(pairwise(manoeuvres))
    changes = sum(changes_between(*pair) for pair in pairs)
    steps = sum(handling.step_samples(step) for pair in pairs for step in steps_between(*pair))
    resting_or_turning = sum(manoeuvre.samples(handling.interval) for manoeuvre in manoeuvres)
    return resting_or_turning + changes * handling.samples(handling.change) + steps


def lay_out(
    manoeuvres: Sequence[Manoeuvre],
    placements: Mapping[str, Placement],
    handling: Handling,
    actual_profiles: Callable[[Manoeuvre], Profile],
    begin: float,
    later_error: Callable[[Manoeuvre, Array, float], Array],
    axis_error: Callable[[Manoeuvre, Array, float], Array],
) -> list[Segment]:
    """The segments of one log. A change of position is one rotation about one axis.

    actual_profiles: the actual course of a turn, by the course that is set; begin: of the log, s;
    later_error: of an attitude, axis_error: by how much the axis of a turn leans there, rotations
    in the level frame, by manoeuvre, set attitude, and time at which it was set, s.
    """
    segments: list[Segment] = []
    before: Manoeuvre | None = None
    set_at = begin
    for manoeuvre in manoeuvres:
        placement = placements[manoeuvre.position]
        if before is not None and before.position != manoeuvre.position:
            set_at = begin + handling.interval * sum(segment.samples for segment in segments)
        placement = placement.missed(later_error(manoeuvre, placement.set_attitude, set_at))
        leaning = axis_error(manoeuvre, placement.set_attitude, set_at)
        axis = placement.true_axis(manoeuvre.about, leaning)
        if before is not None and changes_between(before, manoeuvre):
            segments.append(change(segments[-1].end, placement.attitude, handling))
        elif before is not None and (steps := steps_between(before, manoeuvre)):
            for planned in steps[:-1]:  # beyond the rest at which the direction reverses
                start = segments[-1].end
                turned = rotation_about(axis, np.asarray(planned))
                segments.append(step(start, start @ turned, axis, planned, handling))
            start = segments[-1].end
            segments.append(step(start, placement.attitude, axis, steps[-1], handling))
        samples = manoeuvre.samples(handling.interval)
        profile = actual_profiles(manoeuvre)
        segments.append(Segment(manoeuvre.name, samples, placement.attitude, axis, profile))
        before = manoeuvre
    return segments


def change(start: Array, end: Array, handling: Handling) -> Segment:
    """The change from one attitude to another."""
    axis, angle = axis_and_angle(start.T @ end)
    samples = handling.samples(handling.change)
    return Segment(None, samples, start, axis, Change(angle, handling.change))


def step(start: Array, end: Array, about: Array, planned: float, handling: Handling) -> Segment:
    """A step of a tumble: from one attitude to another, by about the planned angle about `about`.

    The axis is the one that leads to the end exactly, position errors included.
    """
    axis, angle = axis_and_angle(start.T @ end)
    if (
        angle > pi / 2 and axis @ about * planned < 0
    ):  # little more than half a turn: the other direction
        axis, angle = -axis, 2 * pi - angle
    samples = handling.step_samples(planned)
    return Segment(None, samples, start, axis, handling.step(angle))

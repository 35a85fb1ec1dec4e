"""A tumble: rests at equal steps about a horizontal axis of the table."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import sin
from typing import Any

import numpy as np

from laboratory.errors import Complaint
from laboratory.manoeuvre import Manoeuvre, PlanError, Step
from laboratory.rotation import rotation_about
from laboratory.units import DEGREE


def rests_of(first: Manoeuvre, written: Mapping[str, Any], place: str) -> Iterator[Manoeuvre]:
    """The rests of a tumble, forward and, where specified, back.

    <id>-00, <id>-01 … and <id>-back-00 … by the number of steps from the start. With a
    named position, both directions share the error of every step; else every rest has its own.
    """
    if abs(first.up @ first.about) > sin(DEGREE):
        raise PlanError(Complaint(f"{place}.about", str(written["about"]), "an axis across up"))
    size = written["step_degrees"] * DEGREE
    forward = [(number, 1) for number in range(written["steps"])]
    back = [(number, -1) for number, _ in reversed(forward)] if written.get("and_back") else []
    for number, way in forward + back:
        # The direction that points up after a rotation of the case by +angle about the axis.
        turned_back = rotation_about(first.about, np.asarray(-number * size))
        name = f"{first.name}{'-back' if way < 0 else ''}-{number:02d}"
        shares = f"{first.position}-{number:02d}" if "position" in written else f"of {name}"
        yield replace(
            first,
            name=name,
            position=f"{shares}, from beyond" if way < 0 and "position" in written else shares,
            shares=shares,
            up=turned_back @ first.up,
            mark=turned_back @ first.mark,
            step=Step(first.name, number * size, size, way),
        )

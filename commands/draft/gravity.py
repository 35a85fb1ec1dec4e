"""Gravity as accelerometers read it: how long it is, about which zero, and where that is in doubt.

It has one length wherever it points, so static positions lie on a sphere about the biases.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from commands.draft.series import Divided
from inertial.arrays import Array
from inertial.text.messages import _
from inertial.text.numbers import significant

MIN_POINTS = 4  # static positions that show a centre
MIN_SPREAD = 0.3  # of their directions, the least one to the largest
MIN_CHECKED = 6  # static positions about whose centre lengths are compared: two more than unknowns
MAX_OFF = 0.1  # of the length of a static position to the others', about their centre
MAX_OFF_BIASED = 0.15  # the same about zero: biases are in it


@dataclass(frozen=True)
class Gravity:
    """Centre, (3,), and length in the unit of the readings; `seen`: what says so; `doubt`: a
    question where static positions differ in length, else empty.
    """

    centre: Array
    length: float
    seen: str
    doubt: str = ""


def sphere(points: Array) -> tuple[Array, float, float]:
    """Centre, (3,), radius and scatter of the sphere through points (n, 3).

    About zero where the points do not show a centre. The radius is the median of their distances,
    which one point that is no static position does not change.
    """
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    centre = np.zeros(3)
    if len(points) >= MIN_POINTS and spread[-1] > MIN_SPREAD * spread[0]:
        design = np.column_stack([2 * points, np.ones(len(points))])
        centre = np.linalg.lstsq(design, np.sum(points**2, axis=1), rcond=None)[0][:3]
    lengths = np.linalg.norm(points - centre, axis=1)
    return centre, float(np.median(lengths)), float(np.std(lengths))


def gravity_in(recordings: Sequence[Divided], zero: float = 0.0) -> Gravity:
    """By the static positions; `zero`: of counts."""
    rests = np.array([rest.accel for own in recordings for rest in own.rests])
    if not len(rests):
        readings = np.concatenate([own.series.accel for own in recordings])
        length = float(np.median(np.linalg.norm(readings - zero, axis=1)))
        seen = _("nothing rests; the median of |f| is {length}", length=significant(length))
        return Gravity(np.zeros(3), length, seen)
    centre, length, _scatter = sphere(rests - zero)
    seen = _("|f| at rest is {length}", length=significant(length))
    return Gravity(centre, length, seen, _doubt(rests - zero, centre))


def _doubt(rests: Array, centre: Array) -> str:
    """A question where static positions, (n, 3), differ in length by more than biases explain."""
    checked = len(rests) >= MIN_CHECKED and bool(centre.any())
    lengths = np.linalg.norm(rests - (centre if checked else 0.0), axis=1)
    if np.abs(lengths / np.median(lengths) - 1).max() <= (MAX_OFF if checked else MAX_OFF_BIASED):
        return ""
    return _(
        "in {count} static positions |f| is {least} to {most}, and gravity has one length; is "
        "each of them a static position, with all samples in one unit?",
        count=len(lengths),
        least=significant(float(lengths.min())),
        most=significant(float(lengths.max())),
    )

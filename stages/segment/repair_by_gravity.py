"""Axes and signs by which the gyros turn gravity as the accelerometers see it, without a plan."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inertial.signal.axis_permutations import Permutation
from inertial.signal.gravity_turned import turned
from inertial.signal.misread_axes import determinant
from inertial.signal.plan_detector import Misread
from stages.segment.explanations import Step, axes_step
from stages.segment.locating import AS_NAMED
from stages.segment.windows import Binned

Array = NDArray[np.float64]


def misread_by_gravity(binned: Sequence[Binned], level: Array) -> list[Misread]:
    """What explains that the gyros turn gravity otherwise than it turns; each does it alone.

    If the gyros' triad is left-handed beside the accelerometers', only they explain it, for
    accelerometers that read A f turn by det(A)·A ω, which is right-handed. Else both may: of the
    accelerometers those with the fewest signs, for all of them reversed turn alike.

    Parameters
    ----------
    level : (3,), rad/s, the gyros at rest
    """
    stretches = [(one.forces, one.rates - level, one.bin_seconds) for one in binned if one.bins]
    seen = turned(stretches)
    if seen is None or seen.axes in (None, AS_NAMED):
        return []
    assert seen.axes is not None
    names = [m.name for one in binned for m in one.window.manoeuvres]
    explained = [("gyro", seen.axes)]
    if determinant(seen.axes) > 0:
        explained.append(("accel", _of_accelerometers(seen.axes)))
    return [
        Misread(sensor, axes, "", names, _step(sensor, axes).id, spans=seen.spans)
        for sensor, axes in explained
    ]


def step_of(misread: Misread) -> Step:
    """The repair that sets it right."""
    return _step(misread.sensor, misread.axes)


def _step(sensor: str, axes: Permutation) -> Step:
    step = axes_step(sensor, axes)
    return Step(f"{step.id}/by-gravity", step.repair, sensor, axes)


def _of_accelerometers(gyros: Permutation) -> Permutation:
    """What the accelerometers' readings need in place of `gyros`, right-handed."""
    right = gyros.inverse
    left = Permutation(right.sources, tuple(-sign for sign in right.signs))
    return min((right, left), key=lambda axes: axes.signs.count(-1))

"""Turns of which one was not what is stated: at another rate, or by another angle.

The runs at a steady rate about one axis lie on a line, reading = bias + (1 + s) rate. One is off
where a line through the others passes it by far more than it passes any of them. A sensor that is
not linear leaves its line at the ends, so of a run beyond all others nothing is said, unless one
goes as fast the other way.

Turns by an angle read as many times that as the scale factors are, which are alike or nearly so:
one that reads otherwise, by far more than the others differ, was another turn. An asymmetry of a
gyro would move two of them, each as far; a scale factor all turns about its axis.
"""

from collections.abc import Hashable, Sequence

import numpy as np

from inertial.arrays import Array

MIN_OTHERS = 4  # of runs on the line two more than it has parameters
MIN_OFF = 0.003  # of what is stated: less a table may be off, and effects of gyros do
LEAST_SPREAD = 1e-4  # of ratios: less is no more alike
MIN_RATIO = 10.0  # of what it is off to the largest that another is


def off_rate(stated: Array, read: Array, sigma: Array) -> tuple[int, float] | None:
    """The number of the run that is off and the rate that it had; None where none is.

    stated, read, sigma : (n,), rates about the axis, and what the readings are uncertain by, rad/s
    """
    found: list[tuple[float, int, float]] = []
    for one in range(len(stated)):
        others = np.arange(len(stated)) != one
        if others.sum() < MIN_OTHERS or np.abs(stated[one]) > np.abs(stated[others]).max():
            continue
        design = np.column_stack([np.ones(others.sum()), stated[others]])
        (bias, slope), *_ = np.linalg.lstsq(design, read[others], rcond=None)
        rate = (read[one] - bias) / slope
        left = np.abs(read[others] - design @ [bias, slope]).max()
        off = abs(rate - stated[one])
        ratio = off / max(left, sigma[one], sigma[others].max())
        if ratio > MIN_RATIO and off > MIN_OFF * abs(stated[one]):
            found.append((float(ratio), one, float(rate)))
    return max(found)[1:] if found else None


def off_ratio(ratios: Array, axes: Sequence[Hashable]) -> int | None:
    """The number of the turn whose recorded over stated angle is off; None where none is.

    ratios, axes : of the n turns
    """
    if len(ratios) <= MIN_OTHERS:
        return None
    one = int(np.argmax(np.abs(ratios - np.median(ratios))))
    if list(axes).count(axes[one]) < 2:
        return None
    others = np.delete(ratios, one)
    off = abs(ratios[one] - np.median(others))
    spread = max(float(np.abs(others - np.median(others)).max()), LEAST_SPREAD)
    return one if off > max(MIN_OFF, MIN_RATIO * spread) else None

"""What the laboratory added to the gyros, as an effect whose course is known but for its size."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from inertial.physics.effect import Effect, Parameter, Reading
from inertial.physics.motion import Motion
from laboratory import Recording

Array = NDArray[np.float64]


class Course(Effect):
    """Reading += s times a known course; `integral`: of it up to `time`, s, (n, 3), rad.

    The size s is 1 in the campaign from which it was taken.
    """

    name = "known_course"
    cause = "what the laboratory did"
    source = "the simulated laboratory"
    parameters = (Parameter("s", "1", 1.0, "size"),)
    sizes: ClassVar[Mapping[str, float]] = {"usual": 1e12}

    def __init__(self, time: Array, integral: Array) -> None:
        self.time, self.integral = time, integral

    def signature(self, motion: Motion) -> Reading:
        """Of its own: two courses are two effects, though they have one name."""
        half = motion.seconds / 2
        ends = [
            np.column_stack([np.interp(at, self.time, one) for one in self.integral.T])
            for at in (motion.time - half, motion.time + half)
        ]
        mean = (ends[1] - ends[0]) / motion.seconds[:, None]
        return Reading(mean[:, :, None], np.zeros((*mean.shape, 1)))


def known_course(one: Recording, other: Recording) -> Course:
    """By what the gyros of two recordings of the same seed differ."""
    times, integrals = [], []
    reached = np.zeros(3)
    for log, truth in one.truth.items():
        apart = truth.noisy.gyro - other.truth[log].noisy.gyro
        times.append(truth.time)
        integrals.append(reached + apart)
        reached = integrals[-1][-1]
    return Course(np.concatenate(times), np.concatenate(integrals))

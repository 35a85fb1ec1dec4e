"""A bias of the gyros that settles after the instrument is switched on."""

import numpy as np

from inertial.physics.drift import Drift, decayed
from inertial.physics.effect import Array, Parameter, Scan, by_grade, on_each_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR

SHORTEST, LONGEST = 30.0, 3000.0  # s, of τ: a shorter one is over before the first rest is
CANDIDATES = 9  # three in each decade of three; between two of them the trace changes by a tenth


class GyroWarmUp(Drift):
    """Reading += b exp(−t/τ), with t since the first sample of all logs; τ is scanned.

    Told from an even drift by slowing down. Only logs with a common clock show it. Switched on
    earlier by T, the amplitude at the first sample is exp(−T/τ) of the whole.
    """

    name = "gyro_warm_up"
    sensor = "gyro"
    cause = _("the sensor and its electronics warm up after they are switched on")
    source = "IEEE Std 528-2019, 'warm-up time'"
    parameters = tuple(
        Parameter(
            f"b_{axis}",
            "rad/s",
            DEGREE_PER_HOUR,
            _("of the {axis} rate at the first sample", axis=axis),
        )
        for axis in "xyz"
    )
    terms = on_each_axis("gyro", "b_{i}", "exp(-t / tau)")
    sizes = by_grade(DEGREE_PER_HOUR, 0.3, 5, 30, 300)
    scan = Scan("tau", "s", _("time constant of the settling"), smooth=True)

    def grid(self, motion: Motion) -> Array:
        return np.geomspace(SHORTEST, LONGEST, CANDIDATES)

    def course(self, motion: Motion) -> Array:
        return decayed(motion, self.value(motion))

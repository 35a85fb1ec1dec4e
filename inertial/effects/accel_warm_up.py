"""A bias of the accelerometers that settles after the instrument is switched on."""

import numpy as np

from inertial.physics.drift import Drift, decayed
from inertial.physics.effect import Array, Parameter, Scan, by_grade, on_each_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY

SHORTEST, LONGEST = 30.0, 3000.0  # s, of τ: a shorter one is over before the first rest is
CANDIDATES = 9  # three in each decade of three; between two of them the trace changes by a tenth


class AccelWarmUp(Drift):
    """Reading += b exp(−t/τ), with t since the first sample of all logs; τ is scanned.

    Told from an even drift by slowing down. Only logs with a common clock show it. Switched on
    earlier by T, the amplitude at the first sample is exp(−T/τ) of the whole.
    """

    name = "accel_warm_up"
    sensor = "accel"
    cause = _("the sensor and its electronics warm up after they are switched on")
    source = "IEEE Std 528-2019, 'warm-up time'"
    parameters = tuple(
        Parameter(
            f"b_{axis}",
            "m/s²",
            1e-5 * STANDARD_GRAVITY,
            _("of the {axis} specific force at the first sample", axis=axis),
        )
        for axis in "xyz"
    )
    terms = on_each_axis("accel", "b_{i}", "exp(-t / tau)")
    sizes = by_grade(1e-6 * STANDARD_GRAVITY, 20, 100, 100, 1000)
    scan = Scan("tau", "s", _("time constant of the settling"), smooth=True)

    def grid(self, motion: Motion) -> Array:
        return np.geomspace(SHORTEST, LONGEST, CANDIDATES)

    def course(self, motion: Motion) -> Array:
        return decayed(motion, self.value(motion))

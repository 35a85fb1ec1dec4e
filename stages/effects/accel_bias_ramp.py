"""A bias of the accelerometers that drifts evenly."""

from dataclasses import replace

import numpy as np

from stages.model.effect import Array, Effect, Parameter, Reading, Truth
from stages.model.motion import Motion


class AccelBiasRamp(Effect):
    """Reading += c t, with t since the start of the campaign.

    Told from a constant by the order of the positions. Only logs with a common clock show it.
    """

    name = "accel_bias_ramp"
    cause = "the bias of the accelerometers drifts, as the sensor or its electronics warm up or age"
    source = "IEEE Std 1554-2005, 'ramp' of the Allan variance"
    parameters = tuple(
        Parameter(f"c_{axis}", "m/s³", 3e-8, f"drift of the {axis} specific force, per second")
        for axis in "xyz"
    )

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        drift = np.outer(np.nan_to_num(motion.time), values)
        return replace(reading, accel=reading.accel + drift)

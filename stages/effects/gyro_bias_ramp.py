"""A bias of the gyros that drifts evenly."""

from dataclasses import replace

import numpy as np

from stages.model.effect import Array, Effect, Parameter, Reading, Truth
from stages.model.motion import Motion


class GyroBiasRamp(Effect):
    """Reading += c t, with t since the start of the campaign.

    Told from a constant by the order of the positions. Only logs with a common clock show it.
    """

    name = "gyro_bias_ramp"
    cause = "the bias of the gyros drifts, as the sensor or its electronics warm up or age"
    source = "IEEE Std 1554-2005, 'ramp' of the Allan variance"
    parameters = tuple(
        Parameter(f"c_{axis}", "rad/s²", 1e-10, f"drift of the {axis} rate, per second")
        for axis in "xyz"
    )

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        drift = np.outer(np.nan_to_num(motion.time), values)
        return replace(reading, gyro=reading.gyro + drift)

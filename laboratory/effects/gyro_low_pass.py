"""Bandwidth of the gyros."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from laboratory.arrays import Array
from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading
from laboratory.units import MILLISECOND


class GyroLowPass(ArrayEffect):
    """τ dy/dt = u − y, of the whole output u of each gyro: motion, bias and noise.

    Exact where u is constant over a sample, as it is for a filter in the firmware: y goes from y₀
    to u + (y₀ − u) a, a = exp(−T/τ), and its mean is u + (y₀ − u) (1 − a) τ/T. Before the first
    sample of a log it has settled.
    value: (3,), τ, s. Source: IEEE Std 528-2019, "bandwidth".
    """

    KEY = "time_constant_ms"
    UNIT = MILLISECOND

    def recorded_increments(self, increments: Reading, interval: float) -> Reading:
        if not self.value.any():
            return increments
        gyros = zip(increments.gyro.T, self.value, strict=True)
        passed = [_passed(one, interval / tau) if tau else one for one, tau in gyros]
        return replace(increments, gyro=np.column_stack(passed))


def _passed(given: Array, steps: float) -> Array:
    """Increments through a low pass, (n,); steps: T/τ."""
    decay = np.exp(-steps)
    ends, _ = lfilter([1 - decay], [1, -decay], given, zi=[decay * given[0]])
    starts = np.append(given[0], ends[:-1])
    return np.asarray(given + (starts - given) * (1 - decay) / steps)

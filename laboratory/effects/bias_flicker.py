"""Bias instability of the gyros and of the accelerometers: flicker noise."""

from dataclasses import dataclass, field
from math import exp, log, pi, sqrt
from typing import ClassVar

import numpy as np
from scipy.signal import lfilter

from laboratory.arrays import Array
from laboratory.effects.effect import ScalarEffect
from laboratory.sensor import Reading
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, MICROGRAVITY

TIME_CONSTANTS = 10.0 ** np.arange(-1.0, 5.5, 0.5)  # s: 0.1 s … 28 h
RATIO = sqrt(10.0)  # from one to the next


@dataclass
class _BiasFlicker(ScalarEffect):
    """1/f noise of the power spectral density B² / (π f), one-sided.

    It is the sum of exponentially correlated noises (Gauss-Markov) whose time constants τ follow
    each other in one ratio q and which all have the variance B² ln q / π: their densities
    4 σ² τ / (1 + (2πfτ)²) add up to 1/f, within 3 % from 30 µHz to 0.1 Hz, and fall off beyond
    2 µHz and 2 Hz. The Allan deviation is constant at B √(2 ln 2 / π) = 0.664 B. It continues in
    the pauses, and its initial value is random.
    value: B, rad/s or m/s², the same for the three axes.
    Source: IEEE Std 952-2020, annex on noise models, "bias instability".
    """

    OF_GYROS: ClassVar[bool]

    _reached: float = field(default=0.0, init=False)  # s
    _values: Array | None = field(default=None, init=False)  # (time constants, 3), unit variance

    def noise(self, truth: Truth, generator: np.random.Generator) -> Reading | None:
        if self.value == 0:
            return None
        instants = truth.motion.instants
        fresh = generator.standard_normal((len(TIME_CONSTANTS), 3))
        if self._values is None:
            self._values = fresh
        else:
            kept = np.exp(-max(0.0, instants.start - self._reached) / TIME_CONSTANTS)[:, None]
            self._values = kept * self._values + np.sqrt(1 - kept**2) * fresh
        self._reached = instants.start + instants.samples * instants.interval
        total = np.zeros((instants.samples, 3))
        for number, time_constant in enumerate(TIME_CONSTANTS):
            kept_one = exp(-instants.interval / time_constant)
            drive = sqrt(1 - kept_one**2) * generator.standard_normal((instants.samples, 3))
            start = self._values[number]
            ends, _ = lfilter([1], [1, -kept_one], drive, axis=0, zi=kept_one * start[None])
            # Linear over a sample, which is short compared with the time constant.
            total += (ends + np.vstack([start, ends[:-1]])) / 2
            self._values[number] = ends[-1]
        sigma = self.value * sqrt(log(RATIO) / pi)
        added = sigma * instants.interval * total
        return Reading.of_gyros(added) if self.OF_GYROS else Reading.of_accelerometers(added)


class GyroFlicker(_BiasFlicker):
    KEY = "instability_deg_h"
    UNIT = DEGREE / HOUR
    OF_GYROS = True


class AccelFlicker(_BiasFlicker):
    KEY = "instability_micro_g"
    UNIT = MICROGRAVITY
    OF_GYROS = False

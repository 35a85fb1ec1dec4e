"""White noise of the gyros' angles: quantisation, or what the dither of a ring laser leaves."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import ScalarEffect
from laboratory.sensor import Reading
from laboratory.truth import Truth
from laboratory.units import ARCSECOND


@dataclass
class GyroAngleNoise(ScalarEffect):
    """The angle is read with an error at the end of each sample: an increment has two of them.

    What one increment has too much of the next has too little of. value: Q, rad, sigma of the
    error, the same for the three axes.
    Source: IEEE Std 952-2020, annex on noise models, "quantization noise".
    """

    KEY: ClassVar[str] = "q_arcsec"
    UNIT: ClassVar[float] = ARCSECOND

    _error: Array = field(default_factory=lambda: np.zeros(3), init=False)  # of the last reading

    def noise(self, truth: Truth, generator: np.random.Generator) -> Reading | None:
        if self.value == 0:
            return None
        errors = self.value * generator.standard_normal(truth.turned.shape)
        read = np.vstack([self._error, errors])
        self._error = errors[-1]
        return Reading.of_gyros(read[1:] - read[:-1])

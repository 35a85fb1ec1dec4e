"""S1's demonstration: noise of one density at several bandwidths, integrated to an angle.

White noise of a gyro is sampled fast; a low-pass filter of the sensor, at a tenth, a hundredth …
of the bandwidth, lowers the RMS of the rate and leaves the density below it as it is.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.fft import irfft, rfft, rfftfreq

from inertial.arrays import Array

RATE = 200.0  # Hz
SECONDS = 100.0
DENSITY = 1e-4  # rad/√s: 0.34 °/√h
BANDWIDTHS = (100.0, 30.0, 10.0, 3.0)  # Hz, of an ideal low-pass filter
CHANNELS = 200  # gyros


@dataclass(frozen=True, eq=False)
class Filtered:
    """Gyros of one bandwidth.

    bandwidth: Hz; rms: rad/s, of the rate; error: rad, RMS of the angle after SECONDS; angle:
    (n, k), rad, of some gyros; rates: (n, k), rad/s; interval: s.
    """

    bandwidth: float
    rms: float
    error: float
    angle: Array
    rates: Array
    interval: float = 1 / RATE


@cache
def demonstration(keep: int = 20) -> list[Filtered]:
    """The same gyros at every bandwidth; `keep`: of how many the samples are kept."""
    chance = np.random.default_rng(1)
    samples = int(RATE * SECONDS)
    # Twice as long, for the ends of a filtered record are joined.
    white = DENSITY * np.sqrt(RATE) * chance.standard_normal((CHANNELS, 2 * samples), np.float32)
    spectrum, frequency = rfft(white, axis=1), rfftfreq(2 * samples, 1 / RATE)
    result = []
    for bandwidth in BANDWIDTHS:
        spectrum[:, frequency > bandwidth] = 0.0
        rates = irfft(spectrum, axis=1)[:, :samples].T.astype(np.float64)
        angle = np.cumsum(rates[:, :keep], axis=0) / RATE
        error = float(np.sqrt(np.mean((rates.sum(axis=0) / RATE) ** 2)))
        rms = float(np.sqrt(np.mean(rates**2)))
        result.append(Filtered(bandwidth, rms, error, angle, rates[:, :keep].copy()))
    return result

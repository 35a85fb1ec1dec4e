"""What the rounding of coarse counts makes the mean of a manoeuvre uncertain by."""

from collections.abc import Mapping

import numpy as np

from inertial import tables
from inertial.signal.scatter import noise_before_rounding, rounded_mean
from stages.noise.spectra import Spectra

Level = tuple[str, str, str]  # manoeuvre, phase, channel

MAX_COARSE_VARIANCE = 0.5  # steps²: rounding alone makes up to a quarter
MIN_ROUNDED_MEAN = 1e-3  # steps
MAX_ALIKE = 0.25  # steps between means whose errors have anything in common


def rounding_levels(spectra: Mapping[tuple[str, str], Spectra]) -> dict[Level, float]:
    """What the rounding of readings adds to the level of each manoeuvre, phase and channel.

    The mean of a manoeuvre is off by the same however long it is; so is the sigma that this level
    gives it. Means that are alike are off by the same, so each of k of them has √k of it. The
    variance of rounded readings depends on where the truth lies between two steps, so the noise is
    that of the mean variance of all rests, but where a manoeuvre clearly shakes.
    """
    found: dict[Level, float] = {}
    steps = np.min([one.steps for one in spectra.values()], axis=0, initial=np.inf)
    for place in np.flatnonzero(np.isfinite(steps)):
        channel, step = tables.CHANNELS[place], float(steps[place])
        sensor = channel.partition("_")[0]
        own = {
            key: one
            for key, one in spectra.items()
            if sensor not in one.carried and np.isfinite(one.squares[place])
            if sensor in one.samples
        }
        if not own:
            continue
        count = np.array([one.samples[sensor] for one in own.values()])
        seconds = np.array([sum(one.seconds[sensor]) for one in own.values()])
        spread, mean = (
            np.array([getattr(one, name)[place] for one in own.values()]) / count / step**power
            for name, power in (("squares", 2), ("sums", 1))
        )
        coarse = spread < MAX_COARSE_VARIANCE
        resting = coarse & np.array([phase == "rest" for _manoeuvre, phase in own])
        shared = np.mean(spread, where=resting if resting.any() else coarse) if coarse.any() else 0
        off = rounded_mean(noise_before_rounding(np.where(coarse, shared, spread)))
        apart = np.abs(mean - mean[:, None])
        alike = np.sum(np.cos(2 * np.pi * np.minimum(apart, MAX_ALIKE)), axis=1)
        level = off * step * np.sqrt(alike * seconds)
        kept = zip(own, off, level.tolist(), strict=True)
        found |= {(*key, channel): size for key, one, size in kept if one > MIN_ROUNDED_MEAN}
    return found

"""On which side of a lasting change of sign the readings are reversed, by gravity.

From one mean over 1 s to the next the force turns as the gyros say, f' = R(ω T)ᵀ f; with the sign
of an axis turned, of either sensor, a turn of gravity comes out elsewhere. So the windows before
and after the change tell, by which of both fits, which side is as named. A turn about the vertical,
and a rest, tell nothing. Biases and the earth's rate are small beside the turns of a table.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from inertial.arrays import Array
from inertial.signal.detector import Windows

MAX_INTERVALS = 1.5  # median intervals: windows farther apart are not compared
MIN_APART = 0.1  # of the force, by which one reading of a turn must miss it: some 6°
MIN_MISFIT_RATIO = 3.0  # times as far off as the other
MIN_TELLING = 3  # windows
MIN_AGREEING = 0.9  # of those that tell: else the readings change more than once


def reversed_before(windows: Windows, change_s: float, signs: Array) -> bool:
    """Whether gravity shows the readings before the change, and not those after it, as reversed.

    Parameters
    ----------
    change_s : s, its time; signs : (6,), of the readings on one side of it, if the other's are +1
    """
    time = windows.time
    if len(time) < 2 or not np.isfinite(change_s):
        return False
    interval = np.diff(time)
    near = interval < MAX_INTERVALS * np.median(interval)
    named, turned = (_misfit(windows.mean * by, interval) for by in (np.ones(6), signs))
    size = np.linalg.norm(windows.mean[1:, :3], axis=1)
    with np.errstate(invalid="ignore"):  # not recorded: tells nothing
        as_named = near & (turned > MIN_APART * size) & (turned > MIN_MISFIT_RATIO * named)
        as_turned = near & (named > MIN_APART * size) & (named > MIN_MISFIT_RATIO * turned)
    before, after = time[1:] < change_s, time[:-1] > change_s
    agreeing = np.sum(before & as_turned) + np.sum(after & as_named)
    telling = agreeing + np.sum(before & as_named) + np.sum(after & as_turned)
    return bool(telling >= MIN_TELLING and agreeing >= MIN_AGREEING * telling)


def _misfit(means: Array, interval: Array) -> Array:
    """How far each mean force is from where the gyros turn the one before, m/s², (k − 1,)."""
    forces, rates = means[:, :3], (means[1:, 3:] + means[:-1, 3:]) / 2
    misfit = np.full(len(interval), np.nan)
    there = np.asarray(np.isfinite(means).all(axis=1))
    both = there[1:] & there[:-1]
    turned = Rotation.from_rotvec(-rates[both] * interval[both, None]).apply(forces[:-1][both])
    misfit[both] = np.linalg.norm(forces[1:][both] - turned, axis=1)
    return misfit

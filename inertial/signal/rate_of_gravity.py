"""The rate at which the specific force turns in the case, on a table with a level axis.

    f(t) = c + A cos ωt + B sin ωt

Bias, scale factors, cross terms and a lever arm are in c, A and B, so the accelerometers need no
calibration: they count rounds. ω is had by Gauss and Newton's iteration from the planned rate.
"""

import numpy as np

from inertial.arrays import Array
from inertial.text.units import STANDARD_GRAVITY

MIN_ROUNDS = 1.0  # else a sine is not told from its tangent
MIN_MEANS = 12  # of seven unknowns in each axis
ITERATIONS = 8
MIN_AMPLITUDE = 0.5 * STANDARD_GRAVITY  # of what turns: about an axis that is level, not upright
MAX_CHANGE = 0.1  # relative, of the planned rate: what is further off is another rate


def rate_of_gravity(forces: Array, time: Array, planned: float) -> tuple[float, float]:
    """The rate, rad/s above 0, and its sigma by what the means scatter by; NaN where none turns.

    Parameters
    ----------
    forces : (k, 3), m/s², means over short parts of a steady turn; time : (k,), s, of their middles
    planned : rad/s, of any sign
    """
    nothing = (np.nan, np.nan)
    there = np.isfinite(forces).all(axis=1)
    forces, time = forces[there], time[there] - time[there].mean() if there.any() else time[there]
    rate = abs(planned)
    if len(time) < MIN_MEANS or np.ptp(time) * rate < 2 * np.pi * MIN_ROUNDS:
        return nothing
    for _ in range(ITERATIONS):
        cosine, sine = np.cos(rate * time), np.sin(rate * time)
        waves = np.column_stack([np.ones_like(time), cosine, sine])
        found = np.linalg.lstsq(waves, forces, rcond=None)[0]
        left = forces - waves @ found
        slope = time[:, None] * (np.outer(cosine, found[2]) - np.outer(sine, found[1]))
        slope -= waves @ np.linalg.lstsq(waves, slope, rcond=None)[0]
        information = float(np.sum(slope**2))
        if not information > 0:
            return nothing
        rate += float(np.sum(slope * left)) / information
        if abs(rate / planned) - 1 > MAX_CHANGE or rate <= 0:
            return nothing
    if (
        np.linalg.norm(found[1:]) / np.sqrt(2) < MIN_AMPLITUDE
        or abs(rate / planned) < 1 - MAX_CHANGE
    ):
        return nothing
    degrees = left.size - found.size - 1
    return rate, float(np.sqrt(np.sum(left**2) / degrees / information))

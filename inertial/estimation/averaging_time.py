"""How long a mean must last for a wanted sigma.

    σ = √(N² / (n T) + floor²),   T = N² / (n (σ² − floor²))

for n means of T seconds each, of white noise N, and errors that no time averages out (floor). S0
(5-1), (5-2) have T ≥ (3 N/b)². Its 81 s come from N in m/s/√h with T in s: a factor of 3600; it is
0.0225 s. Not the bias sets the time but the sigma that is wanted.
"""

import numpy as np


def per_root_second(per_root_hour: float) -> float:
    """A random walk of a data sheet, per √h, in SI, per √s: an hour has 60 roots of a second."""
    return per_root_hour / 60


def averaging_time(random_walk: float, wanted: float, means: int = 1, floor: float = 0.0) -> float:
    """Seconds for which each of some means must last; infinite where the floor is too high.

    Parameters
    ----------
    random_walk : N, unit of the reading times √s (m/s² √s = m/s/√s; rad/s √s = rad/√s)
    wanted : σ, unit of the reading; a scale factor error counts times its input
    means : of how many independent means the result is the mean
    floor : what does not average out, such as g times the tilt of a position; unit of the reading
    """
    room = wanted**2 - floor**2
    return random_walk**2 / (means * room) if room > 0 else np.inf

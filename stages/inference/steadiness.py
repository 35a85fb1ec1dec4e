"""How far the rate of a table strays while it is said to be steady."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]

RUNS = 8  # of the recorded steady part: the longest stretch whose scatter is still known, to 27 %


def strays(
    rate: Array, seconds: Array, elapsed: Array, before: Booleans, missing: float, density: float
) -> float:
    """By how much the mean rate over what is missing may be off that of what is recorded, rad/s.

    The larger of two, each without what white noise adds to it. Half of the difference between
    the rates before and after: wherever between them the rate has changed, the mean lies not
    farther off. The scatter of means over runs as long as what is missing: it may stray as any
    of them. Where it is longer than an eighth of the recorded part, over runs of an eighth; that
    a longer stretch averages more is not counted on.

    Parameters
    ----------
    rate, seconds, elapsed : (k,), rad/s and s, of the steady blocks; elapsed at their middles
    before : (k,), which of them lie before the longest missing stretch
    missing : s, how long that is
    density : rad/√s, white noise along the axis
    """
    whole = float(seconds.sum())
    apart = 0.0
    if before.any() and not before.all():
        lasted = np.array([seconds[part].sum() for part in (before, ~before)])
        means = np.array([rate[part] @ seconds[part] for part in (before, ~before)]) / lasted
        excess = (means[1] - means[0]) ** 2 - density**2 * np.sum(1 / lasted)
        apart = float(np.sqrt(max(excess, 0.0))) / 2

    length = max(min(missing, whole / RUNS), float(np.median(seconds)))
    run = ((elapsed - elapsed[0]) / length).astype(np.int64)
    lasted = np.bincount(run, seconds)
    full = lasted > length / 2  # what a gap leaves of a run is not as long as the others
    scattered = 0.0
    if full.sum() > 1:
        means = np.bincount(run, rate * seconds)[full] / lasted[full]
        beyond = float(np.var(means, ddof=1) - density**2 * np.mean(1 / lasted[full]))
        scattered = float(np.sqrt(max(beyond, 0.0)))
    return max(apart, scattered)

"""What is missing of a turn, bridged by the blocks about it, and how sure the angle is.

In the steady part the table turned by the mean rate of what is recorded of it, in a ramp by the
rate between the blocks beside. The noise of these blocks is in the equations; here is what else
the angle may be wrong by:

- the mean rate over what is missing may be off the recorded one: by as much as the table's rate
  is stated to be known, or by as much as the data show that it strays, if that is more. Nothing
  is counted on to average out, and all that is missing in a turn is off alike;
- an oscillation of the case that is faster than a block is seen in the scatter of the samples
  alone: the recorded part may break off at any phase of it;
- a rate that changes may change its acceleration between the blocks beside: then a straight line
  is off by up to a quarter of the change of rate between them.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stages.contracts.tables import GYRO
from stages.estimation.blocks import Blocks
from stages.estimation.noise_levels import NoiseLevels
from stages.inference.steadiness import strays
from stages.inference.whole_turns import Bridge

Array = NDArray[np.float64]


def bridges(part: Blocks) -> list[Bridge]:
    """What is missing between the k blocks of a turn, each bridged by the blocks about it."""
    seconds, steady = part.seconds, part.steady
    found = []
    for i in np.flatnonzero(part.missing).tolist():
        gone = float(part.missing[i])
        shares = np.zeros(len(part))
        if steady[i - 1] and steady[i]:
            shares[steady] = gone / seconds[steady].sum()
        else:
            # The straight line through the means of both blocks, at the middle of what is missing.
            nearer = (seconds[i - 1] + gone) / (seconds[i - 1] + 2 * gone + seconds[i])
            shares[i - 1 : i + 1] = gone * np.array([1 - nearer, nearer]) / seconds[i - 1 : i + 1]
        found.append(Bridge(i, gone, shares))
    return found


def sigma_of(
    part: Blocks,
    found: Sequence[Bridge],
    about: Array,
    name: str,
    noise: NoiseLevels,
    rate_sigma: float,
) -> float:
    """The sigma of the angle that the table turned in all that is missing, rad, but for noise.

    Parameters
    ----------
    about : (3,), axis of the turn; `name` of its manoeuvre
    rate_sigma : relative, of the table's rate
    """
    if not found:
        return 0.0
    seconds, steady = part.seconds, part.steady
    rate = np.nan_to_num(part.gyro) @ about
    elapsed = np.cumsum(seconds + part.missing) - seconds / 2
    density = np.nan_to_num(noise.of(name, "steady", GYRO))
    rings = _oscillation(name, noise, about, float(seconds.sum() / part.counts.sum()))
    # An oscillation slower than one period in a block shows in the blocks.
    longest = float(np.median(seconds)) / (2 * np.pi)
    variance = sum(2 * (rings * min(one.seconds, longest)) ** 2 for one in found)

    level = [one for one in found if steady[one.before - 1] and steady[one.before]]
    if level:
        longer = max(level, key=lambda one: one.seconds)
        strayed = strays(
            rate[steady],
            seconds[steady],
            elapsed[steady],
            np.flatnonzero(steady) < longer.before,
            longer.seconds,
            float(np.linalg.norm(about * density)),
        )
        stated = rate_sigma * abs(float(np.average(rate[steady], weights=seconds[steady])))
        variance += (max(strayed, stated) * sum(one.seconds for one in level)) ** 2
    change = np.abs(np.diff(rate)) / np.diff(elapsed)  # rad/s², from block to block
    for one in found:
        if not any(one is other for other in level):
            near = change[max(one.before - 2, 0) : one.before + 1].max()
            apart = elapsed[one.before] - elapsed[one.before - 1]
            variance += (near * apart / 4 * one.seconds) ** 2
    return float(np.sqrt(variance))


def _oscillation(name: str, noise: NoiseLevels, about: Array, step: float) -> float:
    """What the samples of the steady part scatter about the axis beyond white noise, rad/s."""
    white = noise.of(name, "steady", GYRO) ** 2 / step
    beyond = np.maximum(np.nan_to_num(noise.of_samples(name, "steady", GYRO) ** 2 - white), 0.0)
    return float(np.sqrt(about**2 @ beyond))

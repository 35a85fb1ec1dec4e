"""Interpolation of missing samples of a rotation, and the sigma of its angle.

In the steady part the angle is the mean recorded rate times the missing time, in a ramp the
integral of the straight line between the neighbouring blocks. Their noise is in the equations;
the other errors of the angle are:

- the mean rate while samples are missing differs from the recorded one: by the stated sigma of
  the table's rate, or by the variation in the data, whichever is larger. It is the same
  for all gaps of a rotation, and does not average out;
- an oscillation of the case faster than a block appears in the scatter of samples only: the
  recorded part may end at any phase of it;
- in a ramp the acceleration may change between the neighbouring blocks: the straight line is
  wrong by up to a quarter of the change of rate between them.
"""

from collections.abc import Sequence

import numpy as np

from inertial.arrays import Array
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.static_positions import Blocks
from inertial.estimation.gyroscope_observations import Gap
from inertial.estimation.spectrum import rate_deviation
from inertial.tables import GYRO


def gaps_of(part: Blocks) -> list[Gap]:
    """The gaps between the k blocks of a turn, interpolated from the neighbouring blocks."""
    seconds, steady = part.seconds, part.steady
    gaps = []
    for i in np.flatnonzero(part.missing).tolist():
        lost = float(part.missing[i])
        shares = np.zeros(len(part))
        if steady[i - 1] and steady[i]:
            shares[steady] = lost / seconds[steady].sum()
        else:
            # The straight line through the means of both blocks, at the middle of the gap.
            weight = (seconds[i - 1] + lost) / (seconds[i - 1] + 2 * lost + seconds[i])
            shares[i - 1 : i + 1] = lost * np.array([1 - weight, weight]) / seconds[i - 1 : i + 1]
        gaps.append(Gap(i, lost, shares))
    return gaps


def weights_of(part: Blocks) -> Array:
    """The weights of the k blocks of a turn in its sums, (k,), so that these have no gaps."""
    return np.ones(len(part)) + sum((gap.shares for gap in gaps_of(part)), np.zeros(1))


def sigma_of(
    part: Blocks,
    gaps: Sequence[Gap],
    about: Array,
    name: str,
    noise: NoiseLevels,
    rate_sigma: float,
) -> float:
    """The sigma of the interpolated angle of all gaps together, rad, without noise.

    Parameters
    ----------
    about : (3,), axis of the turn; `name` of its manoeuvre
    rate_sigma : relative, of the table's rate
    """
    if not gaps:
        return 0.0
    seconds, steady = part.seconds, part.steady
    rate = np.nan_to_num(part.gyro) @ about
    elapsed = np.cumsum(seconds + part.missing) - seconds / 2
    density = np.nan_to_num(noise.of(name, "steady", GYRO))
    oscillation = _oscillation(name, noise, about, float(seconds.sum() / part.counts.sum()))
    # An oscillation slower than one period in a block is visible in the blocks.
    longest = float(np.median(seconds)) / (2 * np.pi)
    variance = sum(2 * (oscillation * min(gap.seconds, longest)) ** 2 for gap in gaps)

    steady_gaps = [gap for gap in gaps if steady[gap.before - 1] and steady[gap.before]]
    if steady_gaps:
        longest_gap = max(steady_gaps, key=lambda gap: gap.seconds)
        deviation = rate_deviation(
            rate[steady],
            seconds[steady],
            elapsed[steady],
            np.flatnonzero(steady) < longest_gap.before,
            longest_gap.seconds,
            float(np.linalg.norm(about * density)),
        )
        stated = rate_sigma * abs(float(np.average(rate[steady], weights=seconds[steady])))
        variance += (max(deviation, stated) * sum(gap.seconds for gap in steady_gaps)) ** 2
    change = np.abs(np.diff(rate)) / np.diff(elapsed)  # rad/s², from block to block
    for gap in gaps:
        if not any(gap is other for other in steady_gaps):
            largest = change[max(gap.before - 2, 0) : gap.before + 1].max()
            interval = elapsed[gap.before] - elapsed[gap.before - 1]
            variance += (largest * interval / 4 * gap.seconds) ** 2
    return float(np.sqrt(variance))


def _oscillation(name: str, noise: NoiseLevels, about: Array, step: float) -> float:
    """Scatter of the samples of the steady part about the axis beyond white noise, rad/s."""
    white = noise.of(name, "steady", GYRO) ** 2 / step
    excess = np.maximum(np.nan_to_num(noise.of_samples(name, "steady", GYRO) ** 2 - white), 0.0)
    return float(np.sqrt(about**2 @ excess))

"""The blocks of turns without the oscillations that were found in them.

Where a block holds no whole number of periods the mean of an oscillation over it is not zero, and
over many blocks that beats: it would be taken for whatever goes with time or angle.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.periodic_in_time import phasor
from inertial.tables import GYRO
from stages.criticism.oscillation_search import Bound

Array = NDArray[np.float64]


def without_lines(
    blocks: pd.DataFrame, turns: Sequence[SteadyTurn], lines: Sequence[Bound]
) -> pd.DataFrame:
    """The same blocks, each line taken out of the steady ones with its own phase in each turn.

    The angle of a turn stays as it was: from rest to rest what rings comes back, and so does a
    ripple of a whole order. What it adds while the turn is steady it takes away while the table
    speeds up and slows down.
    """
    if not lines:
        return blocks
    quiet = blocks.copy()
    for turn in turns:
        own = (blocks["manoeuvre"] == turn.name) & (blocks["phase"] == "steady")
        if own.any() and np.isfinite(turn.start):
            ringing = _ringing(turn, lines, blocks[own])
            ringing -= np.average(ringing, axis=0, weights=blocks.loc[own, "seconds"])
            quiet.loc[own, GYRO] -= ringing @ turn.matrix.T
    return quiet


def _ringing(turn: SteadyTurn, lines: Sequence[Bound], blocks: pd.DataFrame) -> Array:
    """The mean rates of all lines in blocks of a turn, (k, 3), rad/s, about the case's axes."""
    left = turn.truth.copy()
    time = turn.step * np.arange(len(left))
    since = blocks["time"].to_numpy(np.float64) - turn.start
    count = blocks["count"].to_numpy(np.float64)
    means = np.zeros((len(blocks), 3))
    for line in lines:
        frequency = line.frequencies.get(turn.name)
        if frequency is None:
            continue
        half = np.pi * frequency * turn.step
        share = np.sin(count * half) / (count * np.sin(half))  # of a sum of so many samples
        for axis in range(3):
            amplitude = phasor(left[:, axis], 1 / turn.step, frequency)
            left[:, axis] -= np.real(amplitude * np.exp(2j * np.pi * frequency * time))
            means[:, axis] += share * np.real(amplitude * np.exp(2j * np.pi * frequency * since))
    return means

"""What is missing of a turn, and whether the rate about it tells the angle that is missing."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]

FEW = 3  # masked samples in a row that may be interpolated where the rate changes
SMALL = 0.1  # of the time of the ramps: what may be interpolated there in all
# s of steady rate that must be recorded on either side of what is missing, or as much as is
# missing where that is less: ten of the bins in which the end of a ramp is looked for, so that no
# part of a ramp hides in the gap; on S0's turn the rate before and the rate after are then known
# to 20 ppm each, better than the table keeps it.
ENOUGH = 1.0


@dataclass(frozen=True)
class Missing:
    """What is missing of a turn: time, s, and the angle that the rate about it tells, rad.

    `hindrance`: why it cannot be bridged, in words; empty where it can, or nothing is missing.
    """

    seconds: float
    angle: float
    hindrance: str


def missing_of(moving: pd.DataFrame, about: Array, gaps: pd.DataFrame) -> Missing:
    """What is missing of a turn.

    A stretch of steady rate can be bridged. Where the rate changes, or a hand turns, a gap cannot;
    there only a few masked samples between good ones are interpolated.

    Parameters
    ----------
    moving : its k blocks in motion
    about : (k,), rad/s, their rates about its axis
    gaps : those of its log
    """
    seconds = moving["seconds"].to_numpy(np.float64)
    missing = moving["missing_s"].to_numpy(np.float64)
    holes = np.flatnonzero(missing)
    steady = (moving["phase"] == "steady").to_numpy(bool)
    inside = np.zeros(len(moving), bool)
    inside[1:] = steady[1:] & steady[:-1]
    beside = np.append(0.0, (about[1:] + about[:-1]) / 2)
    if steady.any():
        beside[inside] = np.average(about[steady], weights=seconds[steady])
    angle = float(beside[holes] @ missing[holes])
    hindrance = _hindrance(moving, holes, inside, gaps) if len(holes) else ""
    return Missing(float(np.maximum(missing, 0.0).sum()), angle, hindrance)


def _hindrance(
    moving: pd.DataFrame, holes: NDArray[np.int64], inside: Booleans, gaps: pd.DataFrame
) -> str:
    """Why what is missing before the blocks `holes` cannot be bridged; empty where it can."""
    missing = moving["missing_s"].to_numpy(np.float64)
    seconds = moving["seconds"].to_numpy(np.float64)
    step = float(seconds.sum() / moving["count"].sum())
    steady = (moving["phase"] == "steady").to_numpy(bool)
    by_hand = bool((moving["phase"] == "turning").any())
    where = "a turn by hand has no steady rate" if by_hand else "the rate is not steady there"
    if (missing < -step / 2).any():
        return "the time goes back while it turns"
    for hole in holes[inside[holes]]:
        enough = min(ENOUGH, missing[hole])
        before = float(seconds[:hole][steady[:hole]].sum())
        after = float(seconds[hole:][steady[hole:]].sum())
        if min(before, after) < enough - step / 2:
            side = "before" if before < after else "after"
            return (
                f"only {min(before, after):.2f} s of steady rate are recorded {side} them, of"
                f" {enough:.2f} s that are needed"
            )
    ramps = holes[~inside[holes]]
    if not len(ramps):
        return ""
    first = moving["to_record"].to_numpy()[ramps - 1]
    last = moving["from_record"].to_numpy()[ramps]
    lost = gaps["record"].to_numpy(np.int64)
    if ((lost[:, None] >= first) & (lost[:, None] <= last)).any():
        return where
    if missing[ramps].max() > (FEW + 0.5) * step:
        return f"{where}, and more than {FEW} samples in a row are masked"
    if missing[ramps].sum() > SMALL * seconds[~steady].sum():
        return f"{where}, and more than {SMALL:.0%} of its samples are masked"
    return ""

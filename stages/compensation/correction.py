"""Which M and bias apply to which records, and how the errors are taken out of a reading.

m = M⁻¹ (m̃ − b)                                                       (S0, compensation)
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.records import rows_of
from inertial.campaign.solution import Solution
from inertial.physics.forward import Triad

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

ALL = np.iinfo(np.int64).max  # a record number that no log reaches


def truth_of(readings: Array, triad: Triad | None, weight: float = 1.0) -> Array:
    """What three sensors felt by what they read, (n, 3); NaN where their M is not determined.

    For sums over time `weight` is the time that the bias has added to, s.
    """
    if triad is None:
        return np.full(readings.shape, np.nan)
    # The inverse is applied to rows; a channel that is not recorded leaves none of the three.
    return np.asarray((readings - weight * triad.bias) @ np.linalg.inv(triad.matrix).T)


@dataclass(frozen=True)
class Mounted:
    """Records [first, after) of a log in which the IMU sat on one mount."""

    first: int
    after: int
    result: Solution

    def truth(self, readings: Array) -> Array:
        """Specific force and angular rate by the six readings, (n, 6)."""
        triads = self.result.accelerometer, self.result.gyro
        return np.hstack(
            [truth_of(readings[:, :3], triads[0]), truth_of(readings[:, 3:], triads[1])]
        )


def mounted(mounts: Sequence[CampaignData], segments: pd.DataFrame) -> dict[str, list[Mounted]]:
    """For each log the stretches of one mount, with its result.

    A log of a single mount is one stretch. In another one, what lies between manoeuvres of
    different mounts belongs to neither: there the IMU is taken off.
    """
    mount = {m.name: place for place, data in enumerate(mounts) for m in data.plan}
    result: dict[str, list[Mounted]] = {}
    for log in dict.fromkeys(m.log for data in mounts for m in data.plan):
        own = [data for data in mounts if any(m.log == log for m in data.plan)]
        if len(own) == 1:
            result[log] = [Mounted(0, ALL, own[0].result)]
            continue
        runs: list[tuple[int, int, int]] = []
        for row in sorted(rows_of(segments[segments["log"] == log]), key=_start):
            on = mount[row["manoeuvre"]]
            if runs and runs[-1][0] == on:
                runs[-1] = (on, runs[-1][1], max(runs[-1][2], row["to_record"]))
            else:
                runs.append((on, row["from_record"], row["to_record"]))
        result[log] = [Mounted(first, after, mounts[on].result) for on, first, after in runs]
    return result


def _start(row: Mapping[str, int]) -> int:
    return row["from_record"]

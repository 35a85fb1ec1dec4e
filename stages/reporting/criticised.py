"""What criticism and extension found of the model, as the blocks of causes take it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from inertial.tables.parquet import Stream
from stages.reporting import before_after
from stages.reporting.extended_parameters import Shift
from stages.reporting.mounts import mount_of
from stages.reporting.rows import Record
from stages.reporting.sought import Sought


@dataclass(frozen=True)
class Criticised:
    """What pictures and numbers of causes are taken from."""

    sought: Mapping[tuple[str, str], Sought]  # by effect and mount
    simulated: Stream
    left: before_after.Means
    lines: pd.DataFrame
    manoeuvres: pd.DataFrame
    structures: Sequence[Record]
    points: Sequence[Record]
    gain: Sequence[Record]
    worth: Sequence[Record]
    decision: Sequence[Record]
    positions: Sequence[Record]  # findings of set positions that are off
    shifts: Sequence[Shift]
    gyro: Sequence[Record]  # its parameters by the result that counts

    def effect(self, finding: Record) -> Sought | None:
        """The effect that a finding names; none of a second one of its kind."""
        one = self.sought.get((finding["cause"], mount_of(finding["id"])))
        return one if one is not None and one.finding == finding["id"] else None

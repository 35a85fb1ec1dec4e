"""The records of all logs folded by the phase of their stamps, clock by clock."""

import numpy as np
import pandas as pd

from inertial.campaign.masked_samples import Batch
from inertial.campaign.records import rows_of
from inertial.signal.phase_folding import PERIODS, Folded, Glitch, glitches
from inertial.tables import CHANNELS


class FoldedClocks:
    """Sums by phase; logs of a receiver share its clock, any other log has its own."""

    columns = ("time", *CHANNELS)

    def __init__(self, clocks: pd.DataFrame) -> None:
        self._clock: dict[str, str] = {}
        self._folded: dict[str, Folded] = {}
        for row in rows_of(clocks):
            if row["interval"]:
                epoch = row["epoch_gps"]
                made = Folded(row["interval"], np.mod(epoch or 0.0, PERIODS[0]))
                name = row["log"] if epoch is None else f"GPS, {made.places}"
                self._clock[row["log"]] = name
                self._folded.setdefault(name, made)

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        if batch.log in self._clock:
            self._folded[self._clock[batch.log]].add(batch["time"], batch.readings)

    def glitches(self) -> dict[str, tuple[Glitch, ...]]:
        """What is off at one phase of a period, by log."""
        found = glitches(self._folded)
        return {log: found.get(clock, ()) for log, clock in self._clock.items()}

"""What a recording shows without the plan: faults of its time, its readings, its scale."""

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from inertial.campaign.detection import Examination, ExaminationOfLogs
from inertial.campaign.findings import Detection, close_ups, detections_of, masks_of, table_of
from inertial.campaign.log_properties import ChannelStatistics, Stated, stated_by, windows_of
from inertial.campaign.masked_samples import Batch, RecordIndex, read_once
from inertial.campaign.records import rows_of
from inertial.detectors import OF_RECORDS
from inertial.detectors.gap import Gap
from inertial.signal.detector import Windows
from inertial.signal.phase_folding import PERIODS, Folded, Glitch, glitches
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.quality.declared import DECLARED


def quality(
    samples: Stream,
    stated: Stated,
) -> Tables:
    """Findings of the detectors that need no plan, the records that they mask, and the gaps.

    Two passes over the samples: detectors compare single readings with resolution and noise of
    the whole log, which are known only after it was read once.
    """
    statistics, sums = ChannelStatistics(), windows_of(stated.clocks)
    folded = _FoldedClocks(stated.clocks)
    read_once(samples, [statistics, sums, folded])
    windows = {
        log: Windows(total.mean, total.variance, total.time, total.temperature)
        for log, total in sums.result().items()
    }
    channel_statistics = statistics.table()
    off = folded.glitches()
    by_name = {
        name: replace(log, glitches=off.get(name, ()))
        for name, log in stated.logs(channel_statistics, windows).items()
    }

    examination = ExaminationOfLogs(Examination(OF_RECORDS, by_name, stated.given))
    index = RecordIndex()
    read_once(samples, [examination, index])
    detections = detections_of("quality", examination.events(), by_name)
    return {
        "findings": table_of([each.finding for each in detections]),
        "masks": masks_of(detections),
        "gaps": _gaps(detections),
        "channel_statistics": channel_statistics,
        "close_ups": close_ups(samples, index, detections),
    }


class _FoldedClocks:
    """The records of all logs folded by the phase of their stamps, clock by clock.

    Logs of a receiver share its clock, any other log has its own.
    """

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


def _gaps(detections: list[Detection]) -> list[dict[str, Any]]:
    """Every single gap, though many may be one finding."""
    return [
        {
            "log": log,
            "record": event.first,
            "from_s": event.from_s,
            "to_s": event.to_s,
            "missing": round(event.size),
        }
        for each in detections
        if isinstance(each.detector, Gap)
        for log, event in each.events
    ]


STAGE = Stage(quality, DECLARED, gathers={"stated": stated_by})

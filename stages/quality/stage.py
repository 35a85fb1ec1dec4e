"""What a recording shows without the plan: faults of its time, its readings, its scale."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.detection import Examination, ExaminationOfLogs
from inertial.campaign.findings import Detection, close_ups, detections_of, masks_of, table_of
from inertial.campaign.log_properties import ChannelStatistics, Stated, stated_by, windows_of
from inertial.campaign.masked_samples import Accumulator, Batch, Masks, RecordIndex, read_once
from inertial.campaign.records import rows_of
from inertial.campaign.sums import Sums
from inertial.detectors import OF_RECORDS
from inertial.detectors.gap import Gap
from inertial.detectors.repeated_records import Duplicate, HeldRecord
from inertial.signal.detector import Log, Windows
from inertial.signal.phase_folding import NOT_HELD, PERIODS, Folded, Glitch, glitches
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.quality.declared import DECLARED

# ---- Resolution, noise and means of every log, without stretches of one record over and over.


def properties(samples: Stream, stated: Stated) -> tuple[dict[str, Log], pd.DataFrame]:
    """Every log by name, and the statistics of its channels.

    A logger that writes its last record on and on, or an erased memory, makes a long stretch in
    which nothing changes. It has neither the noise of the sensors nor gravity: where there is one,
    the records that the detectors of copies mask are left out of a second pass.
    """
    made, statistics = _passed(samples, stated, None)
    if not statistics.still:
        return made, statistics.table()
    examination = ExaminationOfLogs(Examination((Duplicate(), HeldRecord()), made, None))
    read_once(samples, [examination])
    masks = masks_of(detections_of("quality", examination.events(), made))
    made, statistics = _passed(samples, stated, Masks(masks))
    return made, statistics.table()


def _passed(
    samples: Stream, stated: Stated, masks: Masks | None
) -> tuple[dict[str, Log], ChannelStatistics]:
    """Of the samples without what is masked of them; one pass, where no sensor is slower."""
    statistics, sums = ChannelStatistics(), windows_of(stated.clocks)
    folded = _FoldedClocks(stated.clocks, {})
    _read(samples, [statistics, sums, folded], masks)
    made = stated.logs(statistics.table(), _windows(sums.result(), masks is not None))
    held = {name: log.held for name, log in made.items() if log.held.any()}
    if held:  # which of the readings are new is known only now
        folded = _FoldedClocks(stated.clocks, held)
        _read(samples, [folded], masks)
    off = folded.glitches()
    logs = {name: replace(log, glitches=off.get(name, ())) for name, log in made.items()}
    return logs, statistics


def _read(samples: Stream, accumulators: list[Accumulator], masks: Masks | None) -> None:
    """The samples once, without what is masked of them."""
    if masks is not None:
        accumulators = [_Unmasked(each, masks) for each in accumulators]
    read_once(samples, accumulators)


def _windows(sums: Mapping[str, Sums], masked: bool) -> dict[str, Windows]:
    """Means over 1 s by log; `masked`: some windows may have no record left."""
    windows = {}
    for log, total in sums.items():
        kept = total.count > 0 if masked else np.ones(len(total.count), bool)
        columns = total.mean, total.variance, total.time, total.temperature
        windows[log] = Windows(*(column[kept] for column in columns))
    return windows


class _Unmasked:
    """Hands on the records of which something is to be used."""

    def __init__(self, accumulator: Accumulator, masks: Masks) -> None:
        self.columns = accumulator.columns
        self._accumulator = accumulator
        self._masks = masks

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        gone = self._masks.of(batch.log, batch["record"]).whole
        if gone.any():
            batch = Batch(batch.log, {name: own[~gone] for name, own in batch.columns.items()})
        if len(batch):
            self._accumulator.add(batch)


class _FoldedClocks:
    """The records of all logs folded by the phase of their stamps, clock by clock.

    Logs of a receiver share its clock, any other log has its own. `held`: by log, as of `Log`.
    """

    columns = ("time", *CHANNELS)

    def __init__(self, clocks: pd.DataFrame, held: Mapping[str, Array]) -> None:
        self._held = held
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
            folded = self._folded[self._clock[batch.log]]
            folded.add(batch["time"], batch.readings, self._held.get(batch.log, NOT_HELD))

    def glitches(self) -> dict[str, tuple[Glitch, ...]]:
        """What is off at one phase of a period, by log."""
        found = glitches(self._folded)
        return {log: found.get(clock, ()) for log, clock in self._clock.items()}


# ---- The stage.


def quality(
    samples: Stream,
    stated: Stated,
) -> Tables:
    """Findings of the detectors that need no plan, the records that they mask, and the gaps.

    Detectors compare single readings with resolution and noise of the whole log, which are known
    only after it was read once.
    """
    by_name, channel_statistics = properties(samples, stated)
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

"""What a recording shows without the plan: faults of its time, its readings, its scale."""

from dataclasses import replace

import pandas as pd

from inertial import tables
from inertial.campaign.close_ups import close_ups
from inertial.campaign.detection import Examination, ExaminationOfLogs
from inertial.campaign.findings import Detection, detections_of, masks_of, table_of
from inertial.campaign.folded_clocks import FoldedClocks
from inertial.campaign.log_properties import ChannelStatistics, Stated, stated_by, windows_of
from inertial.campaign.masked_samples import RecordIndex, read_once
from inertial.detectors import OF_RECORDS
from inertial.detectors.gap import Gap
from inertial.signal.detector import Windows
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
    folded = FoldedClocks(stated.clocks)
    read_once(samples, [statistics, sums, folded])
    windows = {
        log: Windows(total.mean, total.variance, total.time, total.temperature)
        for log, total in sums.result().items()
    }
    channel_statistics = statistics.table()
    glitches = folded.glitches()
    by_name = {
        name: replace(log, glitches=glitches.get(name, ()))
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


def _gaps(detections: list[Detection]) -> pd.DataFrame:
    """Every single gap, though many may be one finding."""
    rows = [
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
    return pd.DataFrame(rows) if rows else tables.GAPS.empty()


STAGE = Stage(quality, DECLARED, gathers={"stated": stated_by})

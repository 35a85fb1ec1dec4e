"""What a recording shows without the plan: faults of its time, its readings, its scale."""

from typing import Any

from inertial.campaign.detection import Examination, ExaminationOfLogs
from inertial.campaign.findings import Detection, close_ups, detections_of, masks_of, table_of
from inertial.campaign.log_properties import Stated, stated_by
from inertial.campaign.masked_samples import RecordIndex, read_once
from inertial.detectors import OF_RECORDS
from inertial.detectors.gap import Gap
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.quality.declared import DECLARED
from stages.quality.properties import properties


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

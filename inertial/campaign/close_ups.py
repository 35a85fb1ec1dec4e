"""The samples around each finding, for a figure that shows it close up."""

from collections.abc import Sequence

import pandas as pd

from inertial import tables
from inertial.campaign.findings import Detection
from inertial.campaign.masked_samples import RecordIndex, rows_between
from inertial.tables.parquet import Stream

MAX_FINDINGS = 40  # that are shown
MARGIN = 60  # records on each side
MAX_RECORDS = 400  # of a close-up; of a longer stretch its beginning is shown
COLUMNS = ["record", "line", "time", *tables.CHANNELS]


def close_ups(samples: Stream, index: RecordIndex, detections: Sequence[Detection]) -> pd.DataFrame:
    """The records around the place of each finding, the most severe findings first.

    Parameters
    ----------
    index : the rows of the records, from a pass over the samples
    """
    placed = [each for each in detections if each.events]
    frames = []
    for detection in sorted(placed, key=lambda each: -each.finding.severity)[:MAX_FINDINGS]:
        log, event = max(detection.events, key=lambda pair: abs(pair[1].size))
        first = event.first - MARGIN
        after = min(event.after + MARGIN, first + MAX_RECORDS)
        for batch in rows_between(samples, *index.rows(log, first, after), COLUMNS):
            shown = pd.DataFrame(batch.columns)
            shown = shown[(shown["record"] >= first) & (shown["record"] < after)]
            inside = (shown["record"] >= event.first) & (shown["record"] < event.after)
            frames.append(shown.assign(finding=detection.finding.id, log=log, concerned=inside))
    return pd.concat(frames) if frames else tables.CLOSE_UPS.empty()

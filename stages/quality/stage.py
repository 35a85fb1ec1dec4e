"""What can be said of a recording without the plan: its time, its values, its scale."""

from itertools import chain

import pandas as pd

from inertial import tables
from inertial.campaign import detection
from inertial.campaign.close_ups import close_ups
from inertial.campaign.detection import watch
from inertial.campaign.events import tell
from inertial.campaign.findings import table_of
from inertial.campaign.log_properties import given_by, logs
from inertial.detectors import OF_RECORDS
from inertial.detectors.gap import Gap
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.quality.declared import DECLARED


def quality(
    samples: Stream,
    clocks: pd.DataFrame,
    campaign: pd.DataFrame,
    known: pd.DataFrame,
    ranges: pd.DataFrame,
    count_sizes: pd.DataFrame,
) -> Tables:
    """Findings of the detectors that need no plan, the records that they mask, and the gaps."""
    given = given_by(campaign, known, count_sizes, clocks)
    looked = logs(samples, clocks, ranges, given)
    told = tell("quality", watch(OF_RECORDS, detection.of_logs(samples), looked, given))
    masks = pd.DataFrame(chain.from_iterable(one.masks for one in told))
    gaps = pd.DataFrame(
        {
            "log": log,
            "record": event.first,
            "from_s": event.from_s,
            "to_s": event.to_s,
            "missing": round(event.size),
        }
        for one in told
        if isinstance(one.detector, Gap)
        for log, event in one.events
    )
    return {
        "findings": table_of([one.finding for one in told]),
        "masks": masks if len(masks) else tables.MASKS.empty(),
        "gaps": gaps if len(gaps) else tables.GAPS.empty(),
        "close_ups": close_ups(samples, told),
    }


STAGE = Stage(quality, DECLARED)

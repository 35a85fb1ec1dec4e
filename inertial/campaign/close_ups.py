"""The samples around each finding, for a figure that shows it close up."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from inertial import tables
from inertial.campaign.events import Told
from inertial.campaign.masked_samples import pieces
from inertial.tables.parquet import Stream

MOST = 40  # findings that are shown
BESIDE = 60  # records on each side
LONGEST = 400  # records of one; of a longer stretch its beginning is shown


def close_ups(samples: Stream, told: Sequence[Told]) -> pd.DataFrame:
    """The records around the place that a finding tells of, the gravest findings first."""
    graver = sorted(told, key=lambda one: -one.finding.severity)
    wanted: dict[str, list[tuple[str, int, int]]] = {}
    for one in [one for one in graver if one.events][:MOST]:
        log, event = max(one.events, key=lambda pair: abs(pair[1].size))
        wanted.setdefault(log, []).append((one.finding.id, event.first, event.after))
    columns = ["record", "line", "time", *tables.CHANNELS]
    frames = []
    for log, piece in pieces(samples, columns):
        for finding, first, after in wanted.get(log, ()):
            end = min(after + BESIDE, first - BESIDE + LONGEST)
            start, stop = np.searchsorted(piece["record"], [first - BESIDE, end])
            if stop > start:
                shown = pd.DataFrame({name: piece[name][start:stop] for name in columns})
                inside = (shown["record"] >= first) & (shown["record"] < after)
                frames.append(shown.assign(finding=finding, log=log, concerned=inside))
    return pd.concat(frames) if frames else tables.CLOSE_UPS.empty()

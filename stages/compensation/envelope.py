"""The extremes of the compensated samples between the edges that the traces of segment have."""

import numpy as np
import pandas as pd

from inertial import tables
from inertial.campaign.sums import extremes_over
from stages.compensation.compensated_samples import CompensatedStream


def envelope(samples: CompensatedStream, traces: pd.DataFrame) -> pd.DataFrame:
    """The same stretches as in `traces`, so that before, after and difference can be drawn."""
    edges = {
        str(log): (rows["from_record"].to_numpy(np.int64), rows["to_record"].to_numpy(np.int64))
        for log, rows in traces.groupby("log", sort=False)
    }
    own = dict(list(traces.groupby("log", sort=False)))
    frames = [
        own[log][["log", "from_record", "to_record", "from_s", "to_s"]].assign(
            **{f"least_{c}": total.least[:, i] for i, c in enumerate(tables.CHANNELS)},
            **{f"most_{c}": total.most[:, i] for i, c in enumerate(tables.CHANNELS)},
        )
        for log, total in extremes_over(samples, edges).items()
    ]
    return pd.concat(frames) if frames else tables.TRACES.empty()

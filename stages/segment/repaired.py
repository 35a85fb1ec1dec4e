"""The plan as a table, and the properties of a log, after what was wrong is set right."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from inertial.campaign.masked_samples import Repairs
from inertial.campaign.records import Manoeuvre
from inertial.signal.detector import Log


def plan_as_taken(stated: pd.DataFrame, plan: Sequence[Manoeuvre]) -> pd.DataFrame:
    """The table of the manoeuvres with what the repairs have changed."""
    table = stated.set_index("manoeuvre").loc[[m.name for m in plan]].reset_index()
    for name in ("log", "from_s", "to_s", "from_row", "to_row", "label", "angle", "rate"):
        values = pd.Series([getattr(m, name) for m in plan], dtype=object)
        table[name] = values.where(values.notna(), None)
    return table[list(stated.columns)]


def log_as_read(log: Log, repairs: Repairs) -> Log:
    """A log whose channels are set right: their steps, noise and limits go with them."""
    source, factor = repairs.channels(log.name)
    size = np.abs(factor)
    ends = np.sort([factor * log.least[source], factor * log.most[source]], axis=0)
    return replace(
        log,
        quantum=size * log.quantum[source],
        noise=size * log.noise[source],
        equal=log.equal[source],
        least=ends[0],
        most=ends[1],
        limit=size * log.limit[source],
        count=size * log.count[source],
    )

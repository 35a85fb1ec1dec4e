"""The samples of some stretches of the logs, in one pass, what is masked left out."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.masked_samples import Masks, pieces
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stretch:
    """Records of a log, from `first` to the one before `after`."""

    log: str
    first: int
    after: int


@dataclass(frozen=True)
class Samples:
    """n samples: `time` (n,), s; `values` (n, 6), in the order of CHANNELS, NaN where masked."""

    time: Array
    values: Array


def samples_in(
    samples: Stream, stretches: Mapping[str, Stretch], masks: Masks
) -> dict[str, Samples]:
    """The samples of each stretch by its name; repeated records are left out."""
    found: dict[str, list[tuple[Array, Array]]] = {name: [] for name in stretches}
    for log, piece in pieces(samples, ["record", "time", *CHANNELS]):
        record = piece["record"]
        for name, stretch in stretches.items():
            if stretch.log != log or record[-1] < stretch.first or record[0] >= stretch.after:
                continue
            here = (record >= stretch.first) & (record < stretch.after)
            masked = masks.of(log, record[here])
            values = np.column_stack([piece[channel][here] for channel in CHANNELS])
            values[masked.channels | masked.lost[:, None]] = np.nan
            kept = ~masked.repeated
            found[name].append((piece["time"][here][kept], values[kept]))
    return {
        name: Samples(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))
        for name, parts in found.items()
        if parts
    }

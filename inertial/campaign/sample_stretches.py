"""The samples of some stretches of the logs, in one pass, without those masked."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.log_lines import RecordRange
from inertial.campaign.masked_samples import Masks, Repairs, pieces
from inertial.campaign.records import Manoeuvre
from inertial.tables import CHANNELS, STATIC_PHASES
from inertial.tables.parquet import Stream


def records_of(m: Manoeuvre, segments: pd.DataFrame, *, moving: bool = False) -> RecordRange:
    """All the records of a manoeuvre, rests before and after a turn included unless `moving`."""
    rows = segments[(segments["manoeuvre"] == m.name) & (segments["log"] == m.log)]
    if moving:
        rows = rows[~rows["phase"].isin(STATIC_PHASES)]
    return RecordRange(m.log, int(rows["from_record"].min()), int(rows["to_record"].max()))


@dataclass(frozen=True)
class Samples:
    """n samples: `time` (n,), s; `values` (n, 6), in the order of CHANNELS, NaN where masked.

    `table_angle`: (n,), rad, continuous over turns, NaN where the encoder gives none;
    `temperature`: (n,), K.
    """

    time: Array
    values: Array
    table_angle: Array
    temperature: Array


def samples_in(
    samples: Stream, stretches: Mapping[str, RecordRange], masks: pd.DataFrame, repairs: Repairs
) -> dict[str, Samples]:
    """The samples of each stretch by its name; repeated records are left out."""
    known = Masks(masks, repairs)
    extracted: dict[str, list[tuple[Array, ...]]] = {name: [] for name in stretches}
    others = ("time", "table_angle", "temperature")
    for log, piece in pieces(samples, ["record", *others, *CHANNELS], repairs):
        record = piece["record"]
        for name, stretch in stretches.items():
            if stretch.log != log or record[-1] < stretch.first or record[0] >= stretch.after:
                continue
            inside = (record >= stretch.first) & (record < stretch.after)
            masked = known.of(log, record[inside])
            values = np.column_stack([piece[channel][inside] for channel in CHANNELS])
            values[masked.channels | masked.lost[:, None]] = np.nan
            kept = ~masked.repeated
            time, angle, temperature = (piece[other][inside][kept] for other in others)
            extracted[name].append((time, values[kept], angle, temperature))
    result = {}
    for name, parts in extracted.items():
        if parts:
            time, values, angle, temperature = map(np.concatenate, zip(*parts, strict=True))
            result[name] = Samples(time, values, _continuous(angle), temperature)
    return result


def _continuous(angle: Array) -> Array:
    """An angle without its jumps by whole turns, NaN where it has none."""
    result = np.array(angle, dtype=np.float64)
    known = np.isfinite(result)
    result[known] = np.unwrap(result[known], period=2 * pi)
    return result

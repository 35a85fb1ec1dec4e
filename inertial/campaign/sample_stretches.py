"""The samples of some stretches of the logs, in one pass, without those masked."""

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import TypeVar

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.log_lines import RecordRange
from inertial.campaign.masked_samples import Columns, Masks, Repairs, pieces
from inertial.campaign.records import Manoeuvre
from inertial.tables import CHANNELS, STATIC_PHASES
from inertial.tables.parquet import Stream

Key = TypeVar("Key", bound=Hashable)


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


def columns_in(
    samples: Stream,
    stretches: Mapping[Key, RecordRange],
    columns: Sequence[str],
    repairs: Repairs | None = None,
) -> Iterator[tuple[Key, Columns]]:
    """These columns of each stretch that has records, as soon as it is read: a few in memory."""
    parts: dict[Key, list[Columns]] = {}

    def ended(keys: Iterable[Key]) -> Iterator[tuple[Key, Columns]]:
        """In an order that does not depend on how the table is cut into batches."""
        for key in sorted(keys, key=lambda key: (stretches[key].after, stretches[key].first)):
            own = parts.pop(key)
            yield key, {name: np.concatenate([part[name] for part in own]) for name in own[0]}

    for log, piece in pieces(samples, ["record", *columns], repairs):
        record = piece["record"]
        yield from ended(
            [k for k in parts if stretches[k].log != log or stretches[k].after <= record[0]]
        )
        for key, stretch in stretches.items():
            if stretch.log == log and record[0] < stretch.after and record[-1] >= stretch.first:
                inside = (record >= stretch.first) & (record < stretch.after)
                own = {name: values[inside] for name, values in piece.items()}
                parts.setdefault(key, []).append(own)
    yield from ended(parts)


def samples_in(
    samples: Stream, stretches: Mapping[str, RecordRange], masks: pd.DataFrame, repairs: Repairs
) -> dict[str, Samples]:
    """The samples of each stretch by its name; repeated records are left out."""
    known = Masks(masks, repairs)
    others = ("time", "table_angle", "temperature")
    read: dict[str, Samples] = {}
    for name, piece in columns_in(samples, stretches, [*others, *CHANNELS], repairs):
        masked = known.of(stretches[name].log, piece["record"])
        values = np.column_stack([piece[channel] for channel in CHANNELS])
        values[masked.channels | masked.lost[:, None]] = np.nan
        kept = ~masked.repeated
        time, angle, temperature = (piece[other][kept] for other in others)
        read[name] = Samples(time, values[kept], _continuous(angle), temperature)
    return {name: read[name] for name in stretches if name in read}


def _continuous(angle: Array) -> Array:
    """An angle without its jumps by whole turns, NaN where it has none."""
    result = np.array(angle, dtype=np.float64)
    known = np.isfinite(result)
    result[known] = np.unwrap(result[known], period=2 * pi)
    return result

"""The samples reduced to what later stages use: segments, blocks of means, traces for figures."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from stages.contracts import tables
from stages.contracts.parquet import Stream
from stages.contracts.records import Clock
from stages.contracts.samples import Integers, Sums, regular, sums_over
from stages.segmentation.matching import Part

TRACE_POINTS = 1200  # per log, what a figure shows
Span = tuple[str, int, int]  # log, first record, record after the last


def segments(samples: Stream, parts: Sequence[Part]) -> pd.DataFrame:
    """The phases of all manoeuvres with their records and times."""
    rows = [
        {
            "manoeuvre": part.manoeuvre,
            "phase": part.phase,
            "log": part.log,
            "from_record": part.first,
            "to_record": part.after,
            "from_s": float(total.first[k]),
            "to_s": float(total.last[k]),
        }
        for part, (total, k) in zip(
            parts, _over(samples, [(p.log, p.first, p.after) for p in parts]), strict=True
        )
    ]
    return pd.DataFrame(rows) if rows else tables.SEGMENTS.empty()


def blocks(
    samples: Stream,
    parts: Sequence[Part],
    gaps: pd.DataFrame,
    masks: pd.DataFrame,
    clocks: Mapping[str, Clock],
    rest_block: float,
    turn_block: float,
) -> pd.DataFrame:
    """Every part in blocks of equal length; none reaches across a gap."""
    spans: list[Span] = []
    owners: list[Part] = []
    for part in parts:
        seconds = rest_block if part.phase.startswith("rest") else turn_block
        length = max(1, round(seconds / clocks[part.log].step))
        cuts = {*range(part.first, part.after, length)}
        cuts |= {*gaps.loc[gaps["log"] == part.log, "record"].tolist()}
        starts = sorted(cut for cut in cuts if part.first <= cut < part.after)
        ends = [*starts[1:], part.after]
        spans += [(part.log, a, b) for a, b in zip(starts, ends, strict=True)]
        owners += [part] * len(starts)
    masked = {
        str(log): (rows["from_record"].to_numpy(np.int64), rows["to_record"].to_numpy(np.int64))
        for log, rows in masks.groupby("log")
    }
    sums = _over(samples, spans, masked)
    rows = [
        {
            "manoeuvre": owner.manoeuvre,
            "phase": owner.phase,
            "log": log,
            "from_record": first,
            "to_record": after,
            "time": total.time[k],
            "seconds": total.count[k] * (clocks[log].duration or np.nan),
            "count": total.count[k],
            **dict(zip(tables.CHANNELS, total.mean[k], strict=True)),
            "table_angle": total.table_angle[k],
            "temperature": total.temperature[k],
            "mask_share": total.masked[k] / max(total.records[k], 1),
        }
        for owner, (log, first, after), (total, k) in zip(owners, spans, sums, strict=True)
    ]
    return pd.DataFrame(rows) if rows else tables.BLOCKS.empty()


def traces(samples: Stream, ends: Mapping[str, int]) -> pd.DataFrame:
    """The extremes of every channel in so many stretches of each log."""
    edges = {log: regular(n, -(-n // TRACE_POINTS)) for log, n in ends.items()}
    frames = [
        pd.DataFrame(
            {
                "log": log,
                "from_record": edges[log][0],
                "to_record": edges[log][1],
                "from_s": total.first,
                "to_s": total.last,
                **{f"least_{c}": total.least[:, i] for i, c in enumerate(tables.CHANNELS)},
                **{f"most_{c}": total.most[:, i] for i, c in enumerate(tables.CHANNELS)},
            }
        )
        for log, total in sums_over(samples, edges).items()
    ]
    return pd.concat(frames) if frames else tables.TRACES.empty()


def _over(
    samples: Stream,
    spans: Sequence[Span],
    masks: Mapping[str, tuple[Integers, Integers]] | None = None,
) -> list[tuple[Sums, int]]:
    """For each span the sums of its log, and its place in them."""
    order: dict[str, list[int]] = {}
    for number, (log, _, _) in enumerate(spans):
        order.setdefault(log, []).append(number)
    stretches: dict[str, tuple[Integers, Integers]] = {}
    for log, numbers in order.items():
        numbers.sort(key=lambda number: spans[number][1])
        edges = np.array([spans[number][1:] for number in numbers], np.int64)
        stretches[log] = (edges[:, 0], edges[:, 1])
    sums = sums_over(samples, stretches, masks)
    places = {n: (sums[log], k) for log, numbers in order.items() for k, n in enumerate(numbers)}
    return [places[number] for number in range(len(spans))]

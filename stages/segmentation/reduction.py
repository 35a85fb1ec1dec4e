"""The samples reduced to what later stages use: segments, blocks of means, traces for figures."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.masks import Masks
from stages.contracts.parquet import Stream
from stages.contracts.records import Clock
from stages.contracts.samples import Integers, pieces, regular
from stages.contracts.sums import Sums, sums_over
from stages.segmentation.matching import BETWEEN, Part

Floats = NDArray[np.float64]

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
    masks: Masks,
    clocks: Mapping[str, Clock],
    rest_block: float,
    turn_block: float,
) -> pd.DataFrame:
    """Every part in blocks of equal length; none reaches across a gap, or masked gyros in a turn.

    A turn has no blocks where its gyros are masked: what is missing stands in the block behind.
    """
    spans: list[Span] = []
    owners: list[Part] = []
    hidden = _hidden(parts, masks)
    of_means = _of_means(samples, clocks)
    for part in parts:
        seconds = rest_block if part.phase.startswith("rest") else turn_block
        length = max(1, round(seconds / clocks[part.log].step))
        # A hand turns about ever other axes; of records that are means already, each is a block.
        if part.phase == BETWEEN or part.log in of_means:
            length = 1
        cuts = {*range(part.first, part.after, length)}
        cuts |= {*gaps.loc[gaps["log"] == part.log, "record"].tolist()}
        unseen = hidden.get(part.manoeuvre, np.array([], np.int64))
        cuts |= {*unseen[np.diff(unseen, prepend=-2) > 1].tolist()}
        cuts |= {*(unseen[np.diff(unseen, append=np.iinfo(np.int64).max) > 1] + 1).tolist()}
        starts = sorted(cut for cut in cuts if part.first <= cut < part.after)
        kept = ~np.isin(starts, unseen)
        ends = [*starts[1:], part.after]
        edges = zip(starts, ends, kept, strict=True)
        new: list[Span] = [(part.log, first, after) for first, after, seen in edges if seen]
        spans += new
        owners += [part] * len(new)
    sums = _over(samples, spans, masks)
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
            "missing_s": 0.0,
            **dict(zip(tables.CHANNELS, total.mean[k], strict=True)),
            "table_angle": total.table_angle[k],
            "temperature": total.temperature[k],
            "mask_share": total.masked[k] / max(total.records[k], 1),
            "first": total.first[k],
            "last": total.last[k],
        }
        for owner, (log, first, after), (total, k) in zip(owners, spans, sums, strict=True)
        if total.records[k] or owner.phase.startswith("rest")
    ]
    if not rows:
        return tables.BLOCKS.empty()
    table = pd.DataFrame(rows)
    for _, turn in table[~table["phase"].str.startswith("rest")].groupby("manoeuvre"):
        log = turn["log"].iloc[0]
        after_gap = turn["from_record"].isin(gaps.loc[gaps["log"] == log, "record"])
        table.loc[turn.index, "missing_s"] = _missing(turn, after_gap, clocks[log])
    return table.drop(columns=["first", "last"])


def _of_means(samples: Stream, clocks: Mapping[str, Clock]) -> set[str]:
    """The logs without time whose records are means of many samples."""
    if all(clock.duration for clock in clocks.values()):
        return set()
    return {
        log
        for log, piece in pieces(samples, ["mean_of"])
        if clocks[log].duration is None and bool((np.nan_to_num(piece["mean_of"]) > 1).any())
    }


def _hidden(parts: Sequence[Part], masks: Masks) -> dict[str, Integers]:
    """For each turn the records in motion whose gyros are not to be used.

    A gyro that is masked in all of them is one that was not recorded, and hides no other.
    """
    turns: dict[str, list[Part]] = {}
    for part in parts:
        if not part.phase.startswith("rest"):
            turns.setdefault(part.manoeuvre, []).append(part)
    hidden = {}
    for name, own in turns.items():
        records = np.concatenate([np.arange(part.first, part.after) for part in own])
        masked = masks.of(own[0].log, records)
        gyros = masked.channels[:, len(tables.CHANNELS) // 2 :]
        unseen = masked.lost | gyros[:, ~gyros.all(axis=0)].any(axis=1)
        hidden[name] = records[unseen & ~masked.repeated]
    return hidden


def _missing(turn: pd.DataFrame, after_gap: pd.Series, clock: Clock) -> Floats:
    """The time that is missing before each block of a turn, (k,), s; negative where time goes back.

    By the stamps; where they tell a whole number of samples within their own scatter, that.
    """
    missing = np.zeros(len(turn))
    step = clock.duration
    if step is None:
        return missing
    pause = np.nan_to_num(turn["first"].to_numpy()[1:] - turn["last"].to_numpy()[:-1] - step)
    hole = after_gap.to_numpy()[1:]
    hole = hole | (turn["from_record"].to_numpy()[1:] != turn["to_record"].to_numpy()[:-1])
    scatter = np.sqrt(np.mean(pause[~hole] ** 2)) if (~hole).any() else 0.0
    whole = step * np.round(pause / step)
    near = np.abs(pause - whole) <= max(3 * scatter, 1e-3 * step)
    missing[1:] = np.where(hole, np.where(near, whole, pause), 0.0)
    return missing


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
    masks: Masks | None = None,
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
